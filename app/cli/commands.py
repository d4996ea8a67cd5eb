"""Commands and their options. What takes long to import is imported by the command that needs it."""

import errno
import os
from datetime import timedelta
from typing import Annotated

import typer

from app.cli.problems import EXIT_CODES, FAILED, plain_errors
from app.errors import InvalidInputError
from app.synthesis import __version__


def _print_version(on: bool) -> None:
    if on:
        typer.echo(f"microtexture {__version__}")
        raise typer.Exit


def serve(
    host: Annotated[
        str, typer.Option(help="Address to listen on; 0.0.0.0 for all.", envvar="MICROTEXTURE_HOST")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port to listen on.", min=0, max=65535, envvar=["MICROTEXTURE_PORT", "PORT"])
    ] = 8000,
    forwarded_allow_ips: Annotated[
        str,
        typer.Option(
            help="Addresses of reverse proxies whose X-Forwarded-* headers are believed, with commas; none by default.",
            envvar="MICROTEXTURE_FORWARDED_ALLOW_IPS",
        ),
    ] = "",
    limit_concurrency: Annotated[
        int,
        typer.Option(
            help="Connections served at a time; one more is answered 503.",
            min=1,
            envvar="MICROTEXTURE_LIMIT_CONCURRENCY",
        ),
    ] = 500,
) -> None:
    """Serve the web pages and the REST API."""
    import uvicorn

    from app.cli.settings import read_settings
    from app.main import check_scheduler, create_app
    from app.samples import require_files
    from app.web.logs import configuration

    with plain_errors():
        settings = read_settings(for_children=True)
        check_scheduler(settings)
        require_files(settings.samples_dir)
        settings.data_dir.mkdir(parents=True, exist_ok=True)
        if not os.access(settings.data_dir, os.W_OK):
            raise PermissionError(errno.EACCES, "The data directory cannot be written", str(settings.data_dir))
        app = create_app(settings)

    uvicorn.run(
        app,
        host=host,
        port=port,
        log_config=configuration(settings.log_format, settings.log_level),
        proxy_headers=bool(forwarded_allow_ips),
        forwarded_allow_ips=forwarded_allow_ips or None,
        limit_concurrency=limit_concurrency,
        timeout_keep_alive=10,
        timeout_graceful_shutdown=10,
        server_header=False,
    )


def worker() -> None:
    """Compute for a service: join the scheduler of MICROTEXTURE_SCHEDULER, and come back whenever it does."""
    import asyncio
    import signal

    from app.cli.settings import read_settings
    from app.worker import work_for

    with plain_errors():
        settings = read_settings(for_children=True)
        if settings.scheduler is None:
            raise InvalidInputError("Set MICROTEXTURE_SCHEDULER to the address of the service's scheduler, tcp://….")

    async def work() -> None:
        stopping = asyncio.Event()
        for number in (signal.SIGTERM, signal.SIGINT):
            asyncio.get_running_loop().add_signal_handler(number, stopping.set)
        await work_for(settings, stopping)

    asyncio.run(work())


def methods(
    name: Annotated[
        str | None,
        typer.Argument(help="Show the parameters and outputs of this method.", metavar="METHOD"),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="The whole declaration, as GET /api/v1/methods gives it.")
    ] = False,
) -> None:
    """List the methods, or the parameters and outputs of one."""
    from app.methods.registry import METHODS
    from app.methods.registry import method as method_named

    with plain_errors():
        chosen = list(METHODS.values()) if name is None else [method_named(name)]
    if as_json:
        from app.web.api.records import MethodList, MethodRecord

        document = MethodList(methods=[MethodRecord.of(method) for method in chosen])
        typer.echo(document.model_dump_json(indent=2))
        return

    from rich.console import Console
    from rich.table import Table

    if name is not None:
        from app.cli.describe import describe

        describe(chosen[0], Console())
        return
    table = Table("method", "title", "what it computes", box=None, pad_edge=False, header_style="bold")
    for method in chosen:
        table.add_row(method.name, method.title, method.summary)
    Console().print(table)


def prune(
    older_than: Annotated[
        str | None,
        typer.Option(help="Also remove experiments that finished longer ago than this: 30d, 12h, 90m.", metavar="AGE"),
    ] = None,
) -> None:
    """Remove what nothing refers to any more, and old experiments where asked. The service may run meanwhile."""
    with plain_errors():
        age = None if older_than is None else duration(older_than)

        from app.cli.settings import read_settings
        from app.main import build_service

        service = build_service(read_settings())
        try:
            pruned = service.housekeeping.prune(age)
        finally:
            service.close()
    typer.echo(f"Removed {pruned.experiments} experiments, {pruned.samples} samples and {pruned.files} files.")


def catalogue(
    again: Annotated[
        bool, typer.Option("--again", help="Make all anew, also what is there and what the operator deleted.")
    ] = False,
) -> None:
    """Make the figures of the pages that are missing. The service may run meanwhile; it makes them by itself, too."""
    from threading import Event

    from app.cli.settings import read_settings
    from app.main import build_service
    from app.methods.explanations.model import Exhibit

    def report(number: int, of: int, exhibit: Exhibit, error: str | None) -> None:
        samples = " and ".join(sample for sample, _ in exhibit.inputs)
        typer.echo(f"{number}/{of} {exhibit.method} of {samples}{f': {error}' if error else ''}", err=True)

    with plain_errors():
        # It is made here, not in the background.
        settings = read_settings(for_children=True).model_copy(update={"catalogue": False})
        service = build_service(settings)
        try:
            service.start()
            filled = service.exhibition.fill(Event(), again=again, at_once=settings.workers, on_done=report)
        finally:
            service.close()
    typer.echo(f"Made {filled.made} figures, {filled.failed} failed, {filled.kept} were there already.")
    if filled.without_sample:
        typer.echo(f"{filled.without_sample} need samples that are not in MICROTEXTURE_SAMPLES_DIR.", err=True)
    if filled.failed:
        raise typer.Exit(FAILED)


def copy_database(
    url: Annotated[str, typer.Argument(help="Address of an empty database: postgresql+psycopg://… or sqlite:///…")],
) -> None:
    """Copy the database of the settings into an empty one. Stop the service before; files stay where they are."""
    with plain_errors():
        from app.cli.settings import read_settings
        from app.main import copy_records

        copied = copy_records(read_settings(), url)
    typer.echo(f"Copied {', '.join(f'{count} {table}' for table, count in copied.items())}.")


def duration(text: str) -> timedelta:
    """Read an age.

    Raises
    ------
    InvalidInputError
        If it is not a number followed by d, h or m.

    Examples
    --------
    >>> duration("30d"), duration("90m")
    (datetime.timedelta(days=30), datetime.timedelta(seconds=5400))
    """
    units = {"d": "days", "h": "hours", "m": "minutes"}
    number, unit = text[:-1], text[-1:]
    if unit not in units or not (number.isascii() and number.isdigit()) or len(number) > 5:
        raise InvalidInputError(f"An age is a number and d, h or m, for example 30d; got {text!r}.", "older_than")
    return timedelta(**{units[unit]: int(number)})


def application(*, with_method_options: bool) -> typer.Typer:
    """Put the command line together.

    Parameters
    ----------
    with_method_options : bool
        Whether `synthesize` knows the options of every method, for which all of them are imported (about a second).
    """
    app = typer.Typer(no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False, epilog=EXIT_CODES)
    app.callback()(about)
    app.command(epilog=EXIT_CODES)(serve)
    if with_method_options:
        from app.cli.synthesize import Sections, command

        synthesize, listed = command(), Sections
    else:
        synthesize, listed = _nothing, None
    app.command(
        "synthesize", cls=listed, help="Make a texture from photographs, without a service.", epilog=EXIT_CODES
    )(synthesize)
    app.command(epilog=EXIT_CODES)(methods)
    app.command(epilog=EXIT_CODES)(catalogue)
    app.command(epilog=EXIT_CODES)(prune)
    app.command(epilog=EXIT_CODES)(copy_database)
    app.command(epilog=EXIT_CODES)(worker)
    return app


def _nothing() -> None:
    """Hold the place of `synthesize` in the list of commands."""


def about(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """From a photograph to as much of its texture as you ask for."""
