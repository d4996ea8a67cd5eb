"""Staging of pictures: files of a run beside the store until the experiment records them, or drops them."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from app.experiments.model import Output
from app.experiments.ports import BlobStore
from app.methods.model import Picture

Staged = list[tuple[Picture, Path]]


def pick(pictures: Iterable[Picture], name: str) -> Iterator[Picture]:
    """Run a method until it yields the picture of this name, and no further; what came before is dropped."""
    for picture in pictures:
        if picture.name == name:
            yield picture
            return
        drop(picture)


def drop(picture: Picture) -> None:
    """Remove the file of a picture, if it is in one."""
    if isinstance(picture.data, Path):
        picture.data.unlink(missing_ok=True)


@contextmanager
def stage(blobs: BlobStore, pictures: Iterable[Picture]) -> Iterator[Staged]:
    """Write pictures to files beside the store: what is large does not stay in memory until all are made."""
    staged: Staged = []
    try:
        for picture in pictures:
            data = picture.data
            staged.append((replace(picture, data=b""), data if isinstance(data, Path) else blobs.temporary(data)))
        yield staged
    finally:
        for _, path in staged:
            path.unlink(missing_ok=True)


def keep(blobs: BlobStore, picture: Picture, path: Path) -> Output:
    """Move a staged picture into the store; the output that it becomes."""
    size = path.stat().st_size
    digest = blobs.put_file(path)
    return Output(**picture.properties(), bytes=size, digest=digest)
