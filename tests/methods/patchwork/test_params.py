"""Fields that the patchwork methods share: one title and one range each, in the order that each method wants."""

import pytest

from app.methods.fields import FormField, fields
from app.methods.patchwork.patchwork import PatchworkParams
from app.methods.patchwork.transfer import TransferParams
from app.methods.patchwork.video_patchwork import VideoPatchworkParams
from app.methods.patchwork.video_transfer import VideoTransferParams

ALL = (PatchworkParams, TransferParams, VideoPatchworkParams, VideoTransferParams)


def field(params: type, name: str) -> FormField:
    return next(entry for entry in fields(params) if entry.name == name)


@pytest.mark.parametrize("name", ["grid", "sharpness", "reach", "candidates", "interval", "rescale", "tileable"])
def test_one_name_has_one_title_and_one_range(name: str) -> None:
    found = [field(params, name) for params in ALL if name in params.model_fields]
    assert len(found) >= 2
    assert len({(entry.label, entry.kind, entry.minimum, entry.maximum, entry.choices) for entry in found}) == 1


@pytest.mark.parametrize(
    ("params", "order"),
    [
        (PatchworkParams, "width height seed grid sharpness blend reach tileable"),
        (TransferParams, "width height seed grid sharpness candidates rescale reach"),
        (
            VideoPatchworkParams,
            "width height seed frames loop tileable grid interval arrangement sharpness reach",
        ),
        (VideoTransferParams, "width height seed frames loop grid interval candidates rescale sharpness reach"),
    ],
)
def test_forms_and_options_keep_the_order_of_the_declaration(params: type, order: str) -> None:
    assert [entry.name for entry in fields(params)] == order.split()


def test_their_defaults_are_each_methods_own() -> None:
    defaults = [(field(params, "grid").default, field(params, "sharpness").default) for params in ALL]
    assert defaults == [("64", "6"), ("16", "2"), ("64", "6"), ("16", "2")]
    assert [field(params, "sharpness").advanced for params in ALL] == [False, False, True, True]
