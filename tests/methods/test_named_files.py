"""The file of the numerics that a method is named after is what runs: who changes it changes the service."""

import sys
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from app.methods.registry import METHODS
from app.settings import ROOT
from tests.methods.runs import run_small, sources_for

NUMERICS = ROOT / "app" / "synthesis"
# Named after the article's word for it, or made of two models.
OTHERWISE = {"mix": {"mixing"}, "video-transfer": {"transfer", "video_patchwork"}}


def executed(name: str, scratch: Path) -> set[str]:
    """Names of the numerics' files of which a run executes something in the calling thread."""
    files: set[str] = set()

    def note(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call" and frame.f_code.co_name != "<module>":
            files.add(frame.f_code.co_filename)

    method = METHODS[name]
    sys.setprofile(note)
    try:
        for _ in run_small(method, sources_for(method), scratch=scratch):
            pass
    finally:
        sys.setprofile(None)
    return {Path(file).stem for file in files if NUMERICS in Path(file).parents}


@pytest.mark.parametrize("name", METHODS)
def test_a_run_executes_the_numerics_of_the_methods_name(name: str, tmp_path: Path) -> None:
    expected = OTHERWISE.get(name, {name.replace("-", "_")})
    assert all(list(NUMERICS.rglob(f"{stem}.py")) for stem in expected)
    assert expected <= executed(name, tmp_path)
