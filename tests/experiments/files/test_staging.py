"""Pictures wait in files until they are recorded; what is not wanted leaves nothing, whatever happens."""

import hashlib
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.experiments.files.staging import drop, keep, pick, stage
from app.methods.model import Picture
from app.store.blobs import FileBlobs


@pytest.fixture
def files(tmp_path: Path) -> list[Path]:
    return [tmp_path / name for name in ("first", "second", "third")]


def pictures(files: list[Path]) -> Iterator[Picture]:
    """Pictures that a method writes to files, when they are asked for."""
    for path in files:
        path.write_bytes(path.name.encode())
        yield Picture(path.name, path.name, 1, 1, path)


def test_pictures_before_the_wanted_one_are_removed_and_later_ones_not_made(files: list[Path]) -> None:
    assert [picture.name for picture in pick(pictures(files), "second")] == ["second"]
    assert [path.exists() for path in files] == [False, True, False]


def test_a_picture_in_memory_and_one_whose_file_is_gone_can_be_dropped(tmp_path: Path) -> None:
    drop(Picture("texture", "Texture", 1, 1, b"data"))
    drop(Picture("texture", "Texture", 1, 1, tmp_path / "gone"))


@pytest.mark.parametrize("fails", [False, True])
def test_staged_files_are_gone_afterwards_even_if_what_uses_them_fails(
    blobs: FileBlobs, files: list[Path], fails: bool
) -> None:
    made = [*pictures(files), Picture("texture", "Texture", 1, 1, b"data", kind="texture")]
    try:
        with stage(blobs, made) as staged:
            assert [picture.name for picture, _ in staged] == ["first", "second", "third", "texture"]
            assert [path.read_bytes() for _, path in staged] == [b"first", b"second", b"third", b"data"]
            assert all(picture.data == b"" for picture, _ in staged)  # none is held in memory
            if fails:
                raise ZeroDivisionError
    except ZeroDivisionError:
        assert fails
    assert not any(path.exists() for _, path in staged)


def test_a_method_that_fails_after_some_pictures_leaves_no_file(blobs: FileBlobs, files: list[Path]) -> None:
    def failing() -> Iterator[Picture]:
        yield from pictures(files)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError), stage(blobs, failing()):
        pytest.fail("it never comes to this")
    assert not any(path.exists() for path in files)


def test_what_is_kept_becomes_an_output_with_its_size_and_digest(blobs: FileBlobs) -> None:
    picture = Picture("texture", "Texture", 3, 2, b"data", kind="texture", frames=4, rate=2.0)
    with stage(blobs, [picture]) as [(info, path)]:
        output = keep(blobs, info, path)
    assert (output.bytes, output.digest) == (4, hashlib.sha256(b"data").hexdigest())
    assert output.properties() == picture.properties()
    assert blobs.path(output.digest).read_bytes() == b"data"
