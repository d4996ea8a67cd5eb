"""Video samples in the API: single frames, and files that play."""

from io import BytesIO

import av
import numpy as np
import pytest
from PIL import Image


def decoded(content):
    """Frames (T, H, W, 3) of a file, and how many are shown a second."""
    with av.open(BytesIO(content)) as file:
        frames = np.stack([frame.to_ndarray(format="rgb24") for frame in file.decode(video=0)])
        return frames, float(file.streams.video[0].average_rate or 0)


def test_an_uploaded_clip_is_a_sample_of_several_frames(site, clip):
    record = site.client.get(f"/api/v1/samples/{clip}").json()
    assert [record[name] for name in ("width", "height", "frames", "rate")] == [48, 40, 6, 10]


def test_the_image_of_a_clip_is_one_of_its_frames(site, clip, film):
    address = f"/api/v1/samples/{clip}/image"
    for number, frame in enumerate(film()):
        answer = site.client.get(address, params={"frame": number})
        assert np.array_equal(np.asarray(Image.open(BytesIO(answer.content))), frame)
    small = site.client.get(address, params={"frame": 5, "size": 256})
    assert small.headers["Content-Type"] == "image/jpeg"
    assert Image.open(BytesIO(small.content)).size == (48, 40)
    tags = {site.client.head(address, params={"frame": number}).headers["ETag"] for number in range(6)}
    assert len(tags) == 6
    assert site.client.get(address).content == site.client.get(address, params={"frame": 0}).content


@pytest.mark.parametrize(("frame", "words"), [(6, "6 frames"), (-1, "greater than or equal")])
def test_there_is_no_other_frame(site, clip, frame, words):
    answer = site.client.get(f"/api/v1/samples/{clip}/image", params={"frame": frame})
    assert answer.status_code == 422
    assert words in answer.text


def test_a_photograph_has_one_frame_and_no_video(site):
    assert site.client.get("/api/v1/samples/gravel_gray/image?frame=0").status_code == 200
    assert "one frame" in site.client.get("/api/v1/samples/gravel_gray/image?frame=1").json()["detail"]
    answer = site.client.get("/api/v1/samples/gravel_gray/video")
    assert (answer.status_code, answer.headers["Content-Type"]) == (404, "application/problem+json")
    assert "still picture" in answer.json()["detail"]


def test_a_clip_plays_as_mp4(site, clip):
    answer = site.client.get(f"/api/v1/samples/{clip}/video")
    assert answer.headers["Content-Type"] == "video/mp4"
    frames, rate = decoded(answer.content)
    assert (frames.shape, rate) == ((6, 40, 48, 3), 10)


def test_a_clip_as_webm_has_its_very_pixels(site, clip, film):
    answer = site.client.get(f"/api/v1/samples/{clip}/video", params={"format": "webm"})
    assert answer.headers["Content-Type"] == "video/webm"
    frames, rate = decoded(answer.content)
    assert np.array_equal(frames, film())
    assert rate == 10


def test_a_transparent_clip_lies_on_grey(site, film, animation):
    frames = film(3, alpha=True)
    frames[..., 3] = 255
    frames[:, :20, :, 3] = 0
    sample = site.upload(animation(frames))
    assert sample["transparent"]
    shown, _ = decoded(site.client.get(f"{sample['url']}/video", params={"format": "webm"}).content)
    assert np.array_equal(shown[:, 20:], frames[:, 20:, :, :3])
    assert np.all(shown[:, :20] == 128)


def test_a_film_keeps_the_words_of_files(site, clip):
    """HEAD, a strong tag, 304, ranges as players ask for them, and nothing else than the two formats."""
    address = f"/api/v1/samples/{clip}/video"
    whole = site.client.get(address)
    head = site.client.head(address)
    assert (head.status_code, head.content) == (200, b"")
    assert head.headers["Content-Length"] == str(len(whole.content))
    assert site.client.get(address, headers={"If-None-Match": whole.headers["ETag"]}).status_code == 304
    part = site.client.get(address, headers={"Range": "bytes=100-199"})
    assert (part.status_code, part.content) == (206, whole.content[100:200])
    assert site.client.get(address, headers={"Range": "bytes=99999999-"}).status_code == 416
    assert site.client.get(address, params={"format": "avi"}).status_code == 422
    assert 'filename="' + clip + '.mp4"' in whole.headers["Content-Disposition"]
