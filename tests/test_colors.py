"""The colour scheme: valid, and pieces can be told apart."""

import itertools

import numpy as np

from drake_haptics import colors


def test_all_colors_are_valid():
    named = [value for value in vars(colors).values() if isinstance(value, tuple)]
    assert len(named) >= 7
    for color in named + [colors.piece_color(i) for i in range(1000)]:
        assert len(color) == 4 and all(0 <= channel <= 1 for channel in color)


def test_contact_colors_are_green_and_red():
    assert np.argmax(colors.NEAR_CONTACT[:3]) == 1
    assert np.argmax(colors.PENETRATING_CONTACT[:3]) == 0


def test_the_first_pieces_differ_visibly():
    first = [np.array(colors.piece_color(i)) for i in range(12)]
    for a, b in itertools.combinations(first, 2):
        assert np.abs(a - b).max() > 0.05
    for a, b in itertools.pairwise(first):
        assert np.abs(a - b).max() > 0.25
