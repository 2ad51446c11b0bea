"""The changes to shipped scenes that show each symptom, and those that cure it."""

from __future__ import annotations

from symptom_run import Case

from drake_haptics.scene.schema import (
    EncoderParameters,
    ForceDelayParameters,
    FrictionParameters,
    GravityParameters,
    HandPathParameters,
    ShadingParameters,
    Waypoint,
)

_SPOON = [0.0, -68.0, 0.0]
_THROUGH_WALL = HandPathParameters(
    waypoints=[
        Waypoint(0.0, [-0.004, 0.0, 0.034], _SPOON),
        Waypoint(0.6, [-0.020, 0.0, 0.016], _SPOON),
        Waypoint(0.9, [-0.075, 0.0, 0.016], _SPOON),
    ]
)
_STIFF = {"contact.stiffness_N_per_m": 1e6}
_SOFT = {"contact.tolerance_m": 1e-3, "contact.stiffness_N_per_m": 2000.0}
COUPLING = "coupling.stiffness_N_per_m"
_RIPPLE = "ripple of the force on a hand at rest, N"
_JUMP = "largest jump of the force in one tick, N"
_DEPTH = "deepest contact, mm"
_STOPS = "the hand stops"

CASES = (
    Case(
        "buzzing",
        "cup_spoon",
        _RIPPLE,
        {COUPLING: 30000.0},
        {COUPLING: 800.0},
        given=_STIFF,
        motion=_STOPS,
        stop_s=0.6,
    ),
    Case(
        "buzzing",
        "cup_spoon",
        _RIPPLE,
        {"device.twin.delay": ForceDelayParameters(20)},
        {COUPLING: 300.0},
        given=_STIFF,
        motion=_STOPS,
        stop_s=0.6,
    ),
    Case(
        "buzzing",
        "cup_spoon",
        _RIPPLE,
        {
            "device.twin.encoder": EncoderParameters([1e-3] * 6, velocity_window=1),
            "coupling.damping_Ns_per_m": 10.0,
        },
        {
            "device.twin.encoder": EncoderParameters([1e-3] * 6, velocity_window=8),
            "coupling.damping_Ns_per_m": 2.0,
        },
        motion=_STOPS,
        stop_s=0.6,
    ),
    Case(
        "sticking",
        "rubbed_sphere",
        "tool behind the handle, at most, mm",
        {"environment.material.friction_coefficient": 3.0},
        {"environment.material.friction_coefficient": 0.3},
        duration_s=4.0,
    ),
    Case(
        "tunnelling",
        "cup_spoon",
        _DEPTH,
        {"contact.stiffness_N_per_m": 500.0},
        {"contact.stiffness_N_per_m": 20000.0},
        motion="the hand goes through the wall",
        path=_THROUGH_WALL,
    ),
    Case(
        "tunnelling",
        "cup_spoon",
        _DEPTH,
        {"contact.query_rate_hz": 20.0},
        {"contact.query_rate_hz": None},
        given={"contact.stiffness_N_per_m": 20000.0},
        motion="the hand goes through the wall",
        path=_THROUGH_WALL,
    ),
    # The peg's radius is 12 mm; the hole's, of 22 mm, is made 0.54 mm larger than that.
    Case(
        "fit",
        "torus_peg",
        "tool behind a hand at rest, mm",
        {
            "environment.scale": 0.57,
            "contact.tolerance_m": 2e-3,
            "contact.stiffness_N_per_m": 20000.0,
        },
        {"contact.tolerance_m": 4e-4},
        motion=_STOPS,
        stop_s=0.5,
    ),
    Case(
        "jumps",
        "sphere_pen",
        _JUMP,
        {"environment.max_triangles": 60, **_SOFT},
        {"effects.shading": ShadingParameters(60.0)},
        duration_s=4.0,
    ),
    Case(
        "jumps",
        "cup_spoon",
        _JUMP,
        {"contact.query_rate_hz": 50.0},
        {"contact.query_rate_hz": None},
        given={"contact.stiffness_N_per_m": 20000.0, "contact.tolerance_m": 2e-3},
        motion="the hand goes through the wall",
        path=_THROUGH_WALL,
    ),
    Case(
        "late",
        "cup_spoon",
        "work of a tick, % of its time",
        {"device.rate_hz": 10000.0},
        {"device.rate_hz": 1000.0},
        duration_s=1.0,
    ),
    Case(
        "nothing",
        "sphere_pen",
        "ticks in contact, %",
        {"environment.scale": 1e-3},
        {"environment.scale": 1.0},
    ),
    Case("weak", "cup_spoon", "largest force, N", {COUPLING: 50.0}, {COUPLING: 800.0}),
    Case(
        "weak",
        "cup_spoon",
        "ticks at the device's limit, %",
        {"device.max_force_N": 1.0},
        {"device.max_force_N": None},
    ),
    Case(
        "far",
        "cup_spoon",
        "tool behind the handle, at most, mm",
        {COUPLING: 50.0},
        {COUPLING: 3000.0},
    ),
    Case(
        "far",
        "sphere_pen",
        "tool behind a hand at rest, mm",
        {"effects.gravity": GravityParameters(), "tool.mass_kg": 0.1, COUPLING: 100.0},
        {COUPLING: 2000.0},
        motion=_STOPS,
        stop_s=0.0,
    ),
    Case(
        "drift",
        "torus_peg",
        "way of the tool under a hand at rest, mm",
        {},
        {"effects.friction": FrictionParameters(0.3)},
        motion=_STOPS,
        stop_s=1.4,
    ),
)
