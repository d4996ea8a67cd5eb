"""Crops: what is written of them is read back, what lies outside is refused, and the centre is the middle."""

from dataclasses import astuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInputError
from app.images.crop import Frames, Rectangle, crop_to_centre
from app.synthesis.structure import CENTRE

whole_numbers = st.integers(-(10**6), 10**6)


@given(st.tuples(whole_numbers, whole_numbers, whole_numbers, whole_numbers))
def test_a_rectangle_is_read_as_it_is_written(numbers: tuple[int, int, int, int]) -> None:
    rectangle = Rectangle(*numbers)
    assert astuple(rectangle) == numbers
    assert Rectangle.parse(str(rectangle)) == rectangle


@given(st.tuples(whole_numbers, whole_numbers))
def test_a_time_range_is_read_as_it_is_written(numbers: tuple[int, int]) -> None:
    frames = Frames(*numbers)
    assert astuple(frames) == numbers
    assert Frames.parse(str(frames)) == frames


@pytest.mark.parametrize("text", ["", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,2,3,4.5", "1,2,3,", "1;2;3;4"])
def test_a_rectangle_of_anything_but_four_whole_numbers_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="four whole numbers x,y,width,height") as refusal:
        Rectangle.parse(text)
    assert refusal.value.field == "crop"


@pytest.mark.parametrize("text", ["", "1", "1,2,3", "1,x", "1,2.5", ","])
def test_a_time_range_of_anything_but_two_whole_numbers_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="two whole numbers first,count") as refusal:
        Frames.parse(text)
    assert refusal.value.field == "frames"


@pytest.mark.parametrize("text", ["0,0,40,30", "0,0,1,1", "39,29,1,1", "5,7,35,23"])
def test_a_rectangle_up_to_the_border_is_accepted(text: str) -> None:
    rectangle = Rectangle.parse(text)
    assert rectangle.check_within(40, 30) is rectangle


@pytest.mark.parametrize("text", ["-1,0,5,5", "0,-1,5,5", "0,0,41,30", "0,0,40,31", "40,0,1,1", "0,30,1,1", "36,0,5,5"])
def test_a_rectangle_beyond_the_border_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="40 × 30 pixels: move it or make it smaller") as refusal:
        Rectangle.parse(text).check_within(40, 30)
    assert refusal.value.field == "crop"


@pytest.mark.parametrize("text", ["3,3,0,5", "3,3,5,0", "3,3,-2,5", "3,3,5,-2"])
def test_an_empty_rectangle_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="at least 1 × 1 pixel: draw it again"):
        Rectangle.parse(text).check_within(40, 30)


@pytest.mark.parametrize("text", ["0,12", "0,1", "11,1", "3,9"])
def test_a_time_range_up_to_the_last_frame_is_accepted(text: str) -> None:
    frames = Frames.parse(text)
    assert frames.check_within(12) is frames


@pytest.mark.parametrize("text", ["-1,3", "0,13", "12,1", "4,9"])
def test_a_time_range_beyond_the_last_frame_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="which has 12 frames") as refusal:
        Frames.parse(text).check_within(12)
    assert refusal.value.field == "frames"
    with pytest.raises(InvalidInputError, match=r"which has 1 frame \("):
        Frames.parse("0,2").check_within(1)


@pytest.mark.parametrize("text", ["0,0", "5,0", "3,-1"])
def test_an_empty_time_range_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="at least 1 frame: enter the number of frames"):
        Frames.parse(text).check_within(12)


@pytest.mark.parametrize(
    ("factor", "size"), [(1, (103, 99)), (2, (206, 198)), (0.5, (52, 50)), (1.5, (155, 149)), (0.001, (1, 1))]
)
def test_a_scaled_size_is_rounded_with_halves_up(factor: float, size: tuple[int, int]) -> None:
    assert Rectangle(7, 8, 103, 99).scale_size(factor) == size


@given(st.integers(0, 9), st.integers(0, 9), st.integers(1, 3000), st.integers(1, 3000))
def test_the_centre_is_the_middle_and_no_larger_than_is_measured(x: int, y: int, width: int, height: int) -> None:
    centre = crop_to_centre(Rectangle(x, y, width, height))
    assert (centre.width, centre.height) == (min(width, CENTRE), min(height, CENTRE))
    left, right = centre.x - x, x + width - centre.x - centre.width
    above, below = centre.y - y, y + height - centre.y - centre.height
    assert 0 <= left <= right <= left + 1
    assert 0 <= above <= below <= above + 1
