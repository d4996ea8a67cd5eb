"""A whole service on a loopback port: real store, files and decoding, the engine in a thread, and a gate to hold it."""

import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
import uvicorn
from fastapi import FastAPI
from PIL import Image

from app.errors import CancelledError
from app.experiments.heartbeat import Heartbeat
from app.experiments.model import Lease
from app.experiments.service import Service
from app.gallery.exhibits import exhibits
from app.main import create_app
from app.settings import ROOT, Settings
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from app.worker import run_job
from tests.executor.inline import InlineExecutor

OPERATOR = "operator-token-of-the-tests"
PATIENCE = 20.0


def picture(width: int = 48, height: int = 40, *, seed: int = 1, form: str = "PNG", mode: str = "RGB") -> bytes:
    """A noise photograph as a file."""
    channels = {"L": (), "RGB": (3,), "RGBA": (4,)}[mode]
    pixels = np.random.default_rng(seed).integers(60, 200, (height, width, *channels), np.uint8)
    file = BytesIO()
    Image.fromarray(pixels, mode).save(file, form)
    return file.getvalue()


def film(count: int = 6, width: int = 48, height: int = 40, *, seed: int = 1, alpha: bool = False) -> np.ndarray:
    """The frames (T, H, W, C) of a clip of noise."""
    return np.random.default_rng(seed).integers(60, 200, (count, height, width, 4 if alpha else 3), np.uint8)


def animation(frames: np.ndarray, *, rate: float = 10) -> bytes:
    """A clip as a file, APNG, which keeps every value."""
    first, *others = (Image.fromarray(frame) for frame in frames)
    file = BytesIO()
    first.save(file, "PNG", save_all=True, append_images=others, duration=1000 / rate)
    return file.getvalue()


@pytest.fixture(scope="session", name="film")
def film_factory() -> Callable[..., np.ndarray]:
    return film


@pytest.fixture(scope="session", name="animation")
def animation_factory() -> Callable[..., bytes]:
    return animation


@pytest.fixture(scope="session", name="picture")
def picture_factory() -> Callable[..., bytes]:
    return picture


class Gate:
    """The worker's function; `closed` makes every job wait at its start, where it can be cancelled."""

    held = 0.01  # the progress of a job that waits here

    def __init__(self) -> None:
        self._open = threading.Event()
        self._open.set()

    def __call__(self, settings: Settings, lease: Lease) -> None:
        store = SqlStore(settings.sql_url)
        try:
            with Heartbeat(SqlQueue(store.database), lease, settings.time_limit) as progress:
                while not self._open.wait(0.01):
                    progress("held", self.held)
        except CancelledError:
            return
        finally:
            store.close()
        run_job(settings, lease)

    @contextmanager
    def closed(self) -> Iterator[None]:
        self._open.clear()
        try:
            yield
        finally:
            self._open.set()

    def open(self) -> None:
        self._open.set()


@dataclass
class Site:
    """A served application."""

    app: FastAPI
    service: Service
    settings: Settings
    gate: Gate
    url: str
    client: httpx.Client = field(repr=False)

    def visitor(self, **options: Any) -> httpx.Client:
        """A client with cookies of its own."""
        return httpx.Client(base_url=self.url, timeout=PATIENCE, verify=False, **options)

    @property
    def incoming(self) -> list[Path]:
        """Files of uploads that are on the disk."""
        return list((self.settings.data_dir / "incoming").glob("*"))

    def upload(self, data: bytes | None = None, name: str = "photo.png") -> dict[str, Any]:
        response = self.client.post("/api/v1/samples", files={"file": (name, data or picture())})
        assert response.status_code == 201, response.text
        return dict(response.json())

    def run(self, *, wait: bool = True, client: httpx.Client | None = None, **body: Any) -> httpx.Response:
        """Submit an experiment of the bundled sample."""
        crop = {"x": 0, "y": 0, "width": 32, "height": 24}
        body = {"method": "rpn", "inputs": [{"sample": "gravel_gray", "crop": crop}], **body}
        headers = {"Prefer": f"wait={PATIENCE:.0f}"} if wait else {}
        return (client or self.client).post("/api/v1/experiments", json=body, headers=headers)

    def finished(self, **body: Any) -> dict[str, Any]:
        response = self.run(**body)
        assert response.status_code == 201, response.text
        record = dict(response.json())
        assert record["status"] == "succeeded", record
        return record


@contextmanager
def serve(directory: Path, **changed: Any) -> Iterator[Site]:
    """Serve an application on a free port until the block ends."""
    samples = directory / "samples"
    samples.mkdir(parents=True)
    (samples / "gravel_gray.png").write_bytes(picture(64, 64, seed=7))
    entry = {"file": "gravel_gray.png", "title": "Gravel", "kind": "micro-texture", "crop": "8,8,32,32"}
    origin = {"credit": "the tests", "licence": "CC0-1.0", "licence_url": "https://example.org/"}
    (samples / "catalogue.json").write_text(json.dumps([{**entry, **origin}]))
    settings = Settings(
        data_dir=directory / "data",
        samples_dir=samples,
        **{
            "threads": 1,
            "time_limit": 30,
            "max_upload_bytes": 1 << 18,
            "max_upload_pixels": 1_000_000,
            "max_output_pixels": 1 << 20,
            "operator_token": OPERATOR,
            **changed,
        },
    )
    gate = Gate()
    settings.data_dir.mkdir()
    store, blobs = SqlStore(settings.sql_url), FileBlobs(settings.data_dir / "files")
    queue = SqlQueue(store.database)
    service = Service(store, queue, blobs, InlineExecutor(settings, gate, queue), settings)
    app = create_app(settings, service)
    with serving(app) as url, httpx.Client(base_url=url, timeout=PATIENCE, verify=False) as client:
        until(lambda: client.get("/readyz").status_code == 200 and client.get("/api/v1/samples").json()["samples"])
        yield Site(app, service, settings, gate, url, client)


@contextmanager
def serving(app: FastAPI) -> Iterator[str]:
    """The address of an application served by uvicorn in a thread."""
    # Named, the protocol makes asyncio send answers at once: else each one waits 40 ms for an acknowledgement.
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.bind(("127.0.0.1", 0))
    config = uvicorn.Config(app, log_level="warning", timeout_graceful_shutdown=2)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    try:
        until(lambda: server.started or not thread.is_alive())
        assert thread.is_alive(), "the server did not start"
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join(PATIENCE)
        listener.close()


def until(condition: Callable[[], object]) -> None:
    """Return once the condition holds."""
    moments = threading.Event()
    for _ in range(int(PATIENCE / 0.02)):
        if condition():
            return
        moments.wait(0.02)
    raise AssertionError("the condition never held")


@pytest.fixture(scope="session", name="until")
def until_fixture() -> Callable[[Callable[[], object]], None]:
    return until


@pytest.fixture(scope="session", name="serve")
def serve_fixture() -> Callable[..., Any]:
    return serve


@pytest.fixture(scope="session", name="serving")
def serving_fixture() -> Callable[[FastAPI], Any]:
    return serving


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    with serve(tmp_path_factory.mktemp("site")) as made:
        yield made


@pytest.fixture(scope="session")
def clip(site: Site) -> str:
    """The id of an uploaded clip: `film()`, 48 × 40 pixels, 6 frames, 10 a second."""
    return str(site.upload(animation(film()), "clip.png")["id"])


@pytest.fixture(scope="session")
def experiment(site: Site) -> dict[str, Any]:
    """The record of a listed experiment that succeeded."""
    return site.finished(parameters={"width": 40, "height": 36, "seed": 7})


@pytest.fixture(scope="session")
def operator() -> dict[str, str]:
    """Headers of the operator."""
    return {"Authorization": f"Bearer {OPERATOR}"}


IN_GALLERY = frozenset({"two_sinusoids", "lit_plaster", "gravel_gray"})
MADE_IN_GALLERY = IN_GALLERY - {"gravel_gray"}  # few, and quickly made


@pytest.fixture(scope="session")
def of_gallery() -> frozenset[str]:
    """The samples that `gallery` has."""
    return IN_GALLERY


@pytest.fixture(scope="session")
def gallery(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """A service in which some exhibits are made, some are not, and of some not even the sample is there."""
    directory, samples = tmp_path_factory.mktemp("gallery"), ROOT / "samples"
    entries = json.loads((samples / "catalogue.json").read_text(encoding="utf-8"))
    chosen = [entry for entry in entries if Path(entry["file"]).stem in IN_GALLERY]
    (directory / "catalogue.json").write_text(json.dumps(chosen), encoding="utf-8")
    for entry in chosen:
        (directory / entry["file"]).symlink_to(samples / entry["file"])
    settings = Settings(data_dir=directory / "data", samples_dir=directory, threads=1)
    settings.data_dir.mkdir()
    store, blobs = SqlStore(settings.sql_url), FileBlobs(settings.data_dir / "files")
    queue = SqlQueue(store.database)
    service = Service(store, queue, blobs, InlineExecutor(settings, run_job, queue), settings)
    made = {name: exhibit for name, exhibit in exhibits().items() if MADE_IN_GALLERY.issuperset(dict(exhibit.inputs))}
    with serving(create_app(settings, service)) as url:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("app.experiments.exhibition.exhibits", lambda: made)
            assert service.exhibition.fill(threading.Event()).made == len(made) > 3
        with httpx.Client(base_url=url, timeout=PATIENCE, headers={"Accept": "text/html"}) as client:
            yield client


@pytest.fixture(scope="session")
def page(gallery: httpx.Client) -> Callable[[str], str]:
    """The HTML at a path of the gallery."""

    def got(path: str) -> str:
        answer = gallery.get(path)
        assert answer.status_code == 200, answer.text
        return answer.text

    return got
