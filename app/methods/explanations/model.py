"""Explanations of methods: prose, formulas, figures that it computes itself, and the articles it comes from.

Prose is plain text in which ``$…$`` holds LaTeX; the pages turn it into MathML.
"""

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal


@dataclass(frozen=True)
class Reference:
    """An article.

    Parameters
    ----------
    authors : str
        Initials and family names, with commas between authors: ``"B. Galerne, Y. Gousseau"``.
    title : str
    venue : str
        Journal with its volume, or proceedings.
    year : int
    url : str
    kind : {"article", "inproceedings", "incollection"}
        As BibTeX calls it.
    pages : str
        With ``--`` between first and last, empty where there are none.

    Examples
    --------
    >>> print(Reference("L. Moisan", "Periodic Plus Smooth", "JMIV 39(2)", 2011, "https://doi.org/10.1/x").bibtex)
    @article{moisan2011periodic,
      author = {L. Moisan},
      title = {Periodic Plus Smooth},
      journal = {JMIV 39(2)},
      year = {2011},
      url = {https://doi.org/10.1/x}
    }
    """

    authors: str
    title: str
    venue: str
    year: int
    url: str
    kind: Literal["article", "inproceedings", "incollection"] = "article"
    pages: str = ""

    @property
    def key(self) -> str:
        """The first author's family name, the year and the title's first long word."""
        family = self.authors.split(",")[0].split()[-1]
        word = next(word for word in re.findall(r"\w+", self.title) if len(word) > 3)
        plain = unicodedata.normalize("NFKD", f"{family}{self.year}{word}".lower())
        return "".join(letter for letter in plain if letter.isascii() and letter.isalnum())

    @property
    def bibtex(self) -> str:
        """The entry of a BibTeX file."""
        fields = {
            "author": self.authors.replace(", ", " and "),
            "title": self.title,
            "journal" if self.kind == "article" else "booktitle": self.venue,
            "pages": self.pages,
            "year": str(self.year),
            "url": self.url,
        }
        lines = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items() if value)
        return f"@{self.kind}{{{self.key},\n{lines}\n}}"


@dataclass(frozen=True)
class Formula:
    """A displayed formula in LaTeX, and a sentence (prose) that reads it out."""

    latex: str
    text: str


@dataclass(frozen=True)
class Exhibit:
    """One experiment of a figure, on bundled samples.

    Parameters
    ----------
    method : str
    inputs : tuple of (sample id, crop as ``x,y,width,height``)
    parameters : mapping
    show : tuple of str
        Names of the outputs that the figure shows, in this order.
    label : str
        What stands under its pictures, such as ``"n = 100"``.
    """

    method: str
    inputs: tuple[tuple[str, str], ...]
    parameters: Mapping[str, Any] = field(default_factory=dict)
    show: tuple[str, ...] = ("crop", "texture")
    label: str = ""


@dataclass(frozen=True)
class Figure:
    """Pictures that the program makes itself, with what they show (prose)."""

    title: str
    caption: str
    exhibits: tuple[Exhibit, ...]


@dataclass(frozen=True)
class Explanation:
    """A method's page.

    Parameters
    ----------
    what : tuple of str
        Paragraphs (prose): what it does and how.
    formulas : tuple of Formula
    fails : tuple of str
        Paragraphs (prose): when it does not do what one hopes for, and what to take instead.
    figures : tuple of Figure
        At least one on which it succeeds and one on which it fails.
    """

    what: tuple[str, ...]
    formulas: tuple[Formula, ...]
    fails: tuple[str, ...]
    figures: tuple[Figure, ...]
