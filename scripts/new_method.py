"""Scaffold of a new method: the files to start from, and its lines in those that list all methods.

``make new-method NAME=my-method FAMILY=sampling``. What it writes is a model that runs and passes the tests, pixels
drawn independently. Replace it piece by piece; CONTRIBUTING.md tells what each piece is for.
"""

import argparse
import builtins
import keyword
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEMPLATES = Path(__file__).resolve().parent / "new_method"
# Each family, and a method beside which a new one of it stands on the page of all methods.
FAMILIES = {"gaussian": "mix", "pyramid": "heeger-bergen", "sampling": "efros-leung", "patchwork": "transfer"}
SUMMARY = "every pixel is one of the crop's, drawn at random"


class RefusalError(Exception):
    """Why no method is made, and what to do."""


def new_files(name: str, family: str) -> dict[Path, str]:
    """The files of a new method by their paths, from the templates.

    Raises
    ------
    RefusalError
        If the name does not do, or if one of the files is there already.
    """
    module = name.replace("-", "_")
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", name):
        raise RefusalError(f"NAME is as in addresses: small letters, digits and hyphens, like my-method. Got {name!r}.")
    if keyword.iskeyword(module) or keyword.issoftkeyword(module) or hasattr(builtins, module):
        raise RefusalError(f"{module!r} is a word of Python's own. Take another name.")
    if family not in FAMILIES:
        raise RefusalError(f"There is no family {family!r}. FAMILY is one of {', '.join(FAMILIES)}.")
    words = {
        "NAME": name,
        "MODULE": module,
        "FAMILY": family,
        "CONSTANT": module.upper(),
        "CLASS": "".join(word.capitalize() for word in name.split("-")),
        "LOWER": name.replace("-", " "),
        "TITLE": name.replace("-", " ").capitalize(),
    }
    targets = {
        "numerics": f"app/synthesis/{family}/{module}.py",
        "declaration": f"app/methods/{family}/{module}.py",
        "explanation": f"app/methods/explanations/{module}.py",
        "test_numerics": f"tests/synthesis/{family}/test_{module}.py",
        "test_declaration": f"tests/methods/{family}/test_{module}.py",
    }
    found = {}
    for template, target in targets.items():
        if (ROOT / target).exists():
            raise RefusalError(f"There is {target} already. Take another name.")
        text = (TEMPLATES / f"{template}.txt").read_text(encoding="utf-8")
        found[ROOT / target] = re.sub("@([A-Z]+)@", lambda match: words[match[1]], text)
    return found


def changed_files(name: str, family: str) -> dict[Path, str]:
    """Those that list all methods, with a line for this one.

    Raises
    ------
    RefusalError
        If the name is taken, or if a list does not look as it did when this was written.
    """
    module = name.replace("-", "_")
    beside = FAMILIES[family]
    declaration = f"from app.methods.{family}.{module} import {module.upper()}\n"
    # The text that a line is put behind, and the line.
    changes: dict[str, list[tuple[str, str]]] = {
        "app/methods/registry.py": [
            (r"from app\.errors import .*\n", declaration),
            (r'METHODS: [^{]+\{\n(?:    "[\w-]+": \w+,\n)+', f'    "{name}": {module.upper()},\n'),
        ],
        "app/gallery/groups.py": [(rf'"{beside}"(?=[^()]*\))', f', "{name}"')],
        "README.md": [(r"\| method \| what it makes \|\n\|---\|---\|\n(?:\| `.*\n)+", f"| `{name}` | {SUMMARY} |\n")],
        "CHANGELOG.md": [(r"### Added\n\n(?:(?:- |  ).*\n)+", f"- The method `{name}`: {SUMMARY}.\n")],
    }
    found = {}
    for path, insertions in changes.items():
        text = (ROOT / path).read_text(encoding="utf-8")
        if path.endswith(".py") and f'"{name}"' in text:
            raise RefusalError(f"There is a method {name!r} already: {path} has it. Take another name.")
        for pattern, line in insertions:
            match = re.search(pattern, text)
            if match is None:
                raise RefusalError(f"{path} is not as expected: mend the pattern {pattern!r} in scripts/new_method.py.")
            text = text[: match.end()] + line + text[match.end() :]
        found[ROOT / path] = text
    return found


def main() -> None:
    """Write the files, or say in one line why not."""
    parser = argparse.ArgumentParser(description="Make the files of a new method.")
    parser.add_argument("name")
    parser.add_argument("--family", default="gaussian")
    arguments = parser.parse_args()
    try:
        files = new_files(arguments.name, arguments.family)
        files |= changed_files(arguments.name, arguments.family)
    except RefusalError as refusal:
        sys.exit(f"new-method: {refusal}")
    for path, text in files.items():
        path.write_text(text, encoding="utf-8")
    code = [path for path in files if path.suffix == ".py"]
    for command in (["check", "--quiet", "--select", "I", "--fix"], ["format", "--quiet"]):
        subprocess.run([sys.executable, "-m", "ruff", *command, *code], cwd=ROOT, check=True)  # noqa: S603 - our own files
    for path in files:
        print(path.relative_to(ROOT))
    print("It runs: make check. Now make it yours, piece by piece: CONTRIBUTING.md, “Add a method”.")


if __name__ == "__main__":
    main()
