"""Numbers as people write them are read alike by the service and by the pages' scripts."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.numbers import plain

NODE = Path(sys.executable).parent / "node"
SCRIPT = Path(__file__).parents[1] / "static" / "js" / "lib" / "numbers.js"
TEXTS = [
    "", " ", "0", "00", "-0", "7", "+7", "-7", "−7", "007", "7.0", "7,00", "7.000", "7,000", "7,0000", "7.", "7,",
    ".5", ",5", "-,5", "0,2", "12,5", "12.5", "1.234,5", "1,234.5", "1,2,3", "1..2", "1 000", "1_000", "1e3", "1E-3",
    "1,5e2", "e3", ".", ",", "+", "abc", "0x10", "NaN", "Infinity", "１２", "１，５", "٣", "9" * 40,
    "½", "1'000", "\t12\n",
]  # fmt: skip


def python(text: str, whole: bool) -> str | None:
    try:
        return plain(text, whole=whole)
    except ValueError:
        return None


def test_script_and_service_read_every_number_alike() -> None:
    asked = f"import {{ plain }} from {json.dumps(SCRIPT.as_uri())};" + (
        "let all = ''; for await (const part of process.stdin) all += part;"
        "console.log(JSON.stringify(JSON.parse(all).map((text) => [plain(text, true), plain(text, false)])));"
    )
    command = [str(NODE), "--input-type=module", "--eval", asked]
    done = subprocess.run(command, input=json.dumps(TEXTS), capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == [[python(text, True), python(text, False)] for text in TEXTS]


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_what_programs_write_is_read_as_it_is(number: float) -> None:
    assert float(plain(repr(number), whole=False)) == number
    assert float(plain(repr(number).replace(".", ","), whole=False)) == number


@given(st.integers())
def test_whole_numbers_keep_every_digit(number: int) -> None:
    assert int(plain(str(number), whole=True)) == number


@pytest.mark.parametrize("text", ["1.234,5", "1,2,3", "1,234.5"])
@pytest.mark.parametrize("whole", [True, False])
def test_what_could_mean_two_numbers_is_none(text: str, whole: bool) -> None:
    with pytest.raises(ValueError, match="number"):
        plain(text, whole=whole)
