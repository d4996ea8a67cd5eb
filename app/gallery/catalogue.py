"""Catalogue: pairs of a crop and its RPN, successes and failures."""

from dataclasses import dataclass

from app.methods.explanations.model import Exhibit


@dataclass(frozen=True)
class Pair:
    """A crop and its texture; ``note`` (prose) says what to see."""

    title: str
    note: str
    exhibit: Exhibit


def _pair(title: str, sample: str, crop: str, note: str) -> Pair:
    return Pair(title, note, Exhibit("rpn", ((sample, crop),), {"seed": 1}))


SUCCESSES = (
    _pair("Sand", "sand_desert009", "128,64,512,512", "Ripples keep their direction, their distance and their light."),
    _pair(
        "Gravel",
        "ballast_railway",
        "0,0,512,512",
        "Seen from so far, stones are a grain; a crop a quarter as wide shows that single ones are lost.",
    ),
    _pair(
        "Stone", "rockface_pink", "190,60,256,256", "Granite is a mixture of crystals smaller than what one looks at."
    ),
    _pair("Wall", "concrete_img_0572", "128,64,256,256", "Fair-faced concrete, with its faint vertical streaks."),
    _pair(
        "Paint",
        "rolled_paint",
        "0,0,256,256",
        "A drawing, for no photograph here shows paint. Its beads are flattened on top, which the texture forgets.",
    ),
    _pair("Wood", "planks_floor_wood01", "132,84,56,112", "The grain of a single board, between its joints."),
    _pair("Fabric", "towel_white", "96,96,256,256", "Terry cloth: rows of loops, regular but not strictly so."),
    _pair(
        "Coloured fabric",
        "towel_red",
        "96,96,256,256",
        "All three channels are given the same phase: no false colours.",
    ),
    _pair("Clouds", "sky_clouds", "640,192,192,192", "What has no contours anywhere has hardly a phase to lose."),
)

FAILURES = (
    _pair(
        "Bricks", "brick_gray", "128,128,256,256", "Joints are straight because phases agree; at random they do not."
    ),
    _pair(
        "Tiles", "tiles02", "0,0,256,256", "The period of the tiles is in the modulus and stays; their outline is gone."
    ),
    _pair("Planks", "planks_floor_wood01", "96,96,256,256", "Grain and joints run into each other along the boards."),
    _pair(
        "Leaves",
        "leaves_forest_floor",
        "256,256,384,384",
        "The colours of autumn without a leaf: objects hide one another.",
    ),
    _pair(
        "Cracks",
        "wall_stained",
        "250,330,200,150",
        "A crack is thin, dark and rare; its energy is spread over everything.",
    ),
    _pair(
        "A gradient",
        "lit_plaster",
        "0,0,256,256",
        "A drawing of plaster lit from one side. A texture has no sides: the light is evened out, and its change is "
        "told by nothing. The meter, which looks for edges, does not warn of it.",
    ),
)
