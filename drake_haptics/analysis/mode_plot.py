"""Plots poles in the z plane, with the unit circle and lines of equal damping."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.analysis.modes import Mode, ModeKind, PeriodMap, find_modes
from drake_haptics.common.colors import STABLE, UNSTABLE
from drake_haptics.report.plot_labels import find_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DAMPING_RATIOS = np.arange(0.1, 1.0, 0.1)
_FREQUENCIES = np.arange(0.1, 1.01, 0.1)  # of half the sampling rate
_SMALL, _LEGEND_SIZE = 8, 10
_GRID: dict[str, Any] = {"color": "0.8", "linewidth": 0.6, "zorder": 0}
_LOOKS: dict[str, dict[str, Any]] = {
    "unstable": {"marker": "x", "color": UNSTABLE, "zorder": 4},
    "stable": {"marker": "x", "color": STABLE, "zorder": 3},
    "neither: memory, quaternion length": {
        "marker": "o",
        "facecolors": "none",
        "edgecolors": "0.5",
        "zorder": 2,
    },
}


def plot_poles(linear: PeriodMap, axes: Axes | None = None) -> Axes:
    """Draws the eigenvalues of a linear map over a period in the z plane.

    Lines of equal damping ratio spiral inward from 1; lines of equal natural frequency
    cross them. Both are labeled: ζ, and Hz.

    Args:
        linear: The map from `linearize_sampled` or `calc_monodromy`.
        axes: The axes to draw on. Defaults to new ones.

    Returns:
        The axes.
    """
    axes = find_axes(axes, (6.0, 6.0))
    _draw_grid(axes, linear.period_s)
    modes = find_modes(linear)
    for label, look in _LOOKS.items():
        values = np.array([m.eigenvalue for m in modes if _tell_look(m) == label])
        if len(values):
            pairs = np.concatenate([values, values[values.imag > 0.0].conj()])
            axes.scatter(pairs.real, pairs.imag, label=label, **look)
    axes.set_aspect("equal")
    axes.set_xlim(-1.5, 1.5)
    axes.set_ylim(-1.3, 1.3)
    axes.set_xlabel("Re z")
    axes.set_ylabel("Im z")
    axes.set_title(
        f"poles over {1e3 * linear.period_s:g} ms, largest |z| ="
        f" {linear.spectral_radius():.6f}"
    )
    axes.legend(loc="lower left", fontsize=_LEGEND_SIZE)
    return axes


def _tell_look(mode: Mode) -> str:
    if mode.kind is not ModeKind.MOTION:
        return "neither: memory, quaternion length"
    return "unstable" if mode.growth_per_period > 0.0 else "stable"


def _draw_grid(axes: Axes, period_s: float) -> None:
    circle = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 361))
    axes.plot(circle.real, circle.imag, color="0.3", linewidth=1.0, zorder=1)
    for ratio in _DAMPING_RATIOS:
        # Up to half the sampling rate: ω_n T √(1 - ζ²) = π.
        swing = np.linspace(0.0, np.pi, 200)
        z = np.exp(swing * (1j - ratio / np.sqrt(1.0 - ratio**2)))
        _draw_line(axes, z)
        label = z[60]
        axes.annotate(
            f"{ratio:.1f}", (label.real, label.imag), fontsize=_SMALL, color="0.4"
        )
    for share in _FREQUENCIES:
        angle = np.linspace(np.pi / 2.0, np.pi, 100)
        z = np.exp(share * np.pi * np.exp(1j * angle))
        _draw_line(axes, z)
        label = 1.06 * z[0]
        axes.annotate(
            f"{share / (2.0 * period_s):.3g} Hz",
            (label.real, label.imag),
            fontsize=_SMALL,
            color="0.4",
            ha="left" if label.real > 0.0 else "right",
        )


def _draw_line(axes: Axes, z: np.ndarray) -> None:
    """Draws a line of the upper half plane, and its mirror image."""
    axes.plot(z.real, z.imag, **_GRID)
    axes.plot(z.real, -z.imag, **_GRID)
