"""Options of `microtexture synthesize`, made from the methods' declarations."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from app.cli.problems import plain_errors
from app.cli.progress import Bar
from app.cli.run import Request, run
from app.cli.settings import read_settings
from app.methods.effects import listed, made_by
from app.methods.fields import FormField, fields
from app.methods.registry import METHODS

_OWN = {
    "files": (
        list[Path],
        typer.Argument(
            help="The photograph or clip, or as many as the method takes, and then the file to write (not with --all).",
            metavar="PHOTO OUT",
        ),
        inspect.Parameter.empty,
    ),
    "method": (
        str,
        typer.Option(help=f"One of {', '.join(METHODS)}; see `microtexture methods`.", metavar="NAME"),
        "rpn",
    ),
    "crop": (
        list[str],
        typer.Option(
            help="Part of the photograph to work from; all of it by default. Once per photograph, in their order.",
            metavar="X,Y,W,H",
        ),
        [],
    ),
    "time": (
        list[str],
        typer.Option(
            help="Frames of a clip to work from, from 0; all of it by default. Once per file, in their order.",
            metavar="FIRST,COUNT",
        ),
        [],
    ),
    "size": (
        str | None,
        typer.Option(help="Size of the texture in pixels, or as a multiple of the crop: x2.", metavar="WxH|xN"),
        None,
    ),
    "output": (
        str,
        typer.Option(
            help="Which output to write; `microtexture methods METHOD` lists them. A parameter that changes nothing of "
            "it is refused.",
            metavar="NAME",
        ),
        "texture",
    ),
    "directory": (
        Path | None,
        typer.Option(
            "--all",
            help="Write every output into this directory, which is made if it is not there, each under its name, and "
            "record.json, which says how they were made.",
            metavar="DIR",
        ),
        None,
    ),
    "depth": (
        int | None,
        typer.Option(
            help="Bits per channel, 8 or 16 (PNG and TIFF); by default as the deepest of the photographs.",
            metavar="BITS",
        ),
        None,
    ),
    "overwrite": (bool, typer.Option("--overwrite", help="Replace files that are there."), False),
}


class Sections(TyperCommand):
    """Lists the options of every method, and then those that only some have, under the methods that have them."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        sections: dict[str, list[tuple[str, str]]] = {}
        for parameter in self.get_params(ctx):
            if record := parameter.get_help_record(ctx):
                usual = "Arguments" if parameter.param_type_name == "argument" else "Options"
                heading = getattr(parameter, "rich_help_panel", None) or usual
                sections.setdefault(heading, []).append(record)
        for heading, records in sections.items():
            with formatter.section(heading):
                formatter.write_dl(records)


def command() -> Callable[..., None]:
    """Make the command: a function whose signature holds an option for every parameter of every method."""

    def synthesize(files: list[Path], **options: Any) -> None:
        with plain_errors():
            own = {name: options.pop(name) for name in _OWN if name != "files"}
            parameters = {name: value for name, value in options.items() if value is not None}
            everything = own["directory"] is not None
            photos, out = (files, None) if everything else (files[:-1], files[-1])
            request = Request(photos=tuple(photos), out=out, parameters=parameters, **own)
            with Bar() as progress:
                done = run(request, read_settings(), progress)
        typer.echo(done)

    synthesize.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [_parameter(name, *declared) for name, declared in _OWN.items()]
        + [_option(name, variants) for name, variants in _found().items()]
    )
    return synthesize


def _found() -> dict[str, dict[FormField, list[str]]]:
    """Every parameter of the registry by name: how it is declared, and the methods that declare it so."""
    found: dict[str, dict[FormField, list[str]]] = {}
    for method in METHODS.values():
        for field in fields(method.params):
            found.setdefault(field.name, {}).setdefault(field, []).append(method.name)
    return found


def _option(parameter: str, variants: dict[FormField, list[str]]) -> inspect.Parameter:
    name = parameter.replace("_", "-")
    owners = [owner for names in variants.values() for owner in names]
    heading = None if len(owners) == len(METHODS) else f"Options of {', '.join(owners)}"
    help_text = " ".join(
        _help(field) if len(variants) == 1 else f"For {', '.join(names)}: {_help(field)}"
        for field, names in variants.items()
    )
    if made := [each for owner in owners for each in made_by(METHODS[owner], parameter)]:
        help_text += f" Give --output (one of {listed(made)}) or --all with it."
    field = next(iter(variants))
    if field.kind == "switch":
        declared = typer.Option(f"--{name}/--no-{name}", help=help_text, rich_help_panel=heading)
        return _parameter(parameter, bool | None, declared, None)
    metavar = "|".join(field.choices) or {"integer": "N", "number": "X"}.get(field.kind, "TEXT")
    # Text here: the Params class validates it, with the same words as the API's.
    declared = typer.Option(f"--{name}", help=help_text, metavar=metavar, rich_help_panel=heading)
    return _parameter(parameter, str | None, declared, None)


def _help(field: FormField) -> str:
    default = field.default or ("off" if field.kind == "switch" else "")
    return f"{field.help} [default: {default}]" if default else field.help


def _parameter(name: str, annotation: Any, declared: Any, default: Any) -> inspect.Parameter:
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, annotation=Annotated[annotation, declared], default=default
    )
