"""Films on the pages of experiments, in lists and beside each other, as the server writes them."""

import html
import re
from collections.abc import Callable
from io import BytesIO
from typing import Any

import av
import numpy as np
import pytest
from PIL import Image

from app.methods.explanations.model import Exhibit
from app.web.pictures.exhibits import ExhibitPicture, exhibit_pictures
from app.web.pictures.videos import find_video
from app.web.templating import TEMPLATES
from tests.web.versions import without_versions

TIME = {"first": 1, "count": 5}
CROP = {"x": 4, "y": 2, "width": 32, "height": 28}


@pytest.fixture(scope="module")
def clip(site: Any, film: Callable[..., np.ndarray], animation: Callable[..., bytes]) -> str:
    """The id of a sample of 7 frames."""
    return str(site.upload(animation(film(7)), "clip.png")["id"])


@pytest.fixture(scope="module")
def films(site: Any, clip: str) -> dict[str, Any]:
    """The record of a finished video of 5 of its frames."""
    inputs = [{"sample": clip, "crop": CROP, "frames": TIME}]
    return dict(site.finished(method="video-rpn", inputs=inputs, parameters={"frames": 6, "seed": 2}))


def page_of(site: Any, path: str) -> str:
    answer = site.client.get(path, headers={"Accept": "text/html"})
    assert answer.status_code == 200, answer.text
    return without_versions(str(answer.text))


def stages(text: str) -> str:
    return text.split('class="panes')[1].split("<template", maxsplit=1)[0]


def videos(text: str) -> list[str]:
    return re.findall(r"<video .*?</video>", text, re.DOTALL)


def outputs(record: dict[str, Any]) -> str:
    return f"/api/v1/experiments/{record['id']}/outputs"


def test_crop_and_texture_stand_beside_each_other_as_videos(site: Any, films: dict[str, Any]) -> None:
    """WebM before MP4; they begin by themselves for nobody, for the server cannot know who asked for reduced motion."""
    found = videos(stages(page_of(site, f"/experiments/{films['id']}")))
    for video, name in zip(found, ("crop", "texture"), strict=True):
        assert re.findall(r'<source src="([^"]+)" type="([^"]+)">', video) == [
            (f"{outputs(films)}/{name}", "video/webm"),
            (f"{outputs(films)}/{name}-mp4", "video/mp4"),
        ]
        for attribute in ("muted", "playsinline", "loop", "controls"):
            assert f" {attribute}" in video
        assert "autoplay" not in video
        assert f'data-frames="{6 if name == "texture" else 5}"' in video


@pytest.mark.parametrize("name", ["crop", "texture"])
def test_the_poster_is_the_first_frame(site: Any, films: dict[str, Any], name: str) -> None:
    answer = site.client.get(f"{outputs(films)}/.poster-{name}")
    assert answer.headers["content-type"] == "image/png"
    with Image.open(BytesIO(answer.content)) as poster:
        assert poster.size == (32, 28)
        assert getattr(poster, "n_frames", 1) == 1


def test_the_crop_s_poster_has_the_clip_s_pixels(
    site: Any, films: dict[str, Any], film: Callable[..., np.ndarray]
) -> None:
    poster = np.asarray(Image.open(BytesIO(site.client.get(f"{outputs(films)}/.poster-crop").content)))
    assert np.array_equal(poster, film(7)[TIME["first"], 2:30, 4:36])


def test_every_download_is_a_file_of_the_film(site: Any, films: dict[str, Any]) -> None:
    """No still format is offered for what moves."""
    found = re.findall(r'<a class="button" href="(/api/v1/[^"]+)">', page_of(site, f"/experiments/{films['id']}"))
    kinds = [site.client.get(html.unescape(address)).headers["content-type"] for address in found]
    assert kinds == ["video/webm", "video/mp4", "image/webp", "application/zip"]


def test_an_mp4_that_is_larger_than_the_texture_is_told_of_beside_its_link(site: Any, films: dict[str, Any]) -> None:
    """And the record has each file's own size, as a decoder finds it."""
    assert "there twice" not in page_of(site, f"/experiments/{films['id']}")
    inputs = [{"sample": films["inputs"][0]["sample"], "crop": CROP, "frames": TIME}]
    cases = {(31, 27): "last column and last row are", (32, 27): "last row is", (31, 28): "last column is"}
    for (width, height), words in cases.items():
        parameters = {"frames": 5, "width": width, "height": height, "seed": 2}
        odd = site.finished(method="video-rpn", inputs=inputs, parameters=parameters)
        even = width + width % 2, height + height % 2
        text = page_of(site, f"/experiments/{odd['id']}")
        assert f"The MP4 has {even[0]} × {even[1]} pixels" in text
        assert f"its {words} there twice" in text
        record = {output["name"]: output for output in odd["outputs"]}
        assert (record["texture"]["width"], record["texture"]["height"]) == (width, height)
        assert record["texture"]["title"] == "Texture"
        for name in ("texture", "texture-mp4"):
            with av.open(BytesIO(site.client.get(f"{outputs(odd)}/{name}").content)) as file:
                frame = next(file.decode(video=0))
            assert (frame.width, frame.height) == (record[name]["width"], record[name]["height"])
        assert (record["texture-mp4"]["width"], record["texture-mp4"]["height"]) == even
        assert words.rsplit(" ", 1)[0] in record["texture-mp4"]["title"]


def test_the_page_says_where_it_comes_from_and_how_it_continues(site: Any, films: dict[str, Any], clip: str) -> None:
    text = page_of(site, f"/experiments/{films['id']}")
    for words in ("frames 1–5 of 7", "32 × 28, 6 frames", "32 × 28, 5 frames, 10 a second", "Its last frame continues"):
        assert words in text
    assert (
        f'href="/samples/{clip}?time.first=1&amp;time.count=5&amp;crop.x=4&amp;crop.y=2&amp;crop.width=32&amp;crop.height=28"'
        in text
    )


def test_the_tiled_view_without_a_script_repeats_first_frames(site: Any, films: dict[str, Any]) -> None:
    text = stages(page_of(site, f"/experiments/{films['id']}?view=tiled"))
    assert text.count(f'<img src="{outputs(films)}/.poster-texture"') == 4
    assert [" hidden>" in video for video in videos(text)] == [True, True]


def test_steps_are_stills(site: Any, films: dict[str, Any]) -> None:
    text = page_of(site, f"/experiments/{films['id']}?view=steps").split('<ul class="steps')[1].split("</ul>")[0]
    names = re.findall(r'<img src="[^"]+/outputs/([^"]+)"', text)
    assert names[:2] == ["crop-cube", "cube"]
    assert not {"texture", "crop", "preview", "texture-mp4", "crop-mp4"} & set(names)


def test_run_again_keeps_the_time_range(site: Any, films: dict[str, Any]) -> None:
    answer = site.client.post(f"/experiments/{films['id']}/again", data={"method": "video-rpn", "seed": "new"})
    again = site.client.get(f"/api/v1{answer.headers['location']}").json()
    assert again["inputs"] == films["inputs"]
    assert again["parameters"]["frames"] == films["parameters"]["frames"]


def test_lists_tell_films_from_pictures(site: Any, films: dict[str, Any], experiment: dict[str, Any]) -> None:
    entries = page_of(site, "/archive").split('<li><a class="pair"')[1:]
    marked = {
        record["id"]: any(record["id"] in entry and ">Video<" in entry for entry in entries)
        for record in (films, experiment)
    }
    assert marked == {films["id"]: True, experiment["id"]: False}
    for name in (".thumbnail-crop", ".thumbnail-texture", ".preview"):
        assert site.client.get(f"{outputs(films)}/{name}").headers["content-type"].startswith("image/")


def test_two_films_are_compared_by_one_player(site: Any, films: dict[str, Any], clip: str) -> None:
    inputs = [{"sample": clip, "crop": CROP, "frames": {"first": 0, "count": 4}}]
    other = site.finished(method="video-rpn", inputs=inputs, parameters={"seed": 3})
    text = page_of(site, f"/compare/{films['id']}/{other['id']}")
    assert len(videos(stages(text))) == 4
    assert text.count('class="player"') == 1
    assert "Their last frames continue" in text


def test_while_it_waits_its_page_shows_the_first_frame_of_the_time_range(site: Any, clip: str) -> None:
    with site.gate.closed():
        inputs = [{"sample": clip, "crop": CROP, "frames": TIME}]
        record = site.run(wait=False, method="video-rpn", inputs=inputs, parameters={"seed": 4}).json()
        text = page_of(site, f"/experiments/{record['id']}")
    assert f'href="/api/v1/samples/{clip}/image?size=2048&amp;frame=1"' in text
    assert site.client.get(f"/api/v1/samples/{clip}/image?size=2048&frame=1").status_code == 200


def test_a_method_s_page_says_what_its_inputs_are(site: Any) -> None:
    moving, still = (page_of(site, f"/methods/{name}") for name in ("video-rpn", "modulus-phase"))
    assert ">a video</span>" in moving
    assert '<span class="mark">Video</span>' in moving
    assert still.count(">a picture</span>") == 2
    assert 'class="mark"' not in still


def test_a_figure_plays_a_film_when_asked_and_a_card_shows_its_first_frame(site: Any, films: dict[str, Any]) -> None:
    """Nothing of it is loaded before; its experiment is one click away all the same."""
    made = site.service.experiments.get(films["id"])
    output = made.output("texture")
    assert output is not None
    entry = ExhibitPicture(
        "Video RPN", f"{outputs(films)}/texture", f"/experiments/{made.id}", 32, 28, video=find_video(made, output)
    )
    module: Any = TEMPLATES.env.get_template("_partials/figure.html").module
    played = module.picture(entry)
    assert ' preload="none"' in played
    assert ".poster-texture" in played
    assert f'href="/experiments/{made.id}"' in module.caption(entry)
    assert "<video" not in module.picture(entry, still=True)
    assert ".poster-texture" in module.picture(entry, still=True)


def test_an_exhibit_that_is_not_made_shows_its_inputs_by_their_parts(site: Any) -> None:
    """As many as it is to show, and one place for all that the method makes."""
    source = ("gravel_gray", "0,0,16,16")
    exhibit = Exhibit("modulus-phase", (source, source), show=("crop", "crop-2", "texture"))
    assert [(entry.caption, entry.leads) for entry in exhibit_pictures(site.service, exhibit)] == [
        ("Modulus", True),
        ("Phase", False),
        ("Modulus and phase", False),
    ]
