"""Error messages on the command line: one line on stderr and an exit code, no traceback."""

from collections.abc import Iterator
from contextlib import contextmanager

import typer

from app.errors import AppError, BusyError, UnavailableError

FAILED, WRONG = 1, 2
EXIT_CODES = "Exit codes: 0 done, 1 it could not be done, 2 the request is wrong, 130 interrupted with Ctrl-C."


@contextmanager
def plain_errors() -> Iterator[None]:
    """Print errors meant for people as one line on stderr and exit; any other one is a bug and stays a traceback."""
    try:
        yield
    except AppError as error:
        typer.echo(f"microtexture: {error.message}", err=True)
        raise typer.Exit(FAILED if isinstance(error, BusyError | UnavailableError) else WRONG) from None
    except OSError as error:
        about = f": {error.filename}" if error.filename else ""
        typer.echo(f"microtexture: {error.strerror or error}{about}", err=True)
        raise typer.Exit(FAILED) from None
