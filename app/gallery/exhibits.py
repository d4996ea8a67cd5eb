"""Exhibits: everything on show, in the order in which it is made."""

from collections.abc import Iterator

from app.gallery.catalogue import FAILURES, SUCCESSES
from app.gallery.identity import identifier
from app.gallery.literature import FIGURES
from app.methods.explanations.model import Exhibit, Figure
from app.methods.model import Method
from app.methods.registry import METHODS


def teaser(declared: Method) -> Exhibit:
    """The exhibit whose texture stands for a method: the first of its figures."""
    return declared.explanation.figures[0].exhibits[0]


def exhibits() -> dict[str, Exhibit]:
    """Every exhibit by its identifier: first one for each method, then the catalogue, then all other figures."""
    return {identifier(exhibit): exhibit for exhibit in _in_order()}


def _in_order() -> Iterator[Exhibit]:
    for declared in METHODS.values():
        yield teaser(declared)
    for pair in (*SUCCESSES, *FAILURES):
        yield pair.exhibit
    figures: list[Figure] = [figure for declared in METHODS.values() for figure in declared.explanation.figures]
    for figure in (*figures, *(entry.figure for entry in FIGURES)):
        yield from figure.exhibits
