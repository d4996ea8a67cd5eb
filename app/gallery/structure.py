"""Formulas, study and examples of the page of the structure meter."""

from app.methods.explanations.model import Formula

MARKS = (0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4)
FALSE_ALARM, MISS, UNEVEN = "soil_ground010", "bark_fir", "lit_plaster"

FORMULAS = (
    Formula(
        r"\mathrm{TV}(p) = \sum_{x} |\dot{p}_1(x)| + |\dot{p}_2(x)|",
        r"The total variation: $p$ is the grey periodic component of the crop, smoothed by a periodic Gaussian of "
        r"deviation $\sigma = 2$ pixels; $\dot{p}_1$ and $\dot{p}_2$ are its steps from a pixel to the next one, "
        r"to the right and down, on the torus.",
    ),
    Formula(
        r"\mu_\sigma = (\alpha_1 + \alpha_2) \sqrt{\frac{2}{\pi}} \sqrt{N}, \quad \alpha_i = \|\dot{p}_i\|_2",
        r"The exact mean of the total variation over all Gaussian textures (ADSN) of $p$, which has $N$ pixels: every "
        r"step of such a texture is a normal variable, of deviation $\alpha_i / \sqrt{N}$. No texture need be drawn.",
    ),
    Formula(
        r"\delta_\sigma = \frac{\mu_\sigma - \mathrm{TV}(p)}{\mu_\sigma}",
        r"The structure index: the share of total variation that the crop lacks. It has no unit, and depends neither "
        r"on brightness nor on contrast nor, on average, on the crop's size.",
    ),
    Formula(
        r"z = \frac{\mu_\sigma - \mathrm{TV}(p)}{\sigma_{\mathrm{TV}}}",
        r"The same difference in standard deviations of the total variation of those textures. At $\sigma = 0$ this is "
        r"the sharpness index of Blanchet and Moisan. It grows with the crop's size and rewards sharp asphalt, so it "
        r"does not tell textures apart; the API gives it beside $\delta$.",
    ),
    Formula(
        r"\sigma_{\mathrm{TV}}^2 = \frac{2}{\pi} \sum_{i, j} \alpha_i \alpha_j \sum_{y} "
        r"\omega \left( \frac{\Gamma_{ij}(y)}{\alpha_i \alpha_j} \right), "
        r"\quad \omega(t) = t \, \arcsin(t) + \sqrt{1 - t^2} - 1",
        r"Their variance, exact as well: $\Gamma_{ij}$ is the periodic correlation of $\dot{p}_i$ and $\dot{p}_j$.",
    ),
)

STUDY = (  # by benchmarks/meter.py: the area under the ROC curve, and errors of thresholds set without the photograph
    (r"$\delta_2$, at 2 pixels: the meter", 0.990, 0.036),
    (r"$\delta_0$, not smoothed", 0.881, 0.402),
    (r"$\delta_1$, at 1 pixel", 0.994, 0.094),
    (r"$\delta_4$, at 4 pixels", 0.912, 0.242),
    (r"$z$ at $\sigma = 0$", 0.574, 0.411),
    (r"$z$ at $\sigma = 2$", 0.863, 0.292),
    (r"mean of $\delta_1, \delta_2, \delta_4$", 0.992, 0.067),
    (r"greatest of $\delta_1, \delta_2, \delta_4$", 0.984, 0.112),
    (r"greatest $\delta_2$ of four directions", 0.990, 0.036),
    ("the same in a band, of 1 to 2 pixels", 0.954, 0.071),
    ("unevenness of local energy, at 1 pixel", 0.816, 0.286),
)
