"""Formulas are set as LaTeX sets them, where a browser's dictionary of operators would not."""

from xml.etree import ElementTree

import pytest

from app.web.prose import mathml, prose


def parsed(latex: str) -> ElementTree.Element:
    return ElementTree.fromstring(mathml(latex))


def tags(latex: str) -> list[str]:
    return [each.tag for each in parsed(latex).iter()]


def operator(latex: str, text: str) -> ElementTree.Element:
    return next(each for each in parsed(latex).iter("mo") if each.text == text)


@pytest.mark.parametrize("name", ["max", "min", "lim", "sup", "inf"])
def test_limits_stand_below_the_name_in_a_displayed_formula_and_beside_it_in_a_line(name: str) -> None:
    assert "munder" in tags(rf"\{name}_{{x}} f")
    inline = prose(rf"$\{name}_{{x}} f$")
    assert "<munder" not in inline
    assert "<msub" in inline
    assert "munder" not in tags(r"a_{x} f")


@pytest.mark.parametrize(("latex", "bar"), [("|x|", "|"), (r"\|x\|", "‖"), ("a/b", "/")])
def test_bars_neither_stretch_nor_keep_their_distance(latex: str, bar: str) -> None:
    found = operator(latex, bar)
    assert (found.get("stretchy"), found.get("lspace"), found.get("rspace")) == ("false", "0", "0")


def test_bars_that_are_to_stretch_do() -> None:
    assert operator(r"\left|\frac{a}{b}\right|", "|").get("stretchy") == "true"


@pytest.mark.parametrize("latex", ["-b", "(-b)", "a = -b", "a, -b", r"a \cdot -b"])
def test_a_minus_that_is_a_sign_stands_close_to_its_number(latex: str) -> None:
    assert operator(latex, "−").get("form") == "prefix"


@pytest.mark.parametrize("latex", ["a - b", "2 - b", "(a) - b"])
def test_a_minus_between_two_is_an_operator(latex: str) -> None:
    assert operator(latex, "−").get("form") is None


def test_accents_are_as_wide_as_they_are_written() -> None:
    hat = operator(r"\hat{x}", "ˆ")
    assert hat.get("stretchy") == "false"


def test_an_overline_is_drawn_by_the_style_sheet() -> None:
    line = [each for each in parsed(r"\overline{xy}").iter("mrow") if each.get("class") == "overline"]
    assert len(line) == 1
    assert "mover" not in tags(r"\overline{xy}")


def test_capital_greek_is_upright_and_small_greek_is_not() -> None:
    (capital,) = parsed(r"\Omega").iter("mi")
    (small,) = parsed(r"\omega").iter("mi")
    assert capital.get("mathvariant") == "normal"
    assert small.get("mathvariant") is None


def test_a_double_struck_digit_is_its_own_character() -> None:
    assert "𝟙" in mathml(r"\mathbb{1}")


def test_text_is_escaped_and_emphasised() -> None:
    assert prose("*a* < <b> & $x$").startswith("<em>a</em> &lt; &lt;b&gt; &amp; <math")
