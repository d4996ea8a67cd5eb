"""Home page, and the upload of a sample from it, as the server writes them."""

import re
from collections.abc import Callable
from typing import Any

import pytest

from tests.web.pages.markup import Page, get

CROP = {"crop.x": "4", "crop.y": "6", "crop.width": "20", "crop.height": "16"}


def test_home_shows_samples_and_newest_results(site: Any) -> None:
    experiment = site.finished()
    page = get(site, "/")
    assert page.all("a", href="/samples/gravel_gray")
    assert page.all("a", href=f"/experiments/{experiment['id']}")
    for image in page.all("img"):
        assert site.client.get(image["src"]).status_code == 200


def test_an_upload_by_form_leads_to_the_sample(site: Any, picture: Callable[..., bytes]) -> None:
    with site.visitor() as visitor:
        answer = visitor.post("/samples", files={"file": ("photo.png", picture(48, 40))})
        assert answer.status_code == 303
        assert "microtexture_owner" in visitor.cookies
        page = Page(visitor.get(answer.headers["location"]).text)
    assert [page.value(name) for name in CROP] == ["0", "0", "48", "40"]


@pytest.mark.parametrize(
    ("data", "status"),
    [(b"This is text.", 415), (b"", 422), (bytes(1 << 19), 413)],
    ids=["not a picture", "no file", "too many bytes"],
)
def test_a_refused_upload_shows_the_form_again_with_a_message(site: Any, data: bytes, status: int) -> None:
    files = {"file": ("photo.png" if data else "", data)}
    answer = site.client.post("/samples", files=files)
    assert answer.status_code == status
    page = Page(answer.text)
    assert page.title.startswith("Error")
    message = re.search(r'id="upload-error"[^>]*>([^<]+)<', answer.text)
    assert message is not None
    assert page.all("p", id="upload-error")[0]["role"] == "alert"
