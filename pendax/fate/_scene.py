"""What a scene must have for its end to be known."""

from typing import Any

from .._arrays import require
from .._pendulum import Pendulum


def require_damped(pendulum: Any, what: str, positive: bool = False) -> None:
    """ValueError for a scene without damping or with a torque that depends on time.

    `positive`: for a damping that is seen to be 0 as well.
    """
    if not isinstance(pendulum, Pendulum):
        raise ValueError(
            f"Argument `pendulum` must be a Pendulum, but got {type(pendulum).__name__}."
        )
    if pendulum.dry is not None:
        raise ValueError(f"Argument `pendulum` must be without dry friction for {what}.")
    if pendulum.beta is None:
        raise ValueError(f"Argument `pendulum` must have damping `beta` for {what}, but got none.")
    if positive:
        require("beta", pendulum.beta, "positive", lambda x: x > 0)
    require_constant(pendulum, what)


def require_constant(pendulum: Pendulum, what: str) -> None:
    if callable(pendulum.tau):
        raise ValueError(
            f"Argument `pendulum` must have a constant torque for {what}, but got one that depends "
            "on time."
        )
