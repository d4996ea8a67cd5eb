"""``POST /api/v1/synthesize`` gives any output by name and at its depth, and refuses what changes nothing of it."""

from io import BytesIO

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image

from app.images.png_writer import encode_png
from app.methods.registry import METHODS
from tests.web.versions import without_versions

URL = "/api/v1/synthesize"
CROP = {"x": 4, "y": 4, "width": 32, "height": 24}


@pytest.fixture(scope="module", name="deep")
def a_deep_photograph():
    return encode_png(np.random.default_rng(4).integers(0, 65536, (40, 48, 3), dtype=np.uint16))


def send(site, *files, **fields):
    names = ("file", "file-2", "file-3")
    uploads = {name: (f"{name}.png", data) for name, data in zip(names, files, strict=False)}
    crops = {f"crop{name.removeprefix('file')}": "4,4,32,24" for name in uploads}
    return site.client.post(URL, files=uploads, data={"method": "rpn", **crops, **fields})


@pytest.mark.parametrize(
    ("method", "count", "fields", "output"),
    [
        ("rpn", 1, {}, "periodic"),
        ("rpn", 1, {"width": "50", "alpha": "0.3"}, "spot"),
        ("modulus-phase", 2, {}, "other"),
        ("dsn", 1, {"convergence": "true"}, "dsn-1000"),
        ("dsn", 1, {"convergence": "true", "spot": "disc", "radius": "3"}, "adsn"),
        ("mix", 2, {"strip": "3"}, "mix-2"),
        ("mix", 2, {"strip": "3"}, "strip"),
        ("mix", 3, {}, "sample-2"),
        ("rayleigh", 1, {}, "adsn"),
        ("texton", 1, {"cut": "5"}, "spot"),
        ("efros-leung", 1, {}, "copy-map"),
        ("heeger-bergen", 1, {"iterations": "2"}, "iteration-1"),
    ],
)
def test_any_output_is_the_file_that_an_experiment_makes(site, picture, method, count, fields, output):
    files = [picture(seed=seed) for seed in range(1, count + 1)]
    inputs = [{"sample": site.upload(data)["id"], "crop": CROP} for data in files]
    properties = METHODS[method].params.model_json_schema()["properties"]
    given = {
        name: value == "true" if properties[name].get("type") == "boolean" else value for name, value in fields.items()
    }
    parameters = METHODS[method].params(**given).model_dump(mode="json", include=set(given))
    record = site.finished(method=method, inputs=inputs, parameters=parameters)
    kept = next(entry for entry in record["outputs"] if entry["name"] == output)
    response = send(site, *files, method=method, output=output, **fields)
    assert response.status_code == 200, response.text
    assert response.content == site.client.get(kept["url"]).content
    assert f'filename="{method}-{output}.png"' in response.headers["Content-Disposition"]


@pytest.mark.parametrize(
    ("method", "count", "fields", "field", "words"),
    [
        ("dsn", 1, {"convergence": "true"}, "convergence", "dsn-10"),
        ("dsn", 1, {"convergence": "true", "output": "points"}, "convergence", "points"),
        ("mix", 2, {"strip": "8"}, "strip", "mix-1"),
        ("mix", 3, {"strip": "4", "output": "sample-1"}, "strip", "two samples"),
        ("mix", 2, {"strip": "4", "weights": "1,2", "output": "mix-1"}, "weights", "texture"),
        ("dsn", 1, {"radius": "4"}, "radius", "spot"),
        ("dsn", 1, {"spot": "disc", "radius": "4", "width": "99", "alpha": "0.3"}, "alpha", "disc"),
        ("rpn", 1, {"alpha": "0.3"}, "alpha", "larger"),
        ("adsn", 1, {"window": "gaussian"}, "window", "larger"),
        ("rpn", 1, {"width": "99", "alpha": "0", "window": "gaussian"}, "window", "α = 0"),
        ("rpn", 1, {"range": "stretch", "output": "crop"}, "range", "texture"),
        ("texton", 1, {"cut": "5", "output": "texton-log"}, "cut", "spot"),
        ("rpn", 1, {"output": "nothing"}, "output", "periodic"),
        ("dsn", 1, {"output": "dsn-10"}, "output", "“Convergence” is on"),
        ("mix", 2, {"output": "sample-1"}, "output", "3 inputs"),
        ("rpn", 1, {"output": "input-spectrum", "depth": "16"}, "depth", "8 bits"),
        ("rpn", 1, {"output": "crop", "depth": "16"}, "depth", "8 bits"),
        ("rpn", 1, {"output": "spot", "format": "webm"}, "format", "still picture"),
    ],
)
def test_what_changes_nothing_or_is_not_there_is_refused_with_what_to_do(
    site, picture, method, count, fields, field, words
):
    files = [picture(seed=seed) for seed in range(count)]
    response = send(site, *files, method=method, **fields)
    assert response.status_code == 422, response.text
    (fault,) = response.json()["errors"]
    assert fault["field"] == field
    assert words in fault["message"]
    assert site.incoming == []


@pytest.mark.parametrize(
    ("method", "count", "fields"),
    [
        ("rpn", 1, {"alpha": "0.1", "window": "bump", "periodic": "true", "range": "clip"}),
        ("dsn", 1, {"convergence": "false", "radius": "8", "alpha": "0.1"}),
        ("mix", 2, {"strip": "0"}),
        ("mix", 3, {"strip": "8"}),
        ("modulus-phase", 2, {"seed": "4"}),
        ("rpn", 1, {"output": "crop", "seed": "4", "width": "50"}),
        ("rpn", 1, {"width": "50", "alpha": "0.3"}),
    ],
)
def test_defaults_said_aloud_and_what_every_method_takes_are_no_fault(site, picture, method, count, fields):
    assert send(site, *[picture(seed=seed) for seed in range(count)], method=method, **fields).status_code == 200


def test_an_experiment_may_have_parameters_that_change_nothing_of_it(site):
    """It is made of another one's, all of them; and all of its outputs are there."""
    record = site.finished(method="dsn", parameters={"convergence": True, "radius": 5.0, "alpha": 0.3})
    assert "dsn-10" in [output["name"] for output in record["outputs"]]


@pytest.mark.parametrize("method", METHODS)
def test_every_output_is_announced_in_the_list_of_methods(site, method):
    listed = {entry["name"]: entry for entry in site.client.get("/api/v1/methods").json()["methods"]}
    outputs = listed[method]["outputs"]
    assert [output["name"] for output in outputs] == [output.name for output in METHODS[method].outputs]
    assert outputs[0]["name"] == "texture"
    assert outputs[0]["condition"] is None
    for output in outputs:
        assert set(output["parameters"]) <= listed[method]["parameters"]["properties"].keys()
        assert output["depths"] in ([8], [8, 16])


@pytest.mark.parametrize(
    ("fields", "kind"),
    [
        ({}, np.uint16),
        ({"format": "png"}, np.uint16),
        ({"format": "tiff"}, np.uint16),
        ({"depth": "16"}, np.uint16),
        ({"depth": "8"}, np.uint8),
        ({"format": "tiff", "depth": "8"}, np.uint8),
        ({"format": "jpeg"}, np.uint8),
        ({"format": "webp"}, np.uint8),
        ({"output": "periodic"}, np.uint16),
        ({"output": "input-spectrum"}, np.uint8),
    ],
)
def test_the_depth_of_the_photograph_is_that_of_the_answer_where_its_format_holds_it(site, deep, fields, kind):
    """And it is the file that an experiment gives when asked for the same."""
    answer = send(site, deep, seed="3", **fields)
    assert answer.status_code == 200, answer.text
    is_tiff = fields.get("format") == "tiff"
    made = tifffile.imread(BytesIO(answer.content)) if is_tiff else imagecodecs.imread(answer.content)
    assert made.dtype == kind
    if kind == np.uint16:
        assert len(np.unique(made)) > 256
    record = site.finished(inputs=[{"sample": site.upload(deep)["id"], "crop": CROP}], parameters={"seed": 3})
    assert record["depth"] == 16
    url = next(entry["url"] for entry in record["outputs"] if entry["name"] == fields.get("output", "texture"))
    query = {name: value for name, value in fields.items() if name != "output"}
    kept = site.client.get(url, params=query)
    assert kept.content == answer.content


def test_of_photographs_of_different_depth_the_deepest_decides(site, picture, deep):
    for files in ((deep, picture()), (picture(), deep)):
        answer = send(site, *files, method="mix")
        assert imagecodecs.png_decode(answer.content).dtype == np.uint16
    assert imagecodecs.png_decode(send(site, picture(), picture(), method="mix").content).dtype == np.uint8


def test_pages_show_8_bits_of_16_and_offer_both(site, deep):
    record = site.finished(
        method="modulus-phase", inputs=[{"sample": site.upload(deep)["id"], "crop": CROP}] * 2, parameters={}
    )
    text = site.client.get(f"/experiments/{record['id']}", headers={"Accept": "text/html"}).text.replace("&amp;", "&")
    text = without_versions(text)
    base = f"/api/v1/experiments/{record['id']}/outputs"
    assert f'<img src="{base}/texture?depth=8"' in text
    for name in ("texture", "other"):
        assert f'{base}/{name}?download=true&format=png&depth=16"' in text
    assert text.index("PNG, 16 bit</a>") < text.index("PNG, 8 bit</a>")
    assert imagecodecs.png_decode(site.client.get(f"{base}/texture?depth=8").content).dtype == np.uint8
    assert site.client.get(f"{base}/texture").content[24] == 16


def test_pages_offer_16_bits_of_every_texture(site, picture):
    sample = site.upload(picture())["id"]
    parameters = {"convergence": True}
    record = site.finished(method="dsn", inputs=[{"sample": sample, "crop": CROP}], parameters=parameters)
    text = site.client.get(f"/experiments/{record['id']}", headers={"Accept": "text/html"}).text.replace("&amp;", "&")
    for output in record["outputs"]:
        link = f"/outputs/{output['name']}?download=true&format=png&depth=16"
        assert (link in text) == (output["kind"] == "texture")
    answer = site.client.get(f"{record['url']}/outputs/dsn-10?format=png&depth=16")
    assert imagecodecs.png_decode(answer.content).dtype == np.uint16
    assert "16" in answer.headers["ETag"]
    assert answer.headers["ETag"] != site.client.get(f"{record['url']}/outputs/dsn-10").headers["ETag"]


@pytest.mark.parametrize(
    ("output", "fields", "media_type"),
    [
        ("texture-mp4", {}, "video/mp4"),
        ("texture-mp4", {"format": "webm"}, "video/webm"),
        ("texture", {"format": "mp4"}, "video/mp4"),
        ("preview", {}, "image/webp"),
        ("cube", {}, "image/png"),
        ("cube", {"format": "tiff"}, "image/tiff"),
        ("cells", {}, "image/png"),
    ],
)
def test_outputs_of_a_video_come_by_name(site, film, animation, output, fields, media_type):
    """Films as the file of the name or of the format, the rest as pictures."""
    data = animation(film(16))
    form = {"method": "video-patchwork", "grid": "8", "interval": "4", "output": output, **fields}
    answer = site.client.post(URL, files={"file": ("clip.png", data)}, data=form)
    assert (answer.status_code, answer.headers["Content-Type"]) == (200, media_type), answer.text
    inputs = [{"sample": site.upload(data, "clip.png")["id"]}]
    record = site.finished(method="video-patchwork", inputs=inputs, parameters={"grid": 8, "interval": 4})
    name = output.removesuffix("-mp4")
    kept = {each["media_type"]: each for each in record["outputs"] if each["name"].removesuffix("-mp4") == name}
    if media_type in kept:
        assert answer.content == site.client.get(kept[media_type]["url"]).content
    else:
        assert Image.open(BytesIO(answer.content)).format == "TIFF"
