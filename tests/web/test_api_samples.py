"""``/api/v1/samples``."""

import threading
from io import BytesIO

import pytest
from PIL import Image


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
    [(b"not a picture at all", 415), (b"", 422), (b"%PDF-1.7 something", 415), (b"GIF89a\x01\x00\x01\x00", 415)],
    ids=["text", "empty", "pdf", "gif"],
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
    assert list((site.settings.data_dir / "incoming").iterdir()) == []


def test_the_web_answers_while_an_upload_is_decoded(site, picture):
    """The event loop never waits for a decoding."""
    big = picture(900, 90, seed=5)
    uploads = [threading.Thread(target=site.upload, args=[big]) for _ in range(6)]
    for upload in uploads:
        upload.start()
    slowest = 0.0
    while any(upload.is_alive() for upload in uploads):
        slowest = max(slowest, site.client.get("/healthz").elapsed.total_seconds())
    assert 0 < slowest < 0.5


@pytest.mark.parametrize(
    "path", ["/api/v1/samples/none", "/api/v1/samples/none/image", "/api/v1/samples/a%00b", "/api/v1/samples/%ff"]
)
def test_an_unknown_sample_is_not_found(site, path):
    response = site.client.get(path)
    assert (response.status_code, response.headers["Content-Type"]) == (404, "application/problem+json")
