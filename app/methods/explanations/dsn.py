"""Explanation of `dsn`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

EXPLANATION = Explanation(
    what=(
        "Throw $n$ copies of a spot onto a torus, each at a place drawn uniformly and independently of the others, and "
        "add them up. Less its mean and divided by $\\sqrt{n}$, the sum has the same mean and the same covariance for "
        "every $n$: what changes is only how far it is from a Gaussian texture.",
        "While there are few copies one still sees the spot. By the central limit theorem the picture tends to the "
        "asymptotic discrete spot noise (the method ADSN), in which no trace of the spot is left but its "
        "autocorrelation. How many copies that takes is told by the excess kurtosis of a pixel, which is the spot's "
        "divided by $n$: a small spot on a large canvas needs many.",
        "The copies are never drawn one by one. How many of them fall on each pixel is one multinomial variable, and "
        "the sum is its convolution with the spot, done by Fourier transforms: ten million copies take the time of "
        "ten. With the crop as spot the texture is in the crop's colours; the disc and the Gaussian are shown in "
        "grey, their mean as mid-grey, and three standard deviations below and above it as black and white, for every "
        "$n$ alike, so that the pictures of a gallery can be compared with one another and with their limit.",
    ),
    formulas=(
        Formula(
            r"f_n(x) = \sum_{k=1}^{n} h(x - X_k), \qquad X_k \text{ uniform on } \Omega",
            r"The sum of $n$ translates of the spot $h$, periodic on the domain $\Omega$ of $MN$ pixels.",
        ),
        Formula(
            r"Z_n = m + \frac{f_n - n m}{\sqrt{n}} = m + \frac{1}{\sqrt{n}}\, (h - m) * \Bigl(c - \frac{n}{MN}\Bigr)",
            r"Normalised: $m$ is the mean of $h$, and $c(x)$ counts the points $X_k$ that fall on the pixel $x$.",
        ),
        Formula(
            r"\operatorname{Cov}\bigl(Z_n(x), Z_n(y)\bigr) = \frac{1}{MN} \sum_{t} (h(t) - m)(h(t + y - x) - m), "
            r"\qquad \kappa(Z_n) = \frac{\kappa(h)}{n}",
            r"The covariance does not depend on $n$; the excess kurtosis $\kappa$ of a pixel, 0 for a Gaussian, falls "
            r"as $1/n$.",
        ),
    ),
    fails=(
        "The model has nothing for the crop that ADSN and RPN do not have: what is lost in the limit is lost. With a "
        "small $n$ whole copies of the crop shine through one another, in the same order at every place, which no "
        "photograph of a texture shows.",
        "For a small order the values are far from symmetric about their mean: a few very bright discs on an almost "
        "even ground. What passes white is cut off.",
    ),
    figures=(
        Figure(
            "From spots to a texture",
            "The discrete spot noise of a disc for growing $n$, and its limit. Each picture has the discs of the one "
            "before it.",
            (
                Exhibit(
                    "dsn",
                    (("gravel_gray", "96,96,256,256"),),
                    {"spot": "disc", "radius": 8, "convergence": True, "seed": 1},
                    ("spot", "dsn-10", "dsn-100", "dsn-1000", "dsn-10000", "dsn-100000", "adsn"),
                    "disc of radius 8",
                ),
            ),
        ),
        Figure(
            "A Gaussian spot",
            "A spot without edges: its noise is smooth, and few of them are enough.",
            (
                Exhibit(
                    "dsn",
                    (("gravel_gray", "96,96,256,256"),),
                    {"spot": "gaussian", "radius": 16, "convergence": True, "seed": 1},
                    ("spot", "dsn-10", "dsn-100", "dsn-1000", "adsn"),
                    "standard deviation 8",
                ),
            ),
        ),
        Figure(
            "A photograph as the spot",
            "Ten copies of a crop as large as the texture cannot be told from the limit: one sees none of them.",
            (
                Exhibit(
                    "dsn",
                    (("sand_desert009", "256,256,256,256"),),
                    {"convergence": True, "seed": 1},
                    ("crop", "dsn-10", "dsn-100", "adsn"),
                ),
            ),
        ),
        Figure(
            "What the limit loses",
            "Joints between bricks: with few copies one sees several walls through one another, with many none.",
            (
                Exhibit(
                    "dsn",
                    (("brick_gray", "128,128,256,256"),),
                    {"convergence": True, "order": 3, "seed": 1},
                    ("crop", "texture", "dsn-10", "dsn-1000", "adsn"),
                ),
            ),
        ),
    ),
)
