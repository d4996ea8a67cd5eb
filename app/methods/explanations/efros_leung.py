"""Explanation of `efros-leung`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

EXPLANATION = Explanation(
    what=(
        "The texture grows around a small patch that is taken from the crop at random. For the next pixel, what is "
        "already there in a square window around it is compared with the crop everywhere; one of the places "
        "that match best is drawn, and its pixel is copied. Nothing is modelled, so nothing is smoothed "
        "away: edges, bricks and letters come back, as far as a window sees them.",
        "Pixels are filled layer after layer, those with the most known neighbours first, so that every choice rests "
        "on as much as possible. A Gaussian weight lets near neighbours count more than far ones.",
        "The articles compare the window with whole windows of the crop only. Here a place near the crop's border "
        "counts too, if the crop holds everything that is already there of the window: what reaches over the border is "
        "not filled yet, and is not compared. Whole windows alone would leave out a sixth of a crop of 96 × 96 pixels, "
        "and almost half of one of 64 × 64 with a half-patch of 8. In the figures below 1.5 to 41 % of the pixels come "
        "from such places: 7 % of the paving, 13 % of the bricks with 9 × 9 pixels and 28 % with 17 × 17, and 41 % of "
        "the leaves, where growth has gone wrong. Every run says how many.",
        "Each pixel is a pixel of the crop, and the *copy map* shows which: every place of the crop has a colour (see "
        "the key), and every pixel of the texture wears the colour of the place it was taken from. Patches of a smooth "
        "gradient are pieces of the crop copied as they are; confetti is new. The order of growth is shown in grey, "
        "from the first pixel, black, to the last.",
    ),
    formulas=(
        Formula(
            r"d(x, y) = \frac{\sum_{k \in K_x} G(k)\, \| u(x + k) - h(y + k) \|^2}{\sum_{k \in K_x} G(k)}, \qquad "
            r"K_x \subset [-n, n]^2",
            r"The distance between the window around the pixel $x$ of the texture $u$ and the one around $y$ in the "
            r"crop $h$; $K_x$ holds the places already filled, $n$ is the half-patch. Only places $y$ count for which "
            r"$y + k$ lies in the crop for all $k \in K_x$.",
        ),
        Formula(
            r"u(x) = h(Y), \quad Y \text{ uniform among } \{ y : d(x, y) \leq (1 + \varepsilon) \min_{y'} d(x, y') \}",
            r"The pixel is drawn among the best ones, up to the tolerance $\varepsilon$.",
        ),
        Formula(
            r"G(k) \propto e^{-|k|^2 / 2 \sigma^2}, \qquad \sigma = \frac{2n + 1}{6.4}",
            r"The weights, as Efros and Leung chose them.",
        ),
    ),
    fails=(
        "*Verbatim copies.* The first pixels are a piece of the crop, so one place of it matches them perfectly, and a "
        "tolerance of a part of nothing is nothing: the crop is copied outwards as it is until its border is reached. "
        "Only then does the texture become new, and even there by pieces, the larger the wider the window. The "
        "verbatim share tells how many pixels were copied along with their left or upper neighbour. Grow a texture "
        "that is clearly larger than the crop, and look at what surrounds the copy in its middle.",
        "*Garbage.* Once growth has come to a place that the crop hardly knows, the best matches are poor ones, what "
        "they bring matches still less, and a smear or one repeated detail spreads to the border. It happens with "
        "small windows, with crops that are not alike everywhere, and with crops that hold an element only once. Try "
        "another seed, a wider window or a larger crop.",
        "It is slow, as every pixel is searched for in the whole crop, and it knows nothing larger than its window. "
        "For sand, plaster, granite and other micro-textures random phase noise is done at once, and fails in none of "
        "these ways.",
    ),
    figures=(
        Figure(
            "Structure that random phases lose",
            "Slabs and joints come back as slabs and joints. The copy map wears the colours of its key: where growth "
            "began, a large piece of the crop as it is; further out smaller ones, and single pixels from everywhere.",
            (
                Exhibit(
                    "efros-leung",
                    (("crazy_paving001", "100,100,96,96"),),
                    {"width": 160, "height": 160, "seed": 1},
                    ("crop", "texture", "copy-map", "copy-map-key", "order"),
                    "Efros–Leung",
                ),
                Exhibit(
                    "rpn",
                    (("crazy_paving001", "100,100,96,96"),),
                    {"width": 160, "height": 160, "seed": 1},
                    ("texture",),
                    "random phase noise",
                ),
            ),
        ),
        Figure(
            "Three windows",
            "A window must see what it is to arrange. With 3 × 3 pixels joints are lines that lead nowhere; with 9 × 9 "
            "they meet; with 17 × 17 there are bricks again, cut from the crop in large pieces.",
            tuple(
                Exhibit(
                    "efros-leung",
                    (("brick_gray", "100,30,64,64"),),
                    {"width": 128, "height": 128, "half_patch": half_patch, "seed": 1},
                    ("crop", "texture", "copy-map") if half_patch == 1 else ("texture", "copy-map"),
                    f"{2 * half_patch + 1} × {2 * half_patch + 1} pixels",
                )
                for half_patch in (1, 4, 8)
            ),
        ),
        Figure(
            "Garbage grows",
            "Leaves of a kind that occur once, of a size that no window sees: beyond the copy in the middle one leaf's "
            "surface spreads and never ends.",
            (
                Exhibit(
                    "efros-leung",
                    (("leaves_forest_floor", "200,200,64,64"),),
                    {"width": 128, "height": 128, "seed": 1},
                    ("crop", "texture", "copy-map"),
                ),
            ),
        ),
    ),
)
