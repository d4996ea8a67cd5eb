"""Tables of a method's parameters and outputs, for `microtexture methods METHOD`."""

from rich.console import Console
from rich.table import Table

from app.methods.fields import fields
from app.methods.model import Method
from app.methods.params import MovingParams


def describe(method: Method, console: Console) -> None:
    """Print a method's parameters, and its outputs with the parameters of its own that change each."""
    console.print(f"{method.title}: {method.summary}\n", highlight=False)
    table = _table("parameter", "default", "what it is")
    for field in fields(method.params):
        default = field.default or ("off" if field.kind == "switch" else "–")
        table.add_row(f"--{field.name.replace('_', '-')}", default, field.label)
    console.print(table)
    console.print()
    table = _table("output", "kind", "type", "given", "changed by")
    own = [name for name in method.params.model_fields if name not in MovingParams.model_fields]
    for output in method.outputs:
        when = f"where {output.condition}" if output.condition else "always"
        changes = ", ".join(name for name in own if output.changed_by(name))
        table.add_row(output.name, output.kind, output.media_type, when, changes or "–")
    console.print(table)


def _table(*columns: str) -> Table:
    return Table(*columns, box=None, pad_edge=False, header_style="bold")
