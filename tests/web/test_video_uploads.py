"""Videos sent to ``/api/v1/samples``: records with frames, and refusals in words; the service goes on after each."""

import pytest

from tests.images.clips import animation, moving, video

FILM = moving(12)


@pytest.mark.parametrize(
    ("data", "media_type"),
    [
        (video(FILM), "video/mp4"),
        (video(FILM, "libvpx-vp9", form="webm"), "video/webm"),
        (animation(FILM, "GIF"), "image/gif"),
        (animation(FILM, "PNG"), "image/apng"),
        (animation(FILM, "WEBP"), "image/webp"),
    ],
    ids=["mp4", "webm", "gif", "apng", "webp"],
)
def test_a_video_becomes_a_sample_with_frames(site, data, media_type):
    record = site.upload(data, name="clip.bin")
    assert (record["width"], record["height"], record["frames"], record["rate"]) == (64, 48, 12, 25)
    assert (record["media_type"], record["depth"], record["transparent"]) == (media_type, 8, False)


def test_a_gif_of_one_picture_becomes_a_still(site):
    record = site.upload(animation(FILM[:1], "GIF"))
    assert (record["frames"], record["media_type"]) == (1, "image/png")


@pytest.mark.parametrize(
    ("data", "status", "words"),
    [
        (video(moving(2), "mpeg4"), 415, "Save this video as MP4 with H.264"),
        (video(FILM)[:-100], 422, "damaged or incomplete"),
        (animation(FILM, "GIF")[:-50], 422, "damaged or incomplete"),
        (video(moving(601, 16, 16), options={"preset": "ultrafast"}), 413, "at most 600 frames"),
        (video(moving(3), rate=1, ticks=[0, 40, 80]), 413, "60 seconds"),
    ],
    ids=["codec", "truncated mp4", "truncated gif", "frames", "seconds"],
)
def test_a_video_that_cannot_be_taken_is_refused_in_words(site, data, status, words):
    response = site.client.post("/api/v1/samples", files={"file": ("clip.mp4", data)})
    assert (response.status_code, response.headers["Content-Type"]) == (status, "application/problem+json")
    assert words in response.json()["detail"]
    assert site.upload(video(FILM))["frames"] == 12


def test_the_limits_of_videos_are_settings(serve, tmp_path):
    with serve(tmp_path, max_film_frames=11) as site:
        response = site.client.post("/api/v1/samples", files={"file": ("clip.mp4", video(FILM))})
        assert (response.status_code, "at most 11 frames" in response.json()["detail"]) == (413, True)
    with serve(tmp_path / "pixels", max_film_pixels=12 * 64 * 48 - 1) as site:
        response = site.client.post("/api/v1/samples", files={"file": ("clip.gif", animation(FILM, "GIF"))})
        assert (response.status_code, "all frames together" in response.json()["detail"]) == (413, True)
