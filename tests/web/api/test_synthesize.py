"""``POST /api/v1/synthesize``."""

import socket
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from app.images.video.writers import write_video

URL = "/api/v1/synthesize"


def send(site, data, headers=None, **fields):
    fields = {"method": "rpn", **fields}
    return site.client.post(URL, files={"file": ("photo.png", data)}, data=fields, headers=headers)


def test_a_photograph_comes_back_as_its_texture(site, picture):
    response = send(
        site, picture(), crop="4,4,32,24", width="64", height="50", seed="7", alpha="0.2", window="gaussian"
    )
    assert (response.status_code, response.headers["Content-Type"]) == (200, "image/png")
    assert Image.open(BytesIO(response.content)).size == (64, 50)
    assert response.headers["Content-Disposition"] == 'inline; filename="rpn-texture.png"'


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(site, picture):
    first, second, other = (send(site, picture(), seed=seed).content for seed in ("7", "7", "8"))
    assert first == second != other


def test_it_is_the_texture_that_an_experiment_makes(site, picture):
    sample = site.upload(picture())["id"]
    crop = {"x": 4, "y": 4, "width": 32, "height": 24}
    record = site.finished(inputs=[{"sample": sample, "crop": crop}], parameters={"seed": 3, "width": 50})
    kept = site.client.get(record["outputs"][0]["url"]).content
    assert send(site, picture(), crop="4,4,32,24", seed="3", width="50").content == kept


def several(site, pictures, **fields):
    names = ("file", "file-2", "file-3", "file-4", "file-5")
    files = {name: (f"{name}.png", data) for name, data in zip(names, pictures, strict=False) if data is not None}
    return site.client.post(URL, files=files, data={"method": "mix", **fields})


def test_several_photographs_give_the_texture_that_an_experiment_makes_of_them(site, picture):
    pictures = [picture(seed=seed) for seed in (1, 2, 3)]
    crops = [(4, 4, 32, 24), (0, 0, 20, 30), (8, 2, 30, 30)]
    inputs = [
        {"sample": site.upload(data)["id"], "crop": dict(zip(("x", "y", "width", "height"), crop, strict=True))}
        for data, crop in zip(pictures, crops, strict=True)
    ]
    record = site.finished(method="mix", inputs=inputs, parameters={"seed": 3, "weights": "1,2,3"})
    kept = site.client.get(record["outputs"][0]["url"]).content
    fields = {name: ",".join(map(str, crop)) for name, crop in zip(("crop", "crop-2", "crop-3"), crops, strict=True)}
    response = several(site, pictures, seed="3", weights="1,2,3", **fields)
    assert response.headers["Content-Type"] == "image/png"
    assert response.content == kept


@pytest.mark.parametrize(
    ("given", "fields", "field"),
    [
        ("ab", {"crop-2": "0,0,900,900"}, "crop-2"),
        ("ab", {"crop-2": "much"}, "crop-2"),
        ("ab", {"crop-3": "0,0,9,9"}, "crop-3"),
        ("ab", {"weights": "1,2,3"}, "weights"),
        ("a", {}, "file"),
        ("a.c", {}, "file-2"),
        (".b", {}, "file"),
        ("ab", {"method": "rpn"}, "file"),
    ],
)
def test_a_fault_in_one_of_several_is_refused_with_its_field(site, picture, given, fields, field):
    pictures = [None if place == "." else picture(seed=ord(place)) for place in given]
    response = several(site, pictures, **fields)
    assert response.status_code == 422, response.text
    assert [fault["field"] for fault in response.json()["errors"]] == [field]
    assert site.incoming == []


def test_a_fifth_photograph_is_refused(site, picture):
    assert several(site, [picture()] * 5).status_code == 400


def test_the_bound_of_bytes_is_for_all_photographs_together(site, picture):
    half = picture(190, 190)  # noise hardly deflates: about 100 kB of the 256 that may come
    assert several(site, [half, half], crop="0,0,16,16", **{"crop-2": "0,0,16,16"}).status_code == 200
    assert several(site, [half, half, half]).status_code == 413
    assert site.incoming == []


def test_empty_fields_count_as_left_out(site, picture):
    response = send(site, picture(), crop="", width="", height="", seed="")
    assert Image.open(BytesIO(response.content)).size == (48, 40)


@pytest.mark.parametrize(
    ("accept", "field", "media_type"),
    [
        (None, None, "image/png"),
        ("image/webp", None, "image/webp"),
        ("image/jpeg;q=0.9, image/png;q=0.1", None, "image/jpeg"),
        ("text/html, */*", None, "image/png"),
        ("image/webp", "tiff", "image/tiff"),
    ],
)
def test_the_field_or_the_accept_header_chooses_the_format(site, picture, accept, field, media_type):
    fields = {"format": field} if field else {}
    response = send(site, picture(), headers={"Accept": accept} if accept else None, **fields)
    assert response.headers["Content-Type"] == media_type


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"method": ""}, "method"),
        ({"method": "nothing"}, "method"),
        ({"crop": "1,2,3"}, "crop"),
        ({"crop": "0,0,900,900"}, "crop"),
        ({"format": "gif"}, "format"),
        ({"depth": "12"}, "depth"),
        ({"format": "jpeg", "depth": "16"}, "depth"),
        ({"alpha": "much"}, "alpha"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_a_fault_is_refused_with_the_name_of_its_form_field(site, picture, fields, field):
    response = send(site, picture(), **fields)
    assert (response.status_code, response.headers["Content-Type"]) == (422, "application/problem+json")
    assert [fault["field"] for fault in response.json()["errors"]] == [field]


def test_a_form_without_a_file_is_refused(site):
    response = site.client.post(URL, files={"method": (None, "rpn")})
    assert (response.status_code, response.json()["errors"][0]["field"]) == (422, "file")


def test_nothing_of_it_is_kept(serve, tmp_path, picture):
    with serve(tmp_path) as site:
        before = site.service.experiments.counts()
        assert send(site, picture()).status_code == 200
        assert send(site, picture(), alpha="9").status_code == 422
        assert site.service.experiments.counts() == before
        assert site.client.get("/api/v1/experiments").json()["experiments"] == []
        assert site.incoming == []


def test_hanging_up_cancels_the_run(site, picture, until):
    def running() -> int:
        counts = site.service.experiments.counts()
        return counts.get("running", 0) + counts.get("queued", 0)

    until(lambda: running() == 0)
    with site.gate.closed():
        with site.visitor() as client:
            request = client.build_request("POST", URL, files={"file": ("a.png", picture())}, data={"method": "rpn"})
            body = request.read()
        host, port = site.url.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port))) as connection:
            head = f"POST {URL} HTTP/1.1\r\nHost: {host}\r\nContent-Type: {request.headers['Content-Type']}\r\n"
            connection.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)
            until(running)
        until(lambda: running() == 0)


@pytest.fixture(scope="module", name="clip")
def a_clip(tmp_path_factory):
    path = tmp_path_factory.mktemp("clips") / "clip.webm"
    film = np.random.default_rng(5).integers(0, 256, (10, 40, 48, 3), dtype=np.uint8)
    write_video(film, path, "webm", count=len(film), rate=10.0)
    return path.read_bytes()


def moving(site, clip, accept=None, **fields):
    headers = {"Accept": accept} if accept else None
    data = {"method": "video-rpn", "crop": "4,4,32,24", "time": "2,6", **fields}
    return site.client.post(URL, files={"file": ("clip.webm", clip)}, data=data, headers=headers)


@pytest.mark.parametrize(
    ("accept", "fields", "media_type", "output"),
    [
        (None, {}, "video/webm", "texture"),
        ("video/mp4", {}, "video/mp4", "texture-mp4"),
        ("image/webp,*/*", {"format": "mp4"}, "video/mp4", "texture-mp4"),
    ],
)
def test_a_clip_comes_back_as_the_video_that_an_experiment_makes(site, clip, accept, fields, media_type, output):
    sample = site.upload(clip)["id"]
    crop, frames = {"x": 4, "y": 4, "width": 32, "height": 24}, {"first": 2, "count": 6}
    record = site.finished(method="video-rpn", inputs=[{"sample": sample, "crop": crop, "frames": frames}])
    kept = next(entry for entry in record["outputs"] if entry["name"] == output)
    assert (kept["media_type"], kept["frames"], kept["rate"]) == (media_type, 6, 10.0)
    response = moving(site, clip, accept, **fields)
    assert (response.status_code, response.headers["Content-Type"]) == (200, media_type)
    assert response.content == site.client.get(kept["url"]).content


@pytest.mark.parametrize(
    ("fields", "field", "words"),
    [
        ({"time": "2"}, "time", "first,count"),
        ({"time": "5,6"}, "time", "reaches outside"),
        ({"format": "png"}, "format", "webm or mp4"),
        ({"method": "rpn"}, "time", "1 frame"),
        ({"frames": "1"}, "frames", "whole number from 2"),
    ],
)
def test_what_is_wrong_with_a_moving_run_is_said_at_its_field(site, clip, fields, field, words):
    response = moving(site, clip, **fields)
    assert response.status_code == 422
    (fault,) = response.json()["errors"]
    assert fault["field"] == field
    assert words in fault["message"]


def test_a_still_picture_is_no_clip(site, picture):
    response = moving(site, picture(), time="")
    assert (response.status_code, response.json()["errors"][0]["field"]) == (422, "file")
    assert "upload an MP4" in response.json()["detail"]
