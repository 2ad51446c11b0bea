"""How smooth a contact's point, normal and distance are over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics.evaluation.paper.pen_truth import ContactCurves


@dataclass(frozen=True)
class Smoothness:
    """Steps from tick to tick beyond those of the truth, and errors.

    A step is what a value changes by from one tick to the next. That of the truth is
    what the motion explains; the difference from it is told here.

    Attributes:
        point_step_m: Largest of the contact point, m.
        normal_step_deg: Largest of the normal, degrees.
        distance_step_m: Largest of the distance, m.
        crossing_step_m: Largest of the distance where it changes its sign, m.
        normal_error_deg: Largest angle between the normal and the true one, degrees.
        distance_error_m: Largest error of the distance, m.
        true_normal_step_deg: Largest step of the true normal, degrees.
        true_distance_step_m: Largest step of the true distance, m.
    """

    point_step_m: float
    normal_step_deg: float
    distance_step_m: float
    crossing_step_m: float
    normal_error_deg: float
    distance_error_m: float
    true_normal_step_deg: float
    true_distance_step_m: float


def measure_smoothness(curves: ContactCurves, truth: ContactCurves) -> Smoothness:
    """Compares the curves of two ticks or more with the truth."""
    off_m = curves.distance_m - truth.distance_m
    steps_m = np.abs(np.diff(off_m))
    inside = curves.distance_m < 0.0
    crossing = inside[1:] != inside[:-1]
    # The chord of two unit vectors, as an angle.
    chord = np.linalg.norm(curves.nhat_BA_W - truth.nhat_BA_W, axis=1).max()
    return Smoothness(
        point_step_m=_largest_step(curves.p_WC - truth.p_WC),
        normal_step_deg=_degrees(_largest_step(curves.nhat_BA_W - truth.nhat_BA_W)),
        distance_step_m=float(steps_m.max()),
        crossing_step_m=float(steps_m[crossing].max(initial=0.0)),
        normal_error_deg=_degrees(2.0 * np.arcsin(min(1.0, chord / 2.0))),
        distance_error_m=float(np.abs(off_m).max()),
        true_normal_step_deg=_degrees(_largest_step(truth.nhat_BA_W)),
        true_distance_step_m=float(np.abs(np.diff(truth.distance_m)).max()),
    )


def _largest_step(values: np.ndarray) -> float:
    """Returns the largest change of (n, 3) vectors from one to the next."""
    return float(np.linalg.norm(np.diff(values, axis=0), axis=1).max())


def _degrees(angle_rad: float) -> float:
    return float(np.rad2deg(angle_rad))
