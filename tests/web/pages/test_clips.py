"""Clips on the pages: uploaded, cropped in time, and given to methods that take a video or one frame of it."""

import html
import re
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any, cast
from urllib.parse import parse_qsl, urlsplit

import numpy as np
import pytest

from app.errors import NotFoundError
from app.experiments.model import Experiment, ExperimentInput, Sample
from app.experiments.preparation import NewInput
from app.images.crop import Frames, Rectangle
from app.methods.registry import METHODS
from app.web.form.address import form_url, from_query
from app.web.form.context import form_context
from app.web.form.draft import read_form
from app.web.form.inputs import Choices
from tests.web.versions import without_versions

CROP = {"crop.x": "4", "crop.y": "6", "crop.width": "20", "crop.height": "16"}
FORM = {**CROP, "size": "1", "seed": "3"}
TIME = {"time.first": "1", "time.count": "4"}
MOVING = next(name for name, method in METHODS.items() if method.inputs[0].moving)
SWITCHES = {"loop": "on", "tileable": "on"}


def value(text: str, name: str) -> str:
    found = re.search(rf'name="{re.escape(name)}"[^>]* value="([^"]*)"', text)
    assert found is not None, name
    return found[1]


def checked(text: str) -> str:
    found = re.search(r'<input type="radio" name="method"[^>]*value="([^"]+)"[^>]* checked', text)
    assert found is not None
    return found[1]


def sample(name: str, frames: int = 1) -> Sample:
    now = datetime(2026, 1, 1, tzinfo=UTC)
    title, digest = name.capitalize(), "0" * 64
    return Sample(48, 40, 3, 8, False, frames, 10.0, id=name, digest=digest, created_at=now, title=title)


@pytest.fixture
def choices() -> Choices:
    """What a form offers: a clip and two photographs."""
    samples = {name: sample(name, frames) for name, frames in {"clip": 6, "sand": 1, "grass": 1}.items()}

    def find(name: str) -> Sample:
        if name in samples:
            return samples[name]
        raise NotFoundError("There is no such photograph.")

    return Choices(tuple(samples.values()), {}, find)


def test_a_clip_is_uploaded_by_the_form_and_shown(
    site: Any, film: Callable[..., np.ndarray], animation: Callable[..., bytes]
) -> None:
    """As a video that plays with the browser's own controls, silent and in a loop; what it is stands beside it."""
    answer = site.client.post("/samples", files={"file": ("clip.png", animation(film(5)))})
    assert answer.status_code == 303
    text = without_versions(site.client.get(answer.headers["location"]).text)
    address = "/api/v1" + answer.headers["location"]
    video = re.search(r"<video [^>]*>", text)
    assert video is not None
    for said in (f'src="{address}/video"', f'poster="{address}/image', "controls", "muted", "loop", "playsinline"):
        assert said in video[0]
    assert "autoplay" not in video[0]
    assert "5 frames, 0.5 s at 10 a second" in text
    assert "<h1>Your clip</h1>" in text


def test_a_file_that_is_neither_is_refused_with_the_formats_there_are(site: Any) -> None:
    answer = site.client.post("/samples", files={"file": ("notes.mp4", b"This is text.")})
    assert answer.status_code == 415
    message = re.search(r'id="upload-error"[^>]*>([^<]+)<', answer.text)
    assert message is not None
    for name in ("PNG", "JPEG", "MP4", "WebM", "GIF"):
        assert name in message[1]


def test_a_clip_starts_with_a_moving_method_and_a_photograph_with_a_still_one(site: Any, clip: str) -> None:
    assert checked(site.client.get(f"/samples/{clip}").text) == MOVING
    assert checked(site.client.get("/samples/gravel_gray").text) == next(iter(METHODS))
    assert checked(site.client.get(f"/samples/{clip}?method=rpn").text) == "rpn"


@pytest.mark.parametrize(
    ("method", "time", "frames"),
    [
        (MOVING, TIME, {"first": 1, "count": 4}),
        (MOVING, {}, {"first": 0, "count": 6}),
        (MOVING, {"time.first": "2", "time.count": " "}, {"first": 2, "count": 4}),
        ("rpn", TIME, {"first": 1, "count": 1}),
        ("rpn", {}, {"first": 0, "count": 1}),
        ("rpn", {"time.first": "5", "time.count": "much"}, {"first": 5, "count": 1}),
    ],
)
def test_the_time_range_is_what_a_method_is_given(
    site: Any, clip: str, method: str, time: dict[str, str], frames: dict[str, int]
) -> None:
    """All of it where nothing is said; of a still method its first frame alone."""
    form = FORM | SWITCHES | {"sample": clip, "method": method} | time
    with site.gate.closed():
        answer = site.client.post("/experiments", data=form)
        assert answer.status_code == 303, answer.text
        address = "/api/v1" + answer.headers["location"]
        record = site.client.get(address).json()
        site.client.delete(address)
    assert record["inputs"][0]["frames"] == frames


@pytest.mark.parametrize(
    ("method", "time", "words"),
    [
        (MOVING, {"time.first": "4", "time.count": "4"}, "reaches outside the sample, which has 6 frames"),
        (MOVING, {"time.first": "-1"}, "reaches outside"),
        (MOVING, {"time.first": "a"}, "two whole numbers"),
        (MOVING, {"time.first": "1,5"}, "got &#34;1,5&#34; for the first frame"),
        (MOVING, {"time.count": "2.5"}, "got &#34;2.5&#34; for their number"),
        (MOVING, {"time.count": "1"}, "at least 2 frames"),
        (MOVING, {"time.first": "9"}, "at least 1 frame"),
        ("rpn", {"time.first": "6"}, "reaches outside"),
        ("rpn", {"time.first": "1.5"}, "The frame is a whole number"),
    ],
)
def test_what_is_wrong_with_a_time_range_is_said_at_its_fields(
    site: Any, clip: str, method: str, time: dict[str, str], words: str
) -> None:
    """When the form is sent, and in the same words when it is only checked."""
    form = FORM | SWITCHES | {"sample": clip, "method": method} | time
    answer = site.client.post("/experiments", data=form)
    assert answer.status_code == 422
    message = re.search(r'id="time-error">([^<]*)<', answer.text)
    assert message is not None
    assert words in message[1]
    assert '<a href="#time-first">' in answer.text
    assert re.search(r'id="time-first"[^>]*aria-describedby="time-help time-error" aria-invalid', answer.text)
    assert site.client.post("/experiments/check", data=form).json() == {"errors": {"time": html.unescape(message[1])}}


def test_a_photograph_s_page_says_that_moving_methods_need_a_clip(site: Any) -> None:
    text = site.client.get(f"/samples/gravel_gray?method={MOVING}").text
    assert checked(text) == MOVING
    box = text.split(f'id="method-{MOVING}"')[1].split('<div class="method">')[0]
    assert "needs a clip" in box
    assert 'href="/"' in box
    other = text.split('id="method-rpn"')[1].split('<div class="method">')[0]
    assert "needs a clip" not in other
    answer = site.client.post("/experiments", data=FORM | {"sample": "gravel_gray", "method": MOVING})
    assert answer.status_code == 422
    assert re.search(r'id="sample-error">[^<]*still picture', answer.text)
    assert f'<a href="#method-{MOVING}">' in answer.text


def test_bundled_clips_are_offered_instead_of_a_photograph(choices: Choices) -> None:
    """And keep it as the pattern, where the method takes one."""
    page = choices.find("sand")
    forms = form_context(page, choices, from_query(page, choices, {}))["methods"]
    offered = {form.method.name: form.clips for form in forms if form.lacks_clip}
    assert set(offered) == {name for name, method in METHODS.items() if method.inputs[0].moving}
    for name, clips in offered.items():
        still = "&input-2.sample=sand" if len(METHODS[name].inputs) > 1 else ""
        assert clips == {"Clip": f"/samples/clip?method={name}{still}"}
    page = choices.find("clip")
    forms = form_context(page, choices, from_query(page, choices, {}))["methods"]
    assert not any(form.lacks_clip for form in forms)


@pytest.mark.parametrize("method", METHODS)
def test_an_experiment_s_form_asks_for_it_again(method: str, choices: Choices) -> None:
    """Crops, time ranges and every parameter, switches that are on by default included."""
    declared = METHODS[method]
    inputs = [
        NewInput("clip", Rectangle(index, 2, 30, 20), Frames(2, 3) if slot.moving else Frames(3, 1))
        for index, slot in enumerate(declared.inputs)
    ]
    switches = {
        name: not entry.default for name, entry in declared.params.model_fields.items() if entry.annotation is bool
    }
    params = declared.params(width=64, height=48, seed=5, **switches)
    if declared.moving:
        params = params.model_copy(update={"frames": 9})
    experiment = Experiment(
        id="e",
        method=method,
        inputs=tuple(
            ExperimentInput(entry.sample, cast(Rectangle, entry.crop), cast(Frames, entry.frames)) for entry in inputs
        ),
        parameters=params.model_dump(mode="json"),
        listed=True,
        owner="",
        created_at=datetime(2026, 1, 1, tzinfo=UTC),
    )
    query = dict(parse_qsl(urlsplit(form_url(experiment)).query, keep_blank_values=True))
    page = choices.find("clip")
    read = read_form(page, choices, from_query(page, choices, query).values)
    assert read.request is not None, read.draft.errors
    assert read.request.inputs == tuple(inputs)
    asked = {name: given for name, given in experiment.parameters.items() if given is not None}
    assert declared.params(**read.request.parameters) == declared.params(**asked)


def test_the_address_keeps_the_time_of_every_input(site: Any, clip: str) -> None:
    text = site.client.get(f"/samples/{clip}?method=mix&time=2,3&second={clip}:1,2,30,31@4,2&third={clip}@1,5").text
    assert [value(text, f"time.{part}") for part in ("first", "count")] == ["2", "3"]
    assert [value(text, f"input-2.time.{part}") for part in ("first", "count")] == ["4", "2"]
    assert value(text, "input-2.crop.width") == "30"
    assert [value(text, f"input-3.time.{part}") for part in ("first", "count")] == ["1", "5"]
    assert value(text, "input-3.crop.width") == ""


@pytest.mark.parametrize("said", ["9,2", "1,9", "a,b", "", ",", "-1,2"])
def test_a_wrong_time_range_in_the_address_counts_as_not_said(site: Any, clip: str, said: str) -> None:
    text = site.client.get(f"/samples/{clip}?time={said}").text
    assert [value(text, f"time.{part}") for part in ("first", "count")] == ["", ""]


def test_showing_another_sample_keeps_the_time_ranges(site: Any, clip: str) -> None:
    """The way without a script."""
    typed = FORM | {"sample": clip, "method": "mix", "input-2.sample": clip, "show": "2", "time.first": "2"}
    answer = site.client.post("/experiments", data=typed | {"input-2.time.first": "3", "input-2.time.count": "2"})
    text = without_versions(site.client.get(answer.headers["location"]).text)
    assert [value(text, f"time.{part}") for part in ("first", "count")] == ["2", ""]
    assert [value(text, f"input-2.time.{part}") for part in ("first", "count")] == ["3", "2"]
    assert f'<video src="/api/v1/samples/{clip}/video"' in text.split('id="input-2-frame"')[1]


def test_a_check_says_what_would_be_made_and_runs_nothing(site: Any, clip: str) -> None:
    before = site.service.experiments.counts()
    form = FORM | SWITCHES | {"sample": clip, "method": MOVING, "size": "2", "frames": "8"}
    answer = site.client.post("/experiments/check", data=form).json()
    assert answer["errors"] == {}
    assert {name: answer["plan"][name] for name in ("width", "height", "frames")} == {
        "width": 40,
        "height": 32,
        "frames": 8,
    }
    assert answer["plan"]["memory"] < answer["plan"]["memory_limit"]
    assert site.service.experiments.counts() == before


def test_a_check_says_what_is_wrong_with_all_of_the_form(site: Any, clip: str) -> None:
    form = FORM | {"sample": clip, "method": MOVING}
    answer = site.client.post("/experiments/check", data=form | {"frames": "999999"}).json()
    assert list(answer["errors"]) == [""]  # of the whole run, not of one field
    assert "fewer frames" in answer["errors"][""]
    wrong = {"frames": "1", "seed": "-1", "crop.x": "40", "time.count": "7"}
    answer = site.client.post("/experiments/check", data=form | wrong).json()
    assert set(answer["errors"]) == {"frames", "seed", "crop", "time"}


def test_a_check_of_what_is_not_there_is_no_page(site: Any) -> None:
    assert site.client.post("/experiments/check", data={"sample": "gone", "method": "rpn"}).status_code == 404
