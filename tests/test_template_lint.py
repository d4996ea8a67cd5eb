"""The lint of the templates finds what is planted, and nothing in what is right."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PLANTED = {
    "{% if broken %}<p></p>": "S0",
    "<p>{{name}}</p>": "S1",
    "<p>{{ name|upper }}</p>": "S2",
    "{%if open %}<p></p>{% endif %}": "S4",
    "\t<p>{{ name }}</p>": "S5",
    "<p>{{ Name }}</p>": "V1",
    f"<p>{'word ' * 25}</p>": "L1",
}
RIGHT = """{% if open %}
<p class="{{ kind | lower }}"{% if hidden %} hidden{% endif %}>{{ name }}
  {%- if title %} and {{ title }}{% endif %}</p>
{% endif %}
"""


def rules_broken(directory: Path) -> list[str]:
    command = re.search(r"^\t\$\(BIN\)/python -m j2lint templates (.+)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert command
    output = subprocess.run(
        [sys.executable, "-m", "j2lint", directory, "--json", *command[1].split()],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    found = [error["id"] for error in json.loads(output.stdout)["ERRORS"]]
    assert output.returncode == (2 if found else 0)
    return found


@pytest.mark.parametrize(("text", "rule"), PLANTED.items())
def test_a_planted_fault_is_found(tmp_path: Path, text: str, rule: str) -> None:
    (tmp_path / "planted.html").write_text(f"{text}\n")
    assert rule in rules_broken(tmp_path)


def test_what_is_right_passes(tmp_path: Path) -> None:
    (tmp_path / "right.html").write_text(RIGHT)
    assert rules_broken(tmp_path) == []
