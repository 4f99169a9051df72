"""Formulas of every kind, for the tests of all back ends."""

from __future__ import annotations

FORMULAS = (
    r"\theta_4 = \arctan\left(\frac{r_1\sin\theta_1 + r_2\sin\theta_2}{r_1\cos\theta_1}\right)",
    r"\dot r_A = \num{-1.25e-3}\,\mathrm{mm/s^2}",
    r"\overrightarrow{O_4A} + \vec{v} = \vec{0} \quad \hat u \tilde u \bar u \underline{u}",
    r"\sqrt{r_1^2 + r_2^2} \neq \sqrt[3]{x}",
    r"\begin{aligned} x &= \num{4.21} \\ y &= 2 \end{aligned}",
    r"f(x) = \begin{cases} 1 & \text{si } x > 0 \\ 0 & \text{sinon} \end{cases}",
    r"A = \begin{pmatrix} 1 & 2 \\ 3 & 4 \end{pmatrix} \begin{bmatrix} a \\ b \end{bmatrix}",
    r"\left\lvert \dfrac{a}{b} \right\rvert \le \lvert x \rvert < \Vert y \Vert, \left. f \right|_{0}",
    r"\sum_{i=1}^{n} i + \int_0^1 x\,\mathrm{d}x, \max_t x, \lim_{h \to 0} h",
    r"\mathbb{R} \in \mathcal{R} \mathbf{v} \boldsymbol{v} \displaystyle\frac12",
    r"f'(x) + B'' = 90^\circ \% \{ a ; b \} [c, d] / e : f ! | g",
    r"\operatorname{atan2}(y, x) \Rightarrow \text{a\_b}",
)


def call(macro: str) -> str:
    """The macro with what it needs around it."""
    if macro in ("left", "right"):
        return r"\left( x \right)"
    if macro in ("begin", "end"):
        return r"\begin{cases} x \\ y \end{cases}"
    if macro == "\\":
        return r"\begin{matrix} x \\ y \end{matrix}"
    if macro in ("frac", "dfrac", "tfrac"):
        return rf"\{macro}{{a}}{{b}}"
    if macro == "num":
        return r"\num{1}"
    return rf"\{macro}{{x}}"
