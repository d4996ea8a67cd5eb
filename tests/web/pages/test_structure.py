"""The structure index of a crop by the API, and the page that explains it."""

import itertools
from typing import Any

import numpy as np
import pytest

from app.experiments.meter import Index, interpret
from app.images.crop import Rectangle
from app.web.pages.structure import SIDE, Photograph, place_pictures
from app.web.templating import TEMPLATES, meter_place

URL = "/api/v1/samples/gravel_gray/structure"


def get(site, **query):
    return site.client.get(URL, params=query)


def test_it_answers_with_the_index_its_words_and_what_was_measured(site):
    answer = get(site, crop="8,8,32,40").json()
    found = site.service.meter.structure(site.service.samples.get("gravel_gray"), Rectangle(8, 8, 32, 40))
    assert answer == {
        "delta": pytest.approx(found.delta, abs=1e-4),
        "z": pytest.approx(found.z, abs=1e-2),
        "sigma": 2,
        "verdict": "micro-texture",
        "words": "Micro-texture: random phase models will reproduce it.",
        "crop": {"x": 8, "y": 8, "width": 32, "height": 40},
    }


@pytest.mark.parametrize("crop", ["5,5,1,1", "0,0,3,1", "8,8,31,32", "8,8,32,31"])
def test_of_a_few_pixels_it_says_that_there_is_no_telling(site, crop):
    answer = get(site, crop=crop).json()
    assert (answer["verdict"], answer["delta"], answer["z"]) == ("unknown", None, None)
    assert answer["words"] == "Too small to tell: the index takes 32 pixels along either side."
    assert ",".join(str(answer["crop"][side]) for side in ("x", "y", "width", "height")) == crop
    assert get(site, crop="8,8,32,32").json()["verdict"] != "unknown"


def test_without_a_crop_all_of_the_sample_is_measured(site):
    assert get(site).json() == get(site, crop="0,0,64,64").json()


def test_the_scale_can_be_chosen(site):
    assert get(site, sigma=0).json()["sigma"] == 0
    assert get(site, sigma=0).json()["delta"] != get(site, sigma=1.5).json()["delta"]


def test_of_a_clip_a_frame_is_measured(site, film, animation):
    """The one that is asked for, else the first."""
    frames = film(3, 40, 40)
    frames[2] = 128
    frames[2, :, 20:] = 200
    address = site.upload(animation(frames))["url"] + "/structure"
    deltas = [site.client.get(address, params={"frame": number}).json()["delta"] for number in range(3)]
    assert site.client.get(address).json()["delta"] == deltas[0]
    assert deltas[0] < 0.1 < deltas[2]


@pytest.mark.parametrize(
    "query",
    [{"crop": "1,2,3"}, {"crop": "0,0,0,9"}, {"crop": "60,0,5,5"}, {"sigma": -1}, {"sigma": "nan"}, {"frame": 1}],
)
def test_what_does_not_fit_is_refused_with_a_problem_that_names_it(site, query):
    answer = get(site, **query)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert [fault["field"] for fault in answer.json()["errors"]] == list(query)


def test_an_unknown_sample_is_not_found(site):
    assert site.client.get(URL.replace("gravel_gray", "none")).status_code == 404


def test_the_page_places_the_photographs_and_explains_the_index_without_a_script(site):
    page = site.client.get("/structure")
    delta = site.service.meter.structure(site.service.samples.get("gravel_gray"), Rectangle(8, 8, 32, 32)).delta
    assert page.status_code == 200
    assert "<script" not in page.text
    assert 'href="/samples/gravel_gray?crop.x=8&amp;crop.y=8&amp;crop.width=32&amp;crop.height=32"' in page.text
    assert f'<span class="meter-number">{max(delta, 0):.2f}</span> {interpret(delta).verdict}' in page.text
    assert page.text.count("<math") > 10
    assert "style=" not in page.text  # the security policy would drop it


@pytest.mark.parametrize("limit", [0.055, 0.075])
def test_the_number_as_it_is_shown_has_one_word(limit):
    """So the limits lie between two values of its second decimal."""
    shown = {f"{delta:.2f}": interpret(delta).verdict for delta in np.arange(0, 0.2, 0.0011)}
    assert all(interpret(float(number)).verdict == word for number, word in shown.items())
    assert interpret(limit - 1e-6).verdict != interpret(limit).verdict


@pytest.mark.parametrize(("delta", "word", "width"), [(-0.02, "micro-texture", "0.0"), (0.1, "structured", "50.0")])
def test_a_picture_s_meter_is_a_bar_a_number_and_a_word(delta, word, width):
    module: Any = TEMPLATES.env.get_template("_partials/meter.html").module
    said = module.meter(delta)
    assert f'class="meter-value" width="{width}"' in said
    assert f"{max(delta, 0):.2f}</span> {word}" in said


def test_a_picture_of_a_few_pixels_has_words_and_no_number():
    module: Any = TEMPLATES.env.get_template("_partials/meter.html").module
    said = module.meter(None)
    assert "too small to tell" in said
    assert "<svg" not in said
    assert "meter-number" not in said


def test_a_crop_of_a_few_pixels_has_words_without_a_script_too(site):
    part = TEMPLATES.env.get_template("_partials/crop_meter.html")
    said = part.render(sample=site.service.samples.get("gravel_gray"), structure=Index(None, None))
    assert 'class="structure unknown"' in said
    assert "Too small to tell" in said
    assert " hidden" not in said.split(">")[0]


@pytest.mark.parametrize("structure", [None, Index(0.1, 1.0)])
def test_the_crop_s_meter_shows_what_the_page_knows_and_hides_until_it_knows(site, structure):
    part = TEMPLATES.env.get_template("_partials/crop_meter.html")
    said = part.render(sample=site.service.samples.get("gravel_gray"), structure=structure)
    assert (" hidden" in said) == (structure is None)
    assert ("Structured: random" in said) == (structure is not None)
    assert 'data-sample="gravel_gray"' in said


def test_pictures_on_the_scale_do_not_overlap_and_stand_at_their_index(site):
    sample = site.service.samples.get("gravel_gray")
    deltas = np.sort(np.random.default_rng(0).uniform(-0.01, 0.45, 60))
    places = place_pictures([Photograph(sample, "", Rectangle(0, 0, 9, 9), delta) for delta in deltas])
    for place in places:
        assert place.left + SIDE / 2 == pytest.approx(10 * meter_place(place.photograph.delta))
    for a, b in itertools.combinations(places, 2):
        assert abs(a.left - b.left) >= SIDE or abs(a.top - b.top) >= SIDE
