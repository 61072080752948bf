"""What every fit returns."""

import equinox as eqx
from jaxtyping import Array, Float

from .._pendulum import Pendulum
from .._results import Result


class Fit(eqx.Module):
    """A fitted scene and how well it is known.

    - `model`: the scene with the fitted values.
    - `v0`, `theta0`, `offset`: fitted initial values and angle offset; `None` where the
      fit has none.
    - `errors`: the standard error of each fitted parameter, by name.
    - `covariance`: of the fitted parameters, in the order of `errors`.
    - `residuals`: measured less modelled, in the unit of the data.
    - `history`: the loss after each step.
    - `result`: how it ended.
    """

    model: Pendulum
    v0: Float[Array, "..."] | None
    theta0: Float[Array, "..."] | None
    offset: Float[Array, "..."] | None
    errors: dict[str, Float[Array, "..."]]
    covariance: Float[Array, "parameters parameters"]
    residuals: Float[Array, "..."]
    history: Float[Array, " steps"]
    result: Result
