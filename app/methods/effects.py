"""Effects of parameters: the outputs of a run, and typed parameters that would change none of them."""

from collections.abc import Collection, Sequence

from app.errors import InvalidInputError
from app.methods.model import Method, Size
from app.methods.outputs import OutputSpec
from app.methods.params import MovingParams, StillParams

COMMON = frozenset(MovingParams.model_fields)  # whoever runs several methods gives them to each, whether it needs them
EVERYTHING = "have all of them made (--all on the command line, an experiment over the API)"
FEW = 4  # names that a sentence lists in full


def outputs_of(method: Method, params: StillParams, inputs: int) -> tuple[OutputSpec, ...]:
    """List the outputs of a run with these parameters and this number of inputs, in their order.

    Examples
    --------
    >>> from app.methods.registry import METHODS
    >>> dsn = METHODS["dsn"]
    >>> [output.name for output in outputs_of(dsn, dsn.params(), 1)]
    ['texture', 'crop', 'spot', 'points']
    """
    return tuple(output for output in method.outputs if output.applies(params, inputs))


def made_by(method: Method, parameter: str) -> list[str]:
    """Name the outputs that only this parameter makes; none if it changes outputs that every run makes.

    Examples
    --------
    >>> from app.methods.registry import METHODS
    >>> made_by(METHODS["dsn"], "order"), made_by(METHODS["dsn"], "convergence")[0]
    ([], 'dsn-10')
    """
    changed = [output for output in method.outputs if output.changed_by(parameter)]
    return [] if any(not output.condition for output in changed) else [output.name for output in changed]


def output_named(method: Method, name: str, params: StillParams, inputs: int) -> OutputSpec:
    """Find the output of this name among those of a run.

    Raises
    ------
    InvalidInputError
        At ``output``, with the names there are, or with the condition under which this one is made.
    """
    found = possible_output(method, name)
    if found.applies(params, inputs):
        return found
    names = ", ".join(output.name for output in outputs_of(method, params, inputs))
    raise InvalidInputError(
        f"The method {method.name} gives the output {name!r} only where {found.condition}; here it gives: {names}.",
        "output",
    )


def possible_output(method: Method, name: str) -> OutputSpec:
    """Find the output of this name among all that the method can make.

    Raises
    ------
    InvalidInputError
        At ``output``, with all the names there are.
    """
    found = next((output for output in method.outputs if output.name == name), None)
    if found is None:
        names = ", ".join(output.name for output in method.outputs)
        raise InvalidInputError(f"The method {method.name} gives no output {name!r}. It can give: {names}.", "output")
    return found


def refuse_deep(output: OutputSpec, deepest: int) -> None:
    """Refuse 16 bits per channel for an output that always has 8.

    Parameters
    ----------
    output : OutputSpec
    deepest : int
        Bits per channel of the deepest sample.

    Raises
    ------
    InvalidInputError
        At ``depth``.
    """
    if output.video:
        raise InvalidInputError("A video has 8 bits per channel: leave the depth out.", "depth")
    if not output.deep or (output.as_uploaded and deepest == 8):
        whose = "the 8 bits per channel of its sample" if output.deep else "8 bits per channel"
        raise InvalidInputError(f"The output {output.name!r} has {whose}: leave the depth out.", "depth")


def without_effect(
    method: Method, sizes: Sequence[Size], params: StillParams, typed: Collection[str], requested: Collection[str]
) -> dict[str, str]:
    """Find the typed parameters that change none of the requested outputs, each with a sentence that says why.

    A parameter typed with its default value counts as left out, unless it makes outputs that were not requested;
    likewise a value that makes none of them. Width, height, frames and seed are never among these.

    Parameters
    ----------
    method : Method
    sizes : sequence of Size
        Of the inputs.
    params : StillParams
        All of them, with the defaults of those that were left out.
    typed : collection of str
        Names of the parameters that were typed.
    requested : collection of str
        Names of the outputs.
    """
    idle = method.idle(sizes, method.fill(sizes, params))
    present = outputs_of(method, params, len(sizes))
    found: dict[str, str] = {}
    for name, field in method.params.model_fields.items():
        if name not in typed or name in COMMON:
            continue
        subject, default = f"{name} (“{field.title}”)", getattr(params, name) == field.default
        changed = [output for output in method.outputs if output.changed_by(name)]
        names = [output.name for output in changed if output in present]
        makes = bool(made_by(method, name))  # then a value that makes none asks for nothing
        if not default and name in idle:
            found[name] = f"{subject} would change nothing here: {idle[name]}"
        elif (names if makes else not default) and not set(names) & set(requested):
            others = f"name one of those as the output, {EVERYTHING}, or " if names else ""
            found[name] = (
                f"{subject} changes {listed(names) or 'nothing'}, and only {listed(list(requested))} is requested: "
                f"{others}leave it out."
            )
    return found


def listed(names: Sequence[str]) -> str:
    """Names with commas between them, of many the first and the last."""
    return ", ".join(names if len(names) <= FEW else [*names[: FEW - 2], "…", names[-1]])
