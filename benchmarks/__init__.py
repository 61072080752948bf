"""What pendax costs and how far off it is, beside its peers: `python -m benchmarks`."""

TOPICS = {
    "accuracy": "errors of the special functions by region, beside SciPy's",
    "special": "their run times, beside the peers'",
    "free": "the free pendulum: closed form, diffrax, SciPy, heyoka",
    "damped": "damped, driven, stiff and barely damped scenes, the same solvers",
    "gradients": "forward, reverse, adjoints, variational equations, differences",
    "sweeps": "1 to 32,768 lanes: time a lane, compile time, memory",
    "dry": "dry friction, beside events",
    "fate": "where motions end, beside a script",
    "junction": "I–V curves, beside time stepping",
    "fit": "parameters from random recordings",
    "stability": "stiff and extreme cases, beside SciPy and diffrax",
    "lean": "operations of the compiled scene, against paper",
    "start": "imports, and from the shell to the first number",
}
