"""Makes a bolt, and a nut whose teeth run in the bolt's thread."""

from __future__ import annotations

import numpy as np

from shapes.surface import Surface, SurfaceBuilder, circle, loft

THREAD_PITCH_M = 0.008
"""Advance along the axis in a turn, m; the thread is right-handed."""
_SIDES = 24
_BOLT_ROOT_M, _BOLT_CREST_M = 0.008, 0.0105
_BOLT_TURNS = 3
_RADIUS_M, _HEAD_M = 0.026, 0.008
# Distance between the teeth of the nut and the root of the bolt. As the teeth are cut
# from 24 sides, the least clearance on each side is 0.1 mm.
_RADIAL_PLAY_M = 3.9e-4
_BORE_M = 0.0125
# Sections of the nut, of 24 in a turn, and those that have a tooth.
_NUT_SECTIONS, _TEETH = 28, (5, 13, 21)


def make_bolt() -> Surface:
    """Returns a bolt that stands on its head at the origin, thread upward.

    A right-handed thread of one start, 21 mm in diameter, pitch 8 mm, three turns, on
    a head of 52 mm; 36 mm high. Crest, root and flanks are each a quarter of the pitch.
    """
    low = _HEAD_M + 0.002
    sections = [
        circle(_RADIUS_M, 0.0, _SIDES),
        circle(_RADIUS_M, _HEAD_M, _SIDES),
        circle(_BOLT_ROOT_M, _HEAD_M, _SIDES),
        *(
            _make_section(_calc_thread(0.0), low, k)
            for k in range(_BOLT_TURNS * _SIDES + 1)
        ),
    ]
    top = low + _BOLT_TURNS * THREAD_PITCH_M + 0.002
    sections.append(circle(_BOLT_ROOT_M - 0.001, top, _SIDES))
    return loft((0, 0, 0), sections, (0, 0, top))


def make_nut() -> Surface:
    """Returns a round nut for the bolt, its lower face at z = 0.

    52 mm in diameter, 9.3 mm high, with a bore of 25 mm. Its thread is three teeth, a
    third of a turn apart: they touch as a whole thread would, and are few pieces.
    """
    builder = SurfaceBuilder()
    bore, tooth = np.full(_SIDES, _BORE_M), _calc_thread(_RADIAL_PLAY_M)
    # The nut has its bore where the bolt has its crest.
    tooth = np.where(_calc_thread(0.0) > _BOLT_ROOT_M, _BORE_M, tooth)
    height = _NUT_SECTIONS * THREAD_PITCH_M / _SIDES
    low = builder.add_ring(circle(_RADIUS_M, 0.0, _SIDES))
    high = builder.add_ring(circle(_RADIUS_M, height, _SIDES))
    builder.add_band(low, high)
    # The last section begins at the angle to which the thread has turned.
    turned = _NUT_SECTIONS % _SIDES
    sections = (
        _make_section(tooth if k in _TEETH or k - 1 in _TEETH else bore, 0.0, k)
        for k in reversed(range(_NUT_SECTIONS + 1))
    )
    rings = builder.add_tube(sections, rim=[*high[turned:], *high[:turned]])
    builder.add_band(rings[-1], low)
    return builder.build()


def _calc_thread(play_m: float) -> np.ndarray:
    """Returns the radii (24,), m, of a thread around the axis, its crest at 0."""
    phase = np.arange(_SIDES) / _SIDES
    share = np.clip(1.0 - (np.minimum(phase, 1.0 - phase) - 0.125) / 0.25, 0.0, 1.0)
    return _BOLT_ROOT_M + play_m + share * (_BOLT_CREST_M - _BOLT_ROOT_M)


def _make_section(radii: np.ndarray, start_m: float, k: int) -> np.ndarray:
    """Returns a section (24, 3), m, of a thread that begins at a height.

    From one section to the next it turns by a vertex, so that each vertex runs along a
    helix.
    """
    angle = 2.0 * np.pi * (np.arange(_SIDES) + k) / _SIDES
    height = np.full(_SIDES, start_m + k * THREAD_PITCH_M / _SIDES)
    return np.column_stack([radii * np.cos(angle), radii * np.sin(angle), height])
