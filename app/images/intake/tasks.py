"""Tasks that make pictures of stored ones, by name: what a process that may be killed is asked for."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from app.images.convert import convert, make_link_preview, make_rendition, make_thumbnails

TASKS: dict[str, Callable[..., Sequence[bytes]]] = {
    "convert": lambda *sources, **said: convert(*sources, **said)[:1],
    "rendition": lambda *sources, **said: make_rendition(*sources, **said)[:1],
    "thumbnails": make_thumbnails,
    "preview": lambda *sources: [make_link_preview(*sources)],
}


def perform(task: str, sources: Sequence[Path], destinations: Sequence[Path], arguments: Mapping[str, Any]) -> None:
    """Perform a task, and write what it makes."""
    for path, data in zip(destinations, TASKS[task](*sources, **arguments), strict=True):
        path.write_bytes(data)
