"""What a run gives under its parameters, and which of those that were typed would change nothing of it."""

from collections.abc import Collection, Sequence

from app.errors import InvalidInputError
from app.methods.announced import Announced
from app.methods.model import Method, MovingParams, Size, StillParams

COMMON = frozenset(MovingParams.model_fields)  # whoever runs several methods gives them to each, whether it needs them
FEW = 4  # names that a sentence lists in full


def outputs_of(method: Method, params: StillParams, inputs: int) -> tuple[Announced, ...]:
    """The outputs of a run with these parameters, of so many inputs, in their order.

    Examples
    --------
    >>> from app.methods.registry import METHODS
    >>> dsn = METHODS["dsn"]
    >>> [output.name for output in outputs_of(dsn, dsn.params(), 1)]
    ['texture', 'crop', 'spot', 'points']
    """
    return tuple(output for output in method.outputs if output.given(params, inputs))


def output_named(method: Method, name: str, params: StillParams, inputs: int) -> Announced:
    """The output of this name.

    Raises
    ------
    InvalidInputError
        At ``output``, with the names there are, or with what it takes to be given that one.
    """
    given = outputs_of(method, params, inputs)
    found = next((output for output in given if output.name == name), None)
    if found is not None:
        return found
    names = ", ".join(output.name for output in given)
    other = next((output for output in method.outputs if output.name == name), None)
    if other is None:
        raise InvalidInputError(f"The method {method.name} gives no output {name!r}; here it gives: {names}.", "output")
    raise InvalidInputError(
        f"The method {method.name} gives the output {name!r} only where {other.condition}; here it gives: {names}.",
        "output",
    )


def without_effect(
    method: Method, sizes: Sequence[Size], params: StillParams, given: Collection[str], wanted: Collection[str]
) -> dict[str, str]:
    """Those of the given parameters that change nothing of the wanted outputs, each with a sentence that says why.

    A default that is said aloud promises nothing, so it counts as left out, unless it makes outputs that are not
    wanted; likewise a value that makes none of them. Width, height, frames and seed are never among these.

    Parameters
    ----------
    method : Method
    sizes : sequence of Size
        Of the inputs.
    params : StillParams
        Complete.
    given : collection of str
        Names of the parameters that were typed.
    wanted : collection of str
        Names of the outputs that are asked for.
    """
    idle = method.idle(sizes, params)
    present = outputs_of(method, params, len(sizes))
    found: dict[str, str] = {}
    for name, field in method.params.model_fields.items():
        if name not in given or name in COMMON:
            continue
        title, default = field.title or name, getattr(params, name) == field.default
        changed = [output for output in method.outputs if output.changed_by(name)]
        names = [output.name for output in changed if output in present]
        makes = all(output.condition for output in changed)  # then a value that makes none asks for nothing
        if not default and name in idle:
            found[name] = f"“{title}” would change nothing here: {idle[name]}"
        elif (names if makes else not default) and not set(names) & set(wanted):
            others = "ask for what it changes, or for all outputs, or " if names else ""
            found[name] = (
                f"“{title}” changes {_listed(names) or 'nothing'}, and {_listed(list(wanted))} is asked for: "
                f"{others}leave it out."
            )
    return found


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names if len(names) <= FEW else [*names[: FEW - 2], "…", names[-1]])
