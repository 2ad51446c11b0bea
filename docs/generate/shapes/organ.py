"""Makes an organ: a folded, branching tube, after the paper's digestive system."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from shapes.surface import (
    SmoothPath,
    Surface,
    SurfaceBuilder,
    opening_loop,
    rounded_path,
)

# Corners of the axes, (x, y, z) in m, before the whole is bent a little.
_COLON = (
    (-0.11, 0.0, -0.09),
    (-0.11, 0.0, 0.135),
    (0.11, 0.0, 0.135),
    (0.11, 0.0, -0.10),
    (0.0, 0.0, -0.10),
    (0.0, 0.0, -0.20),
)
_ROWS_Z_M = (-0.055, -0.028, -0.001, 0.026, 0.053, 0.080)
_ROW_ENDS_X_M = (0.062, -0.062)
_BACK_Y_M = -0.032
_APPENDIX = ((-0.11, 0.030, -0.070), (-0.11, 0.060, -0.070), (-0.11, 0.060, -0.140))
# Where the branches leave the colon: rows and columns of its rings.
_BOWEL_ROWS, _BOWEL_COLUMNS = range(4, 11), range(-3, 4)
_APPENDIX_ROWS, _APPENDIX_COLUMNS = range(3, 7), range(7, 11)
_COLON_SECTORS = 32


def make_organ() -> Surface:
    """Returns a colon with its bowel and appendix as one closed surface.

    0.29 m wide and 0.36 m high with z up; about 25,000 triangles, as many as the
    digestive system of the paper's Table 1. The colon has pouches between three
    bands; the bowel is folded up in two layers within the colon's frame.
    """
    builder = SurfaceBuilder()
    path = rounded_path(np.array(_COLON), 0.045, bend_steps=14, step=0.0048)
    rings = builder.add_tube(
        _make_sections(path, np.array([1.0, 0.0, 0.0]), _COLON_SECTORS, _colon_radius),
        start=_bend(path.points[0]),
        end=_bend(path.points[-1]),
        holes=_holes,
    )
    bowel = rounded_path(_bowel_corners(), 0.0135, bend_steps=4, step=0.0063)
    rim = _rim(rings, _BOWEL_ROWS, _BOWEL_COLUMNS)
    _add_branch(builder, rim, bowel, np.array([0.0, -1.0, -1.0]), _bowel_radius)
    appendix = rounded_path(np.array(_APPENDIX), 0.015, bend_steps=6, step=0.004)
    rim = _rim(rings, _APPENDIX_ROWS, _APPENDIX_COLUMNS)
    _add_branch(builder, rim, appendix, np.array([1.0, 0.0, -1.0]), _appendix_radius)
    return builder.build()


def _bowel_corners() -> np.ndarray:
    """Returns the bowel's way from the colon in rows, up the front, down the back."""
    corners = [(-0.076, 0.0, _ROWS_Z_M[0])]
    for y, rows in ((0.0, _ROWS_Z_M), (_BACK_Y_M, _ROWS_Z_M[::-1])):
        for z in rows:
            x = _ROW_ENDS_X_M[len(corners) // 2 % 2]
            if len(corners) > 1:
                corners.append((corners[-1][0], y, z))
            corners.append((x, y, z))
    return np.array(corners)


# Radii, m, at the distance s along the axis, m, of `length`, and at an angle.
def _colon_radius(s: float, length: float, angle: np.ndarray) -> np.ndarray:
    pouch = np.sqrt(0.5 - 0.5 * np.cos(2 * np.pi * s / 0.029))
    band = np.sin(1.5 * angle) ** 2
    return 0.024 * _dome(min(s, length - s), 0.024) * (0.84 + 0.30 * band * pouch)


def _bowel_radius(s: float, length: float, angle: np.ndarray) -> np.ndarray:
    fold = 1 + 0.06 * np.cos(2 * np.pi * s / 0.027)
    return np.full_like(angle, 0.010 * fold * _dome(length - s, 0.010))


def _appendix_radius(s: float, length: float, angle: np.ndarray) -> np.ndarray:
    return np.full_like(angle, 0.0042 * _dome(length - s, 0.0042))


def _dome(from_end: float, radius: float) -> float:
    """Returns the share of the radius at a distance from an end, where it is 0."""
    share = min(from_end / radius, 1.0)
    return float(np.sqrt(share * (2 - share)))


def _bend(points: np.ndarray) -> np.ndarray:
    """Bends space one to one: nothing stays straight or flat, or meets itself."""
    x, y, z = np.moveaxis(np.asarray(points), -1, 0)
    bent = [
        x + 0.009 * np.sin(22 * z + 30 * y),
        y + 0.013 * np.sin(20 * x + 12 * z),
        z + 0.006 * np.sin(25 * x),
    ]
    return np.stack(bent, axis=-1)


def _make_sections(
    path: SmoothPath,
    normal: np.ndarray,
    count: int,
    radius: Callable[[float, float, np.ndarray], np.ndarray],
) -> Iterator[np.ndarray]:
    """Yields rings of `count` points around a path, but for its ends."""
    steps = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    angle = 2 * np.pi * np.arange(count) / count
    frames = path.frames(normal)
    for s, p, frame in list(zip(along, path.points, frames, strict=True))[1:-1]:
        r = radius(float(s), float(along[-1]), angle)
        section = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
        yield _bend(p + section @ frame[:, :2].T)


def _add_branch(
    builder: SurfaceBuilder,
    rim: list[int],
    path: SmoothPath,
    normal: np.ndarray,
    radius: Callable[[float, float, np.ndarray], np.ndarray],
) -> None:
    """Adds a tube from the rim of an opening along a path to a closed end.

    Args:
        builder: The surface to add to.
        rim: The rim of the opening.
        path: The axis of the tube.
        normal: (3,) direction in which the rim begins, seen from the axis.
        radius: Function that returns radii of the tube, m, as `_bowel_radius` does.
    """
    sections = _make_sections(path, normal, len(rim), radius)
    builder.add_tube(sections, rim=rim, end=_bend(path.points[-1]))


def _rim(rings: list[Sequence[int]], rows: range, columns: range) -> list[int]:
    """Returns the rim of an opening of the colon."""
    around = [column % _COLON_SECTORS for column in columns]
    return opening_loop([rings[row] for row in rows], around)


def _holes(row: int) -> list[int]:
    """Returns the columns that are open between the rings `row` and `row` + 1."""
    return [
        column % _COLON_SECTORS
        for rows, columns in (
            (_BOWEL_ROWS, _BOWEL_COLUMNS),
            (_APPENDIX_ROWS, _APPENDIX_COLUMNS),
        )
        if row in rows[:-1]
        for column in columns[:-1]
    ]
