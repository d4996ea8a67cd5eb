"""``/api/v1/samples``."""

import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from io import BytesIO
from typing import cast

import httpx
import pytest
from PIL import Image

from app.errors import BusyError
from app.experiments.service import Service
from app.main import create_app

MANY = 50  # more than the 40 threads that Starlette answers with
PATIENCE = 20.0


def test_an_upload_becomes_a_sample_with_a_location(site, picture):
    response = site.client.post("/api/v1/samples", files={"file": ("photo.png", picture(48, 40))})
    assert response.status_code == 201
    record = response.json()
    assert response.headers["Location"] == record["url"] == f"{site.url}/api/v1/samples/{record['id']}"
    assert (record["width"], record["height"], record["channels"], record["depth"]) == (48, 40, 3, 8)
    assert (record["frames"], record["media_type"], record["transparent"]) == (1, "image/png", False)
    assert site.client.get(record["url"]).json() == record


def test_bundled_samples_are_listed_and_uploaded_ones_are_not(site):
    uploaded = site.upload()["id"]
    listed = [sample["id"] for sample in site.client.get("/api/v1/samples").json()["samples"]]
    assert "gravel_gray" in listed
    assert uploaded not in listed


def test_the_image_is_the_sample_itself_or_a_smaller_rendition(site, picture):
    sample = site.upload(picture(400, 200))
    whole = site.client.get(f"{sample['url']}/image")
    assert whole.headers["Content-Type"] == "image/png"
    assert Image.open(BytesIO(whole.content)).size == (400, 200)
    small = site.client.get(f"{sample['url']}/image", params={"size": 200})
    assert small.headers["Content-Type"] == "image/jpeg"
    assert max(Image.open(BytesIO(small.content)).size) == 256
    assert small.headers["ETag"] != whole.headers["ETag"]
    again = site.client.get(f"{sample['url']}/image", headers={"If-None-Match": whole.headers["ETag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_a_transparent_sample_says_so(site, picture):
    assert site.upload(picture(mode="RGBA"))["transparent"] is True


@pytest.mark.parametrize(
    ("data", "status"),
    [(b"not a picture at all", 415), (b"", 422), (b"%PDF-1.7 something", 415), (b"GIF89a\x01\x00\x01\x00", 422)],
    ids=["text", "empty", "pdf", "half a gif"],
)
def test_what_is_no_picture_is_refused(site, data, status):
    response = site.client.post("/api/v1/samples", files={"file": ("photo.png", data)})
    assert (response.status_code, response.headers["Content-Type"]) == (status, "application/problem+json")


def test_a_truncated_picture_is_refused(site, picture):
    response = site.client.post("/api/v1/samples", files={"file": ("photo.png", picture()[:400])})
    assert (response.status_code, response.headers["Content-Type"]) == (422, "application/problem+json")


def test_a_picture_with_too_many_pixels_is_refused(site):
    file = BytesIO()
    Image.new("L", (1200, 1000)).save(file, "PNG")
    response = site.client.post("/api/v1/samples", files={"file": ("photo.png", file.getvalue())})
    assert response.status_code == 413


@pytest.mark.parametrize(
    "form",
    [{"files": {"other": ("photo.png", b"x")}}, {"files": {"file": ("", b"")}}, {"files": {"note": (None, "x")}}],
    ids=["another name", "no file chosen", "only a text"],
)
def test_a_form_without_the_file_is_refused(site, form):
    response = site.client.post("/api/v1/samples", **form)
    assert response.status_code in {400, 422}
    assert response.headers["Content-Type"] == "application/problem+json"


def test_no_upload_leaves_its_temporary_file(site, picture):
    for data in (picture(), b"no picture", picture()[:300]):
        site.client.post("/api/v1/samples", files={"file": ("photo.png", data)})
    assert site.incoming == []


def test_uploads_that_are_decoded_hold_nobody_up(site, serving, picture, until):
    """Neither the event loop nor the threads that answer the rest wait for them, however many there are."""

    class Decoding:
        ready = True
        waiting = 0
        begun = 0
        samples = experiments = availability = property(lambda self: self)
        go_on = threading.Event()

        def start(self) -> None: ...

        def close(self) -> None: ...

        def missing(self) -> None:
            return None

        def require(self) -> None: ...

        def counts(self) -> dict[str, int]:
            return {}

        def add(self, upload, owner):
            self.begun += 1
            self.go_on.wait(PATIENCE)
            raise BusyError("That was long.")

    service, data = Decoding(), picture()
    with (
        serving(create_app(site.settings, cast(Service, service))) as url,
        httpx.Client(timeout=PATIENCE, limits=httpx.Limits(max_connections=None), verify=False) as client,
        ThreadPoolExecutor(MANY) as pool,
    ):
        send = partial(client.post, f"{url}/api/v1/samples", files={"file": ("a.png", data)})
        uploads = [pool.submit(send) for _ in range(MANY)]
        until(lambda: service.begun >= 4)
        until(lambda: len(site.incoming) == MANY)
        for path in ("/healthz", "/readyz", "/metrics", "/api/v1/methods"):
            assert client.get(f"{url}{path}").status_code == 200
        assert not any(upload.done() for upload in uploads)
        service.go_on.set()
        assert {upload.result().status_code for upload in uploads} == {503}


@pytest.mark.parametrize(
    "path", ["/api/v1/samples/none", "/api/v1/samples/none/image", "/api/v1/samples/a%00b", "/api/v1/samples/%ff"]
)
def test_an_unknown_sample_is_not_found(site, path):
    response = site.client.get(path)
    assert (response.status_code, response.headers["Content-Type"]) == (404, "application/problem+json")
