"""The structure index of a crop by the API, and the page that explains it."""

import pytest

from app.images.crop import Rectangle

URL = "/api/v1/samples/gravel_gray/structure"


def get(site, **query):
    return site.client.get(URL, params=query)


def test_it_answers_with_the_index_its_words_and_what_was_measured(site):
    answer = get(site, crop="8,8,32,40").json()
    found = site.service.structure("gravel_gray", Rectangle(8, 8, 32, 40))
    assert answer == {
        "delta": pytest.approx(found.delta, abs=1e-4),
        "z": pytest.approx(found.z, abs=1e-2),
        "sigma": 2,
        "verdict": "micro-texture",
        "words": "Micro-texture: random phase models will reproduce it.",
        "crop": {"x": 8, "y": 8, "width": 32, "height": 40},
    }


def test_without_a_crop_all_of_the_sample_is_measured(site):
    assert get(site).json() == get(site, crop="0,0,64,64").json()


def test_the_scale_can_be_chosen(site):
    assert get(site, sigma=0).json()["sigma"] == 0
    assert get(site, sigma=0).json()["delta"] != get(site, sigma=1.5).json()["delta"]


@pytest.mark.parametrize(
    "query", [{"crop": "1,2,3"}, {"crop": "0,0,0,9"}, {"crop": "60,0,5,5"}, {"sigma": -1}, {"sigma": "nan"}]
)
def test_what_does_not_fit_is_refused_with_a_problem_that_names_it(site, query):
    answer = get(site, **query)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert [fault["field"] for fault in answer.json()["errors"]] == list(query)


def test_an_unknown_sample_is_not_found(site):
    assert site.client.get(URL.replace("gravel_gray", "none")).status_code == 404
