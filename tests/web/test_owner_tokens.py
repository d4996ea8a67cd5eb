"""A token that can be guessed owns nothing, and pages that show an owner's buttons are kept by no shared cache."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from app.settings import Settings

WEAK = ["a", "x" * 15, "x" * 513, "sixteen letters with spaces"]


@pytest.mark.parametrize("token", WEAK)
def test_the_api_refuses_a_weak_token_in_words(site: Any, token: str) -> None:
    headers = {"Authorization": f"Bearer {token}"}
    record = site.finished()
    answers = [
        site.client.post("/api/v1/experiments", json={"method": "rpn", "inputs": []}, headers=headers),
        site.client.post("/api/v1/samples", files={"file": ("a.png", b"x")}, headers=headers),
        site.client.patch(record["url"], json={"listed": False}, headers=headers),
        site.client.delete(record["url"], headers=headers),
    ]
    for answer in answers[1:]:
        assert answer.status_code == 422
        assert "16" in answer.json()["detail"]
        assert answer.json()["errors"][0]["field"] == "authorization"
    assert site.client.get(record["url"], headers=headers).json()["listed"] is True
    assert answers[0].status_code == 422


def test_a_weak_token_makes_no_experiment(site: Any) -> None:
    body = {"method": "rpn", "inputs": [{"sample": "gravel_gray"}]}
    before = site.service.experiments.counts()
    with site.visitor(headers={"Authorization": "Bearer short"}) as visitor:
        answer = visitor.post("/api/v1/experiments", json=body)
    assert (answer.status_code, "owner_token" in answer.text) == (422, False)
    assert sum(site.service.experiments.counts().values()) == sum(before.values())


@pytest.mark.parametrize("token", ["x" * 16, "x" * 512])
def test_a_long_one_owns(site: Any, token: str) -> None:
    headers = {"Authorization": f"Bearer {token}"}
    with site.visitor(headers=headers) as owner:
        record = site.run(client=owner).json()
        assert "owner_token" not in record
        assert owner.delete(record["url"]).status_code == 204


def test_a_page_takes_the_cookie_where_a_proxys_own_token_is_none_of_ours(site: Any) -> None:
    """A proxy that asks for a login may pass on a bearer of a thousand characters with every request."""
    with site.visitor() as visitor:
        record = site.run(client=visitor).json()
        answer = visitor.post(f"/experiments/{record['id']}/delete", headers={"Authorization": f"Bearer {1000 * 'x'}"})
        assert (answer.status_code, answer.headers["location"]) == (303, "/archive")


def test_a_cookie_that_can_be_guessed_is_none(site: Any, picture: Callable[..., bytes]) -> None:
    """Who sends one gets another with what is made."""
    with site.visitor(cookies={"microtexture_owner": "a"}) as visitor:
        answer = visitor.post("/samples", files={"file": ("photo.png", picture())})
        assert answer.status_code == 303
        assert len(answer.cookies["microtexture_owner"]) == 32


def test_the_operators_own_token_is_as_long_as_it_was_made(
    serve: Any, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Hosts that have a short one go on working, and are told."""
    with serve(tmp_path, operator_token="short") as site:
        record = site.finished()
        with site.visitor(headers={"Authorization": "Bearer short"}) as operator:
            assert operator.delete(record["url"]).status_code == 204
        with site.visitor(headers={"Authorization": "Bearer shor"}) as other:
            assert other.delete(site.finished()["url"]).status_code == 422
    assert "MICROTEXTURE_OPERATOR_TOKEN" in caplog.text


def test_a_refused_setting_is_not_shown() -> None:
    """It may be a password in the wrong place."""
    with pytest.raises(ValidationError) as refusal:
        Settings(queue_limit="hush-hush")
    assert "hush-hush" not in str(refusal.value)


@pytest.mark.parametrize(
    "path", ["/", "/archive", "/samples/gravel_gray", "/experiments/{}", "/compare/{}/{}", "/none"]
)
def test_no_shared_cache_keeps_a_page(site: Any, experiment: dict[str, Any], path: str) -> None:
    answer = site.client.get(path.format(experiment["id"], experiment["id"]))
    assert "private" in answer.headers["Cache-Control"]
    assert "public" not in answer.headers["Cache-Control"]
