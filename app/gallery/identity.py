"""Identifiers of the exhibits' experiments: hashes of what they compute, so that each is made once and found again."""

import hashlib
import json

from app.methods.explanations.model import Exhibit
from app.methods.registry import method

PREFIX = "figure-"
DIGITS = 16


def identifier(exhibit: Exhibit) -> str:
    """An identifier made of the method, the inputs and the complete parameters.

    Parameters
    ----------
    exhibit : Exhibit
        What it shows and its label do not matter; a parameter that is left out is the same as its default.

    Raises
    ------
    pydantic.ValidationError
        If a parameter does not exist or cannot be so.

    Examples
    --------
    >>> plain = Exhibit("rpn", (("gravel_gray", "0,0,64,64"),))
    >>> identifier(plain) == identifier(Exhibit("rpn", plain.inputs, {"seed": 0}, label="again"))
    True
    """
    params = method(exhibit.method).params.model_validate(dict(exhibit.parameters))
    content = [exhibit.method, [list(source) for source in exhibit.inputs], params.model_dump(mode="json")]
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
    return f"{PREFIX}{digest[:DIGITS]}"
