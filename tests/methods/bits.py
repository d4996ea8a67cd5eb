"""Every method on small inputs, with what the environment leaves of the processor: ``-m tests.methods.bits DIRECTORY``.

Libraries look at the environment when they are loaded, hence a process of its own. Each output becomes a file
``<method> <case> <name>``; JSON on stdout says which of numpy's kernels this process had.
"""

import ctypes
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import NoneType
from typing import Any, Literal, get_args, get_origin

import av
import numpy as np
from numpy._core._multiarray_umath import __cpu_features__

from app.errors import InvalidInputError
from app.images.video import writers
from app.images.video.reader import read_video
from app.methods.model import Method
from app.methods.registry import METHODS
from tests.methods.runs import run_small, sources_for

PLAIN_CODECS = "MICROTEXTURE_TEST_PLAIN_CODECS"
# x264's plain C takes other decisions than its code for SSSE3, without which numpy does not start.
SSSE3 = "asm=mmx2,sse,sse2,sse2fast,sse3,ssse3"

# Numbers that lead through other code.
ALSO = {"texton": {"cut": 15}, "patchwork": {"sharpness": 2}, "heeger-bergen": {"scales": 3, "orientations": 3}}


def use_plain_codecs() -> None:
    """Have FFmpeg and its scaler run plain C, and x264 no more than any processor has that numpy runs on."""
    (library,) = (Path(av.__file__).parent.parent / "av.libs").glob("libavutil-*")
    utilities = ctypes.CDLL(str(library))
    utilities.av_force_cpu_flags(0)
    assert utilities.av_get_cpu_flags() == 0
    writers._H264["x264-params"] = SSSE3


def cases(method: Method) -> Iterator[tuple[str, dict[str, Any], dict[str, Any]]]:
    """Shapes of inputs and parameters: as they come, grey, larger, and with every switch and choice turned."""
    moving = any(slot.moving for slot in method.inputs)
    yield "as it comes", {}, {}
    yield "grey", {"channels": 1}, {}
    yield "larger", {}, {"width": 80, "height": 56} | ({"frames": 14} if moving else {})
    if method.name in ALSO:
        yield "otherwise", {}, ALSO[method.name]
    for name, field in method.params.model_fields.items():
        options = [option for option in (field.annotation, *get_args(field.annotation)) if option is not NoneType]
        for option in options:
            values = get_args(option) if get_origin(option) is Literal else (True, False) if option is bool else ()
            for value in values:
                if value != field.default:
                    yield f"{name}={value}", {}, {name: value}


def main(directory: Path) -> None:
    if PLAIN_CODECS in os.environ:
        use_plain_codecs()
    for name, method in METHODS.items():
        depth = 8 if any(slot.moving for slot in method.inputs) else 16
        for case, shape, parameters in cases(method):
            sources = sources_for(method, **shape)
            try:
                made = list(run_small(method, sources, depth=depth, scratch=directory, seed=5, **parameters))
            except InvalidInputError:
                if case in {"as it comes", "grey"}:
                    raise
                continue  # some cannot be larger, and some choices need others
            for picture in made:
                target = directory / f"{name} {case} {picture.name}"
                if isinstance(picture.data, Path):
                    picture.data.rename(target)
                    if picture.media_type.startswith("video"):
                        np.save(directory / f"{target.name}.npy", np.stack(list(read_video(target))))
                else:
                    target.write_bytes(picture.data)
    print(json.dumps([feature for feature, there in __cpu_features__.items() if there]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
