"""The catalogue of the bundled photographs and clips is complete, honest and points at real regions."""

import json
import runpy
import subprocess
import sys
from itertools import islice
from pathlib import Path

import av
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.samples import CATALOGUE, BundledSample, read_catalogue
from app.settings import ROOT

SAMPLES = ROOT / "samples"


def film(path: Path) -> NDArray[np.uint8]:
    """(T, H, W, 3)."""
    with av.open(str(path)) as container:
        return np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)])


@pytest.fixture(scope="module")
def photographs() -> list[BundledSample]:
    return read_catalogue(SAMPLES)


def test_every_photograph_of_the_directory_has_exactly_one_entry(photographs: list[BundledSample]) -> None:
    files = {path.name for path in SAMPLES.iterdir() if path.suffix in {".png", ".jpg", ".mp4"}}
    assert {photograph.path.name for photograph in photographs} == files
    assert len({photograph.id for photograph in photographs}) == len(photographs) == len(files)


def test_every_suggested_crop_lies_inside_its_photograph(photographs: list[BundledSample]) -> None:
    for photograph in photographs:
        if photograph.kind == "moving":
            photograph.crop.check_within(*film(photograph.path).shape[2:0:-1])
            continue
        with Image.open(photograph.path) as image:
            photograph.crop.check_within(*image.size)


def test_suggested_crops_are_large_enough_to_hold_a_texture(photographs: list[BundledSample]) -> None:
    for photograph in photographs:
        smallest = 64 if photograph.kind == "scene" else 192
        assert min(photograph.crop.width, photograph.crop.height) >= smallest, photograph.id


def test_every_photograph_names_its_author_and_a_licence_that_sources_md_gives_it(
    photographs: list[BundledSample],
) -> None:
    rows = {}
    for line in (SAMPLES / "SOURCES.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        rows[cells[0]] = cells
    for photograph in photographs:
        licence, author = rows[photograph.path.name][4:6]
        assert photograph.licence.replace(" ", "-").removesuffix("-1.0") == licence.removesuffix("-1.0")
        assert photograph.licence_url.startswith("https://creativecommons.org/")
        assert photograph.credit == author or author.startswith("group")


def test_titles_are_plain_words_and_tell_the_photographs_apart(photographs: list[BundledSample]) -> None:
    titles = [photograph.title for photograph in photographs]
    assert len(set(titles)) == len(titles)
    assert all(title[0].isupper() and "_" not in title for title in titles)


def test_a_directory_without_a_catalogue_has_no_samples(tmp_path: Path) -> None:
    assert read_catalogue(tmp_path) == []


def test_an_entry_without_its_file_is_an_error_that_names_it(tmp_path: Path) -> None:
    entry = json.loads((SAMPLES / CATALOGUE).read_text(encoding="utf-8"))[0]
    (tmp_path / CATALOGUE).write_text(json.dumps([entry]), encoding="utf-8")
    with pytest.raises(FileNotFoundError, match=entry["file"]):
        read_catalogue(tmp_path)


@pytest.mark.slow
def test_drawn_samples_come_last_and_can_be_drawn_again(photographs: list[BundledSample], tmp_path: Path) -> None:
    """A grey level of one at most may come of another version of the numerical libraries."""
    drawn = [photograph for photograph in photographs if photograph.kind == "drawn"]
    assert drawn == photographs[-len(drawn) :]
    subprocess.run([sys.executable, ROOT / "scripts" / "drawn_samples.py", tmp_path], check=True)
    assert {path.name for path in tmp_path.iterdir()} == {photograph.path.name for photograph in drawn}
    for photograph in drawn:
        bundled_pixels, again = (
            np.asarray(Image.open(directory / photograph.path.name), np.int16) for directory in (SAMPLES, tmp_path)
        )
        assert np.abs(bundled_pixels - again).max() <= 1


@pytest.mark.slow
def test_the_clips_can_be_made_again(photographs: list[BundledSample]) -> None:
    """H.264 keeps them at 36 dB or better; a frame out of its place has 32 dB at most."""
    script = runpy.run_path(str(ROOT / "scripts" / "drawn_clips.py"))
    clips = [photograph for photograph in photographs if photograph.kind == "moving"]
    assert [clip.id for clip in clips] == list(script["CLIPS"])
    for clip in clips:
        kept = film(clip.path)
        assert kept.shape == (72, 320, 320, 3)
        assert "computed" in clip.title
        for index, frame in enumerate(islice(script["CLIPS"][clip.id](), 2)):
            error = np.mean((np.clip(frame, 0, 255) - kept[index]) ** 2)
            assert 10 * np.log10(255**2 / error) > 35
