"""`efros-leung`: non-parametric sampling."""

from collections.abc import Iterator, Sequence
from math import isqrt, sqrt

import numpy as np
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.explanations.efros_leung import EXPLANATION
from app.methods.explanations.references import EFROS_LEUNG as EFROS_LEUNG_ARTICLE
from app.methods.explanations.references import IPOL_EFROS_LEUNG
from app.methods.inputs import INPUTS
from app.methods.model import Fact, Method, Picture, Size, Source
from app.methods.output.pictures import coordinate_colours, crops, encode
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import Resolved, StillParams
from app.synthesis.sampling.efros_leung import border_share, efros_leung, verbatim_share

HALF_PATCH = 4
MOST_WORK = 10**12  # products: a minute or two on two processors
USUAL_WORK = 3 * 10**11  # of a texture of the default size
MOST_TABLE = 1 << 25  # numbers of four bytes that the search holds


class EfrosLeungParams(StillParams):
    """Parameters of non-parametric sampling."""

    half_patch: int = Field(
        HALF_PATCH,
        ge=1,
        le=11,
        title="Half-patch",
        description="How far the windows that are compared reach from their middle, in pixels: 4 makes them 9 × 9. "
        "About the size of the largest element of the texture is right: a smaller one loses its arrangement, a "
        "larger one copies the crop piece by piece and takes longer.",
    )
    tolerance: float = Field(
        0.1,
        ge=0,
        le=1,
        title="Tolerance",
        description="A pixel is drawn among those whose windows are at most so much worse than the best, as a part of "
        "the best one's distance. 0 always takes the best, and copies most; more than 0.3 soon grows garbage.",
    )


def _terms(size: Size, half_patch: int) -> tuple[int, int]:
    """Positions in the crop, and products that comparing a window with one of them takes."""
    side = 2 * half_patch + 1
    return size.width * size.height, side * side * (size.channels + 1)


def default_size(sizes: Sequence[Size]) -> tuple[int, int]:
    """The crop's own, or in its proportions what takes about half a minute."""
    size = sizes[0]
    positions, products = _terms(size, HALF_PATCH)
    factor = min(1.0, sqrt(USUAL_WORK / products) / positions)
    return max(1, int(size.width * factor)), max(1, int(size.height * factor))


def check(sizes: Sequence[Size], resolved: Resolved[EfrosLeungParams]) -> None:
    """Refuse a crop that holds no window, or more than the search can hold; and what would take too long."""
    params, width, height = resolved.params, resolved.width, resolved.height
    size, side = sizes[0], 2 * params.half_patch + 1
    if min(size.width, size.height) < side:
        raise InvalidInputError(
            f"A half-patch of {params.half_patch} compares windows of {side} × {side} pixels, and the crop is "
            f"{size.width} × {size.height}: take a larger crop or a smaller half-patch.",
            "parameters.half_patch",
        )
    positions, products = _terms(size, params.half_patch)
    if positions * products > MOST_TABLE:
        most = isqrt(MOST_TABLE // products)
        raise InvalidInputError(
            f"The crop of {size.width} × {size.height} pixels is too large to be searched for every pixel: with "
            f"windows of {side} × {side} it can be about {most} × {most}. Crop a smaller, typical part "
            "(96 × 96 is usual).",
            "inputs.0.crop",
        )
    if width * height * positions * products > MOST_WORK:
        texture = isqrt(MOST_WORK // (positions * products))
        crop = isqrt(MOST_WORK // (width * height * products))
        instead = f", or crop at most about {crop} × {crop}" if crop >= 3 * side else ""
        raise InvalidInputError(
            f"Every pixel of the texture is searched for in the whole crop: {width} × {height} pixels from "
            f"{size.width} × {size.height} with windows of {side} × {side} would take too long. From this crop ask for "
            f"at most about {texture} × {texture}{instead}.",
            "parameters.width",
        )


def run(sources: Sequence[Source], resolved: Resolved[EfrosLeungParams], context: Context) -> Iterator[Picture]:
    """The texture; then where its pixels come from, and when they came."""
    source = sources[0]
    h, peak = source.pixels, source.peak
    size, params = source.size, resolved.params
    grown = efros_leung(
        h,
        resolved.height,
        resolved.width,
        half_patch=params.half_patch,
        tolerance=params.tolerance,
        seed=params.seed,
        threads=context.threads,
        progress=context.progress,
    )
    border = border_share(grown, size.height, size.width, params.half_patch)
    shares = (
        Fact("verbatim", "Pixels copied along with their left or upper neighbour", verbatim_share(grown.copied), "%"),
        Fact("border", "Pixels drawn from where the window reaches over the crop's border", border, "%"),
    )
    yield encode("texture", "Texture", grown.texture, peak, context, kind="texture", facts=shares)
    context.progress("views", 0)
    yield from crops(sources, context)
    colours = coordinate_colours(*h.shape[:2])
    copied = colours[grown.copied[:, :, 0], grown.copied[:, :, 1]]
    yield encode("copy-map", "Copy map: where in the crop each pixel was taken", copied, 1, context)
    yield encode("copy-map-key", "Key of the copy map: the colours of the crop's places", colours, 1, context)
    order = grown.order.astype(np.float32)
    yield encode("order", "Order of growth, from black to white", order, max(1, grown.order.max()), context)


EFROS_LEUNG = Method(
    name="efros-leung",
    title="Non-parametric sampling (Efros–Leung)",
    summary="Grows a texture from a seed, copying pixels of the crop whose surroundings match.",
    inputs=INPUTS,
    params=EfrosLeungParams,
    references=(EFROS_LEUNG_ARTICLE, IPOL_EFROS_LEUNG),
    explanation=EXPLANATION,
    check=check,
    run=run,
    outputs=(texture(), *shown_inputs(), *views("copy-map"), *views("copy-map-key", of=()), *views("order")),
    stages=lambda sizes, resolved: (("order", 2), ("patches", 3), ("growth", 92), ("views", 3)),
    size=default_size,
    toroidal=lambda params: False,
)
