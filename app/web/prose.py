"""Prose and formulas as HTML: emphasis, and LaTeX converted to MathML."""

import re
from functools import cache
from html import escape
from typing import Literal
from xml.etree import ElementTree

from latex2mathml.converter import convert
from markupsafe import Markup

_FORMULA = re.compile(r"\$([^$]+)\$")
_EMPHASIS = re.compile(r"\*([^*]+)\*")

_BARS = {"|", "‖", "/"}
_ACCENTS = {"^": "ˆ", "~": "˜", "¯": "¯", "ˆ": "ˆ", "˜": "˜", "˙": "˙", "¨": "¨"}
_OVERLINE = "―"
_LIMITS = {"max", "min", "lim", "sup", "inf"}
_DOUBLE_STRUCK = {"1": "𝟙"}  # browsers know no variant of a digit
_BEFORE_SIGN = set("([{]=,<>≤≥≈×·+∈|") | {""}  # what a minus follows that stands for a sign


def mathml(latex: str) -> Markup:
    r"""A displayed formula.

    Examples
    --------
    >>> mathml(r"x^2")[-53:]
    Markup('<mrow><msup><mi>x</mi><mn>2</mn></msup></mrow></math>')
    """
    return Markup(_convert(latex, "block"))  # noqa: S704 # written in this repository's own declarations


def prose(text: str) -> Markup:
    """Plain text in which ``$…$`` holds LaTeX and ``*…*`` is emphasised.

    Examples
    --------
    >>> print(prose("It is *not* < 1."))
    It is <em>not</em> &lt; 1.
    """
    words = _FORMULA.split(text)  # text and formulas in turn
    parts = [
        _convert(part, "inline") if index % 2 else _EMPHASIS.sub(r"<em>\1</em>", escape(part, quote=False))
        for index, part in enumerate(words)
    ]
    return Markup("".join(parts))  # noqa: S704 # everything that was not converted is escaped


@cache
def _convert(latex: str, display: Literal["block", "inline"]) -> str:
    math = ElementTree.fromstring(convert(latex, xmlns="", display=display))  # noqa: S314 # written by the converter
    for parent in list(math.iter()):
        _adjust(parent, display)
    return ElementTree.tostring(math, encoding="unicode")


def _adjust(parent: ElementTree.Element, display: str) -> None:
    """Say what the converter leaves to a browser's dictionary of operators, which spaces and stretches it wrongly."""
    before = ""
    for place, child in enumerate(parent):
        text = (child.text or "").strip()
        if child.tag == "mo":
            _adjust_operator(child, text, accent=parent.tag == "mover" and place == 1, sign=before in _BEFORE_SIGN)
        elif child.get("mathvariant") == "double-struck" and text in _DOUBLE_STRUCK:
            child.text = _DOUBLE_STRUCK[text]
        elif child.tag == "mi" and text and "Α" <= text <= "Ω":
            child.set("mathvariant", "normal")  # capital Greek stands upright in LaTeX
        before = text if child.tag == "mo" else "operand"
    if parent.tag == "mover" and (parent[1].text or "") == _OVERLINE:
        parent.tag = "mrow"
        parent.set("class", "overline")
        parent.remove(parent[1])
    if parent.tag == "msub" and display == "block" and (parent[0].text or "") in _LIMITS:
        parent.tag = "munder"


def _adjust_operator(operator: ElementTree.Element, text: str, *, accent: bool, sign: bool) -> None:
    if accent and text in _ACCENTS:
        operator.text = _ACCENTS[text]
        operator.set("stretchy", "false")
    elif text in _BARS:
        operator.set("stretchy", operator.get("stretchy", "false"))
        operator.set("lspace", "0")
        operator.set("rspace", "0")
    elif text in {"−", "+"} and sign:
        operator.set("form", "prefix")
    elif len(text) > 1 and text.isalpha():
        operator.tag = "mi"
