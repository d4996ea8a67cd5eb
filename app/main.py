"""Application factory: wires settings, backends, service and web application."""

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from functools import partial
from uuid import uuid4

from fastapi import FastAPI
from starlette.middleware import Middleware
from starlette.staticfiles import StaticFiles

from app import threads, worker
from app.errors import InvalidInputError
from app.executor.dask import DaskExecutor
from app.executor.keeper import Ask
from app.experiments.availability import probe
from app.experiments.service import Service
from app.samples import require_files
from app.settings import ROOT, Settings
from app.store.blobs import FileBlobs
from app.store.copy import copy_database
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from app.synthesis import __version__
from app.web import health, problems, uploads
from app.web.access_log import keep_addresses_secret
from app.web.api import docs, events, experiments, methods, outputs, samples, structure, synthesize
from app.web.api.openapi import build_document
from app.web.limits import Limits
from app.web.middleware.body_limit import BodyLimit
from app.web.middleware.cross_origin import CrossOrigin
from app.web.middleware.head_as_get import HeadAsGet
from app.web.middleware.metrics import CountRequests, Metrics
from app.web.middleware.rate_limit_fields import RateLimitFields
from app.web.middleware.security_headers import SecurityHeaders
from app.web.middleware.trusted_hosts import TrustedHosts
from app.web.pages.errors import render_error
from app.web.pages.routes import router as pages
from app.web.request_id import RequestId
from app.web.shutdown import end_if_given_up, give_up, on_stop_signal

log = logging.getLogger(__name__)

SAFE_TOKEN = 16  # characters


def check_scheduler(settings: Settings) -> None:
    """Refuse what workers on other machines cannot share.

    Raises
    ------
    InvalidInputError
        If a scheduler is set together with SQLite or with a relative directory.
    """
    if settings.scheduler is None:
        return
    if settings.sql_url.startswith("sqlite"):
        raise InvalidInputError(
            "Set MICROTEXTURE_DATABASE_URL to a PostgreSQL database: with MICROTEXTURE_SCHEDULER workers run on other "
            "machines, and SQLite is a file of this one."
        )
    if not settings.data_dir.is_absolute():
        raise InvalidInputError(
            "Set MICROTEXTURE_DATA_DIR to an absolute path, which every worker sees: with MICROTEXTURE_SCHEDULER a "
            f"relative one ({settings.data_dir}) is another directory in every process."
        )


def build_service(settings: Settings) -> Service:
    """Make the service with the backends that the settings name; its `start` begins work."""
    check_scheduler(settings)
    settings.data_dir.mkdir(parents=True, exist_ok=True)
    store = SqlStore(settings.sql_url)
    queue, blobs = SqlQueue(store.database), FileBlobs(settings.data_dir / "files", settings.min_free_bytes)

    def prove_worker(ask: Ask) -> None:
        shown = {blobs.put(uuid4().bytes)}
        try:
            shown.add(ask(worker.prove, settings.model_copy(update={"operator_token": None}), __version__, *shown))
            for digest in shown:
                blobs.path(digest)
        finally:
            blobs.remove_unused(shown, lambda candidates: set())

    executor = DaskExecutor(settings, worker.run_job, queue, partial(probe, store, blobs), give_up, prove_worker)
    return Service(store, queue, blobs, executor, settings)


def copy_records(settings: Settings, url: str) -> dict[str, int]:
    """Copy the database of the settings into an empty one: the number of rows of each table."""
    source, target = SqlStore(settings.sql_url), SqlStore(url)
    try:
        return copy_database(source, target)
    finally:
        source.close()
        target.close()


def create_app(settings: Settings | None = None, service: Service | None = None) -> FastAPI:
    """Make the web application, also for ``uvicorn --factory app.main:create_app``.

    Parameters
    ----------
    settings : Settings, optional
        Default: from the environment.
    service : Service, optional
        Default: `build_service`. The application starts and closes it.

    Raises
    ------
    FileNotFoundError
        If the templates, the static files or the bundled samples are missing.
    """
    settings = settings or Settings()
    require_files(settings.samples_dir)
    service = service or build_service(settings)
    keep_addresses_secret()
    if settings.operator_token is not None and len(settings.operator_token.get_secret_value()) < SAFE_TOKEN:
        log.warning("MICROTEXTURE_OPERATOR_TOKEN can be guessed: take at least %d random characters.", SAFE_TOKEN)
    metrics = Metrics(service, settings.data_dir)
    app = FastAPI(
        title="Microtexture",
        summary="Texture synthesis by example",
        version=__version__,
        openapi_url=docs.OPENAPI_URL,
        docs_url=None,
        redoc_url=None,
        swagger_ui_oauth2_redirect_url=None,
        lifespan=_lifespan,
        generate_unique_id_function=lambda route: route.name,
        middleware=[
            Middleware(RequestId),
            Middleware(CountRequests, metrics=metrics),
            Middleware(SecurityHeaders),
            Middleware(BodyLimit, upload=settings.max_upload_bytes),
            Middleware(TrustedHosts, names=settings.hosts),
            Middleware(CrossOrigin, public_address=settings.base_url),
            Middleware(HeadAsGet),
            Middleware(RateLimitFields),
        ],
    )
    app.state.settings, app.state.service, app.state.metrics = settings, service, metrics
    app.state.limits = Limits(settings)
    app.state.stopping = asyncio.Event()
    problems.install(app, render_error)
    api = (methods, samples, structure, experiments, events, outputs, synthesize)
    for part in (*api, health, docs):
        app.include_router(part.router)
    app.include_router(pages)
    app.mount("/static", StaticFiles(directory=ROOT / "static"), name="static")
    app.mount(docs.SWAGGER_URL, StaticFiles(directory=docs.SWAGGER_FILES), name="swagger")
    app.openapi = partial(build_document, app)  # type: ignore[method-assign]
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    """Start the engine beside the web, which answers from the first moment, and stop it with the web."""
    service: Service = app.state.service
    await threads.run(threads.LIFE, uploads.remove_abandoned, app.state.settings.data_dir)
    starting = asyncio.create_task(threads.run(threads.LIFE, service.start))
    starting.add_done_callback(_log_failure)
    loop, stopping = asyncio.get_running_loop(), app.state.stopping
    with on_stop_signal(lambda: loop.call_soon_threadsafe(stopping.set)):
        yield
    stopping.set()
    await threads.run(threads.LIFE, service.close)  # first: a start that waits for the engine then ends
    with suppress(Exception):
        await starting
    end_if_given_up()


def _log_failure(starting: asyncio.Task[None]) -> None:
    if not starting.cancelled() and (error := starting.exception()) is not None:
        log.critical("The engine did not start: no experiment can run. Mend it and start again.", exc_info=error)
