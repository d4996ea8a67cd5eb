"""A worker on another machine proves that it sees what the service sees before it is given a job."""

from pathlib import Path

import pytest

from app.errors import DATABASE, InvalidInputError, UnavailableError
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.synthesis import __version__
from app.worker import prove


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(data_dir=tmp_path / "data")


@pytest.fixture
def files(settings: Settings) -> FileBlobs:
    return FileBlobs(settings.data_dir / "files")


def test_it_reads_what_the_service_wrote_and_the_service_finds_what_it_wrote(
    settings: Settings, files: FileBlobs
) -> None:
    written = files.put(b"a probe")
    assert files.path(prove(settings, __version__, written)).read_bytes() == b"a probe was read"


def test_another_version_is_told_which_one_to_install(settings: Settings, files: FileBlobs) -> None:
    with pytest.raises(InvalidInputError, match=rf"It runs Microtexture {__version__}, the service 99.0: install"):
        prove(settings, "99.0", files.put(b"a probe"))


def test_other_files_are_named_by_their_directory(settings: Settings, tmp_path: Path) -> None:
    written = FileBlobs(tmp_path / "elsewhere").put(b"a probe")
    with pytest.raises(InvalidInputError, match=r"does not see the service's files in .*data/files: mount"):
        prove(settings, __version__, written)


def test_a_database_that_is_not_reached_is_said(tmp_path: Path, files: FileBlobs) -> None:
    settings = Settings(data_dir=tmp_path / "data", database_url="postgresql+psycopg://nobody@127.0.0.1:1/none")
    with pytest.raises(UnavailableError, match="database") as raised:
        prove(settings, __version__, files.put(b"a probe"))
    assert raised.value.part == DATABASE
