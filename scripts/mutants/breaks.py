"""Mutants of a Python or JavaScript file: each is its text with one small fault."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

COMPARISONS: dict[type[ast.cmpop], ast.cmpop] = {
    ast.Lt: ast.LtE(),
    ast.LtE: ast.Lt(),
    ast.Gt: ast.GtE(),
    ast.GtE: ast.Gt(),
    ast.Eq: ast.NotEq(),
    ast.NotEq: ast.Eq(),
    ast.Is: ast.IsNot(),
    ast.IsNot: ast.Is(),
    ast.In: ast.NotIn(),
    ast.NotIn: ast.In(),
}
OPERATORS: dict[type[ast.operator], ast.operator] = {
    ast.Add: ast.Sub(),
    ast.Sub: ast.Add(),
    ast.Mult: ast.Div(),
    ast.Div: ast.Mult(),
    ast.FloorDiv: ast.Mult(),
    ast.Mod: ast.Mult(),
}
OTHER_NAMES = {"min": "max", "max": "min", "any": "all", "all": "any", "floor": "ceil", "ceil": "floor"}
SCRIPT_BREAKS = (
    (r" < ", " <= "),
    (r" > ", " >= "),
    (r" === ", " !== "),
    (r" \+ ", " - "),
    (r" - ", " + "),
    (r" \* ", " / "),
    (r" / ", " * "),
    (r" && ", " || "),
    (r" \|\| ", " && "),
    (r"Math\.min", "Math.max"),
    (r"Math\.max", "Math.min"),
    (r"\b1\b", "2"),
    (r"\b2\b", "3"),
    (r"return [^;{]+;", "return undefined;"),
)


@dataclass(frozen=True)
class Mutant:
    """A file with one fault: ``before`` stood at ``line``, ``after`` stands there now."""

    path: str
    line: int
    before: str
    after: str
    text: str

    def __str__(self) -> str:
        before, after = (" ".join(part.split())[:70] for part in (self.before, self.after))
        return f"{self.path}:{self.line}  {before}  ->  {after}"


def mutants_of(root: Path, path: str) -> list[Mutant]:
    """All mutants of a file of the checkout."""
    text = (root / path).read_text(encoding="utf-8")
    return list(_of_script(path, text) if path.endswith(".js") else _of_module(path, text))


def _of_module(path: str, text: str) -> Iterator[Mutant]:
    starts = [0]
    data = text.encode()
    for line in data.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for node, replacement in _faults(ast.parse(text)):
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[node.end_lineno - 1] + node.end_col_offset
        before = data[start:end].decode()
        changed = (data[:start] + replacement.encode() + data[end:]).decode()
        yield Mutant(path, node.lineno, before, replacement, changed)


def _faults(node: ast.AST) -> Iterator[tuple[ast.expr | ast.stmt, str]]:
    """Nodes below this one, each with what may stand there instead; not in annotations, docstrings and imports."""
    for name, value in ast.iter_fields(node):
        if name in {"annotation", "returns", "decorator_list", "type_comment"}:
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.Import | ast.ImportFrom) or not isinstance(child, ast.AST):
                continue
            if isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
                continue
            if isinstance(child, ast.stmt):
                yield from _of_statement(child)
            elif isinstance(child, ast.expr):
                yield from _of_expression(child)
            if not isinstance(child, ast.JoinedStr):
                yield from _faults(child)


def _of_statement(node: ast.stmt) -> Iterator[tuple[ast.expr | ast.stmt, str]]:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return  # a docstring
    if isinstance(node, ast.Expr | ast.AugAssign | ast.Raise) and not isinstance(
        getattr(node, "value", None), ast.Yield
    ):
        yield node, "pass"
    if isinstance(node, ast.Continue):
        yield node, "break"
    if isinstance(node, ast.Return) and node.value is not None:
        yield node, "return None"
    if isinstance(node, ast.If | ast.While):
        yield node.test, "False"


def _of_expression(node: ast.expr) -> Iterator[tuple[ast.expr | ast.stmt, str]]:
    if isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARISONS:
        ops = [COMPARISONS[type(node.ops[0])], *node.ops[1:]]
        yield node, _text(ast.Compare(node.left, ops, node.comparators))
    elif isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        yield node, _text(ast.BinOp(node.left, OPERATORS[type(node.op)], node.right))
    elif isinstance(node, ast.BoolOp):
        yield node, _text(ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values))
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not | ast.USub):
        yield node, _text(node.operand)
    elif isinstance(node, ast.Constant) and type(node.value) is bool:
        yield node, str(not node.value)
    elif isinstance(node, ast.Constant) and type(node.value) in {int, float}:
        yield node, f"({node.value!r} + 1)"
    elif isinstance(node, ast.Call):
        if isinstance(node.func, ast.Name) and node.func.id in OTHER_NAMES:
            yield node.func, OTHER_NAMES[node.func.id]
        for keyword in node.keywords if node.keywords and node.keywords[0].arg else ():
            yield (
                node,
                _text(ast.Call(node.func, node.args, [other for other in node.keywords if other is not keyword])),
            )
    elif isinstance(node, ast.Slice) and node.upper is not None and node.lower is not None:
        yield node.upper, f"{_text(node.upper)} - 1"


def _text(node: ast.expr) -> str:
    return f"({ast.unparse(node)})"


def _of_script(path: str, text: str) -> Iterator[Mutant]:
    at = 0
    for number, line in enumerate(text.splitlines(keepends=True), 1):
        code = line.strip()
        if not code.startswith(("//", "*", "/*", "import ")):
            for pattern, after in SCRIPT_BREAKS:
                for found in re.finditer(pattern, line):
                    start, end = at + found.start(), at + found.end()
                    changed = line[: found.start()] + after + line[found.end() :]
                    yield Mutant(path, number, code, changed.strip(), text[:start] + after + text[end:])
        at += len(line)
