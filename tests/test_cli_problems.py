"""Errors of commands: one line on stderr, and an exit code that says whose fault it is."""

import pytest
import typer

from app.cli.problems import plain_errors
from app.errors import DATABASE, AppError, BusyError, InvalidInputError, UnavailableError


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (UnavailableError(DATABASE, "Try again: the database is away."), 1),
        (BusyError("Try again."), 1),
        (InvalidInputError("Choose another."), 2),
    ],
)
def test_an_error_for_people_is_one_line(error: AppError, code: int, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(typer.Exit) as ended, plain_errors():
        raise error
    assert ended.value.exit_code == code
    assert capsys.readouterr().err == f"microtexture: {error.message}\n"
