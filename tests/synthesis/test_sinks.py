"""Values out of range are cut off or stretched, never wrapped."""

import numpy as np
import pytest

from app.synthesis.sinks import Extent, Levels, array_sink


def rounded(values, low=0, high=255, peak=255):
    """One row of values through `Levels`."""
    rows = []
    Levels(lambda first, block: rows.append((first, block.copy())), 1, low, high, peak)(
        3, [np.array([values], np.float32)]
    )
    ((first, block),) = rows
    assert first == 3
    assert block.flags.c_contiguous
    return block[0, :, 0].tolist()


def test_values_are_rounded_and_those_outside_cut_off():
    assert rounded([-1e9, -300, -0.6, 0.4, 0.6, 127.5, 254.6, 255.4, 256, 70000, 1e9]) == [
        0, 0, 0, 0, 1, 128, 255, 255, 255, 255, 255,
    ]  # fmt: skip


def test_whole_numbers_stay_at_8_and_16_bits():
    assert rounded(range(256)) == list(range(256))
    assert rounded(range(65536), 0, 65535, 65535) == list(range(65536))


def test_another_depth_scales_peak_to_peak():
    assert rounded([0, 1, 255, 300], 0, 255, 65535) == [0, 257, 65535, 65535]
    assert rounded([0, 65535, 32896, 70000], 0, 65535, 255) == [0, 255, 128, 255]


def test_stretching_maps_the_extremes_to_the_ends_and_the_rest_affinely():
    extent = Extent(255)
    extent(0, [np.array([[-45.0, 10]], np.float32), np.array([[100, 210.0]], np.float32)])
    assert (extent.low, extent.high) == (-45, 255)
    assert rounded([-45, 105, 255], extent.low, extent.high) == [0, 128, 255]


@pytest.mark.parametrize("values", [[0, 255], [17, 17], [3, 200]])
def test_stretching_changes_nothing_when_nothing_is_outside(values):
    extent = Extent(255)
    extent(0, [np.array([values], np.float32)])
    assert rounded(values, extent.low, extent.high) == values


def test_channels_are_interleaved():
    planes = [np.full((2, 3), value, np.float32) for value in (1, 2, 3)]
    rows = []
    Levels(lambda first, block: rows.append(block.copy()), 3, 0, 255, 255)(0, planes)
    assert rows[0].shape == (2, 3, 3)
    assert rows[0].reshape(-1, 3).tolist() == [[1, 2, 3]] * 6


def test_rows_of_an_array_sink_lie_where_they_belong_in_whatever_order_they_come():
    texture = np.full((5, 4, 2), np.nan, np.float32)
    sink = array_sink(texture)
    values = np.arange(40, dtype=np.float32).reshape(5, 4, 2)
    for first, last in ((3, 5), (0, 3)):
        sink(first, [values[first:last, :, channel] for channel in range(2)])
    assert (texture == values).all()
