"""One press, one experiment: a form that comes twice with the key of one press is answered with one experiment."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

KEY, OTHER_KEY = 48 * "a", 24 * "0f"
CROP = {"crop.x": "4", "crop.y": "6", "crop.width": "20", "crop.height": "16"}
FORM = {"sample": "gravel_gray", **CROP, "method": "rpn", "size": "1", "seed": "3", "rpn.alpha": "0.1"}


def press(site: Any, client: Any = None, path: str = "/experiments", **changed: str) -> str:
    """Send the form; the experiment's address."""
    form = (FORM if path == "/experiments" else {}) | changed
    answer = (client or site.client).post(path, data=form)
    assert answer.status_code == 303, answer.text
    return str(answer.headers["location"])


def test_the_same_press_is_the_same_experiment(site: Any) -> None:
    with site.visitor() as visitor:
        first = press(site, visitor, press=KEY)
        assert press(site, visitor, press=KEY) == first
        assert press(site, visitor, press=OTHER_KEY) != first


def test_what_was_changed_in_between_is_another_experiment(site: Any) -> None:
    with site.visitor() as visitor:
        presses = [
            press(site, visitor, press=KEY, **changed)
            for changed in ({}, {"seed": "4"}, {"crop.x": "5"}, {"rpn.alpha": "0.2"}, {"unlisted": "on"})
        ]
    assert len(set(presses)) == len(presses)


def test_without_a_key_every_form_is_another_experiment(site: Any) -> None:
    """As without a script; what is no key counts as none, for it may be no secret."""
    for changed in ({}, {"press": ""}, {"press": "1"}, {"press": 48 * "A"}, {"press": 49 * "a"}):
        assert press(site, **changed) != press(site, **changed)


def test_a_key_is_nothing_to_somebody_else(site: Any) -> None:
    with site.visitor() as one, site.visitor() as other:
        press(site, one, seed="9")
        press(site, other, seed="9")  # both have their cookies now
        assert press(site, one, press=KEY) != press(site, other, press=KEY)


def test_a_first_visitor_whose_answer_was_lost_owns_what_was_pressed(site: Any) -> None:
    """No cookie has come yet when the second request goes out; what came with either answer is the owner's."""
    with site.visitor() as visitor:
        first = press(site, press=OTHER_KEY, client=visitor, seed="77")
        token = visitor.cookies["microtexture_owner"]
        visitor.cookies.clear()
        assert press(site, press=OTHER_KEY, client=visitor, seed="77") == first
        assert visitor.cookies["microtexture_owner"] == token
        assert OTHER_KEY not in token
        assert (
            ">Manage</h2>" in visitor.get(first).text
            or site.client.get(f"/api/v1{first}").json()["status"] != "succeeded"
        )


def test_two_at_once_are_one(site: Any) -> None:
    with site.visitor() as visitor, ThreadPoolExecutor(8) as threads:
        press(site, visitor, seed="1")
        found = list(threads.map(lambda _: press(site, visitor, press=KEY, seed="12"), range(8)))
    assert len(set(found)) == 1


def test_a_new_seed_is_one_seed_a_press(site: Any) -> None:
    record = site.finished(parameters={"seed": 5})
    path = f"/experiments/{record['id']}/again"
    with site.visitor() as visitor:
        first = press(site, visitor, path, method="rpn", seed="new", press=KEY)
        assert press(site, visitor, path, method="rpn", seed="new", press=KEY) == first
        assert press(site, visitor, path, method="rpn", seed="new", press=OTHER_KEY) != first
        assert press(site, visitor, path, method="adsn", press=KEY).startswith("/compare/")


def test_a_full_queue_gives_what_was_pressed_already(serve: Any, tmp_path: Any, until: Any) -> None:
    """The answer that was lost had been taken."""
    with serve(tmp_path, queue_limit=1) as site, site.gate.closed():
        running = press(site, seed="1")
        until(lambda: site.client.get(f"/api/v1{running}").json()["status"] == "running")
        waiting = press(site, press=KEY, seed="2")
        assert site.client.post("/experiments", data=FORM).status_code == 503
        assert press(site, press=KEY, seed="2") == waiting


def test_what_was_deleted_is_pressed_anew(site: Any, until: Any) -> None:
    with site.visitor() as visitor:
        first = press(site, visitor, press=KEY, seed="21")
        until(lambda: visitor.get(f"/api/v1{first}").json()["status"] == "succeeded")
        assert visitor.delete(f"/api/v1{first}").status_code == 204
        again = press(site, visitor, press=KEY, seed="21")
        assert again != first
        assert visitor.get(again).status_code == 200


@pytest.mark.parametrize("path", ["/samples/gravel_gray", "/experiments/{}"])
def test_pages_say_which_forms_start_experiments(site: Any, path: str) -> None:
    record = site.finished()
    page = site.client.get(path.format(record["id"])).text
    starting = page.count('action="/experiments"') + page.count('/again"')
    assert starting > 0
    assert page.count("data-press") == starting
    assert "/static/js/pages/press.js" in page
