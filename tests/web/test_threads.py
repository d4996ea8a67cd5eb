"""While every thread for uploads and for new pictures is taken, what is there already is answered."""

import ast
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import anyio

from app import threads
from app.errors import BusyError

ROOT = Path(threads.__file__).parent
PATIENCE = 20.0


class Crowd:
    """Blocking calls that hold every thread of a group until they are let go."""

    def __init__(self, count):
        self.taken, self.free = threading.Barrier(count + 1, timeout=PATIENCE), threading.Event()

    def __call__(self, *_, **__):
        self.taken.wait()
        assert self.free.wait(PATIENCE)
        raise BusyError("Try again: this was a test.")


@contextmanager
def crowded(site, monkeypatch, *groups):
    """Take every thread of these groups by requests."""
    upload = {"files": {"file": ("photo.png", b"")}}
    area = {"params": {"x": 0, "y": 0, "width": 32, "height": 32}}
    ways: dict[str, tuple[Any, str, tuple[str, str], dict[str, Any]]] = {
        threads.UPLOADS: (site.service.samples, "add", ("POST", "/api/v1/samples"), upload),
        threads.PICTURES: (site.service.meter, "structure", ("GET", "/api/v1/samples/gravel_gray/structure"), area),
    }
    crowds = []
    with ThreadPoolExecutor(16) as pool, monkeypatch.context() as patch:
        try:
            for group in groups:
                owner, name, request, arguments = ways[group]
                count = threads.AT_ONCE[group]
                crowds.append(Crowd(count))
                patch.setattr(owner, name, crowds[-1])
                held = [pool.submit(site.client.request, *request, **arguments) for _ in range(count)]
                crowds[-1].taken.wait()
            yield
            assert not any(answer.done() for answer in held)
        finally:
            for crowd in crowds:
                crowd.free.set()


def test_what_is_there_is_answered_while_uploads_and_new_pictures_wait(site, monkeypatch, experiment):
    address = f"/api/v1/experiments/{experiment['id']}"
    paths = [f"{address}/outputs/{name}" for name in (".thumbnail-texture", ".preview", "texture?format=jpeg")]
    paths.append("/api/v1/samples/gravel_gray/image?size=256")
    made = [site.client.get(path).content for path in paths]
    with crowded(site, monkeypatch, threads.UPLOADS, threads.PICTURES):
        assert [site.client.get(path).content for path in paths] == made
        for path in (address, f"{address}/outputs/texture", "/archive"):
            assert site.client.get(path).status_code == 200
        with site.client.stream("GET", f"{address}/events") as events:
            assert next(events.iter_lines())


def test_new_pictures_do_not_wait_for_uploads(site, monkeypatch, experiment):
    outputs = f"/api/v1/experiments/{experiment['id']}/outputs"
    with crowded(site, monkeypatch, threads.UPLOADS):
        for path in ("/api/v1/samples/gravel_gray/image?size=512", f"{outputs}/texture?format=webp"):
            assert site.client.get(path).status_code == 200


def test_groups_are_apart_and_bounded():
    async def count():
        return {group: threads.limiter(group).total_tokens for group in (*threads.AT_ONCE, threads.RECORDS)}

    assert anyio.run(count) == {**threads.AT_ONCE, threads.RECORDS: 40}


def test_nothing_uses_the_event_loops_default_pool():
    """Ruff forbids `asyncio.to_thread`; what is a method of the loop it cannot see."""
    for path in ROOT.rglob("*.py"):
        calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Attribute)]
        assert not [
            path
            for call in calls
            if call.attr in {"run_in_executor", "set_default_executor", "to_thread"}
            and not (isinstance(call.value, ast.Name) and call.value.id == "anyio")
        ], path
