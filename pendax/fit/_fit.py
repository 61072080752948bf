"""What every fit returns."""

from typing import Generic, TypeVar

import equinox as eqx
from jaxtyping import Array, Float

from .._pendulum import Pendulum
from .._results import Result
from ..josephson import JosephsonJunction

Model = TypeVar("Model", Pendulum, JosephsonJunction)


class Fit(eqx.Module, Generic[Model]):
    """A fitted scene or junction, how well it is known, and how well it describes the data.

    - `model`: the scene or junction with the fitted values.
    - `v0`, `theta0`, `offset`: fitted initial values and offset; `None` where the fit has none.
    - `errors`: the standard error of each fitted parameter, by name, from the scatter of the
      residuals: only the ratios of `sigma` matter.  Taken as independent, they are too small
      where `runs` says that the residuals aren't.
    - `covariance`: of the fitted parameters, in the order of `errors`, arrays one after the other.
    - `residuals`: measured less modelled, in the unit of the data, of all samples, fitted or not.
    - `velocity_residuals`: those of the velocity, where it was given.
    - `history`: the loss after each step, the last one repeated.
    - `result`: how it ended.  *misfit*: it has converged, but the residuals keep their signs and
      are more than a tenth of what there is to describe, the angles less a straight line.
    - `reduced_chi2`: the weighted sum of squares over the degrees of freedom, 1 for a model that
      is right and `sigma` that are.  Without `sigma` relative to the scatter from sample to
      sample, which of smooth deviations is small.
    - `runs`: the run test (Wald & Wolfowitz 1940) of the residuals' signs, in standard deviations:
      between −2 and 2 for noise; far below, they keep their signs, and the model lacks something.
    - `notes`: what should be said in words.
    """

    model: Model
    v0: Float[Array, "..."] | None
    theta0: Float[Array, "..."] | None
    offset: Float[Array, "..."] | None
    errors: dict[str, Float[Array, "..."]]
    covariance: Float[Array, "parameters parameters"]
    residuals: Float[Array, "..."]
    history: Float[Array, " steps"]
    result: Result
    reduced_chi2: Float[Array, ""]
    runs: Float[Array, ""]
    velocity_residuals: Float[Array, "..."] | None = None
    notes: tuple[str, ...] = eqx.field(static=True, default=())
