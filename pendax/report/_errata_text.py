"""Slips of typing and numbering of Suzuki & Suzuki, which no number can prove."""

from ._claim import Erratum

_SLIPS = (  # where, printed, correct
    ("§1.3", "such a family of curve is called sepratrices", "separatrices; only E = 2ε is one"),
    ("§2.3, Fig. 5(d)", "1.999996 (blue) and 1.999998 (blue)", "two colours"),
    ("§2.8; §3.1", "Fig. 10, and Fig. 10(a)–(c)", "one number twice"),
    ("§3.3, §4.1", "Fig. 13 is followed by Fig. 15", "no Fig. 14"),
    ("§8.1", "Fig. 7, the pendulum with a torque", "Fig. 7 is of §2.5, and Fig. 18 came before"),
    ("§2.8, Fig. 10", "q_max", "θ_max"),
    ("§6", "the time dependence of q", "of θ"),
    ("§8.2", "8.2 heads a second section, after 8.2.2", "8.2.3"),
    ("§8.2.3", "(e) twice, v₀ = 2.27 and 2.40", "(e), (f), and one letter on from there"),
    ("§8.2.3; App. H", "τ = −0.01 … 0.40; 0.01 … 0.40; 0.01 … 0.35 to t = 100", "one range"),
    ("§8.2.2", "v oscillates around a finite value with time τ", "with time t"),
    ("§8.2.2 (b)", "for t = 0.19, 0.20, …, 0.24", "for τ = 0.19, 0.20, …, 0.24"),
    ("§8.2.2", "v reaches an equilibrium value v₀", "a mean ⟨v⟩: v₀ is the initial velocity"),
    ("Contents", "7.1 Time dependence, 7.2 Phase space, 8 Resistive pendulum with a … torque",
     "7.1 Formulation, 7.2 Numerical calculation, 8 Analogy …, as the text has them"),
    ("§7.2 (b)", "b is changed as a parameter", "β"),
    ("§4.1 (a)", "the arc BAB₁, the tangent BB′", "one name for the other turning point"),
    ("Abstract; references", "Toda: Baifukan 1977; Shokabo 1975", "one publisher and year"),
    ("§3.2, §5.1, §8",
     "T: period, record, torque; I: inertia, current; P: bob, pivot; V: speed, voltage",
     "a symbol for each"),
    ("§5.2 (i)", "v₀ = 2.02, 2.03, 2.04, 2.05, 2.07, 2.08,", "2.06 is absent after 2.05"),
)  # fmt: skip

ERRATA: tuple[Erratum, ...] = tuple(
    Erratum(f"S2-T{number}", "text", *slip, None) for number, slip in enumerate(_SLIPS, 1)
)
