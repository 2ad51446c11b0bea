"""Writes a scene's stability as an HTML page."""

from __future__ import annotations

import math
from pathlib import Path

from drake_haptics.analysis.delay_margin import LONGEST_DELAY
from drake_haptics.analysis.modes import describe_motion
from drake_haptics.analysis.scene_stability import SceneStability
from drake_haptics.analysis.stiffness_limits import format_limit
from drake_haptics.bounds.coupling import ROTATION, TRANSLATION
from drake_haptics.bounds.held_handle import calc_force_delay
from drake_haptics.report.page import write_page, write_picture
from drake_haptics.scene.schema import Scene

_SLOWEST_SHOWN = 12
# The header of a table and its rows.
_Table = tuple[list[str], list[list[str]]]


def write_stability_page(stability: SceneStability, name: str, path: Path) -> None:
    """Writes the page as one HTML file, and its picture as a PNG file next to it.

    Raises:
        HapticsError: The path has the picture's suffix.
        OSError: A file cannot be written.
    """
    sheet = write_picture(stability.plot(), path)
    write_page(
        path,
        "analysis/stability_page.html",
        name=name,
        description=stability.scene.description,
        verdict=describe_verdict(stability),
        verdict_class=_choose_class(stability),
        situation=describe_situation(stability),
        sheet=sheet,
        restless=describe_restless(stability),
        limits=_make_limits(stability),
        margins=_make_margins(stability),
        gains=_make_gains(stability),
        modes=_make_modes(stability),
        warnings=stability.broken_bounds,
    )


def describe_verdict(stability: SceneStability) -> str:
    """Returns a sentence or two that say whether the scene is stable and passive."""
    if not stability.is_stable:
        return (
            f"Unstable: a disturbance grows by {_percent(stability.growth - 1.0)} in"
            f" each tick: {describe_motion(stability.modes[0])}."
        )
    if stability.is_passive:
        second = "Passive: no hand can make the device vibrate."
    else:
        second = (
            f"Not passive: {_percent(float(stability.damping_usage.max()))} of the"
            " damping of device and hand would be needed, so that some other hand may"
            " make the device vibrate: lower the coupling's stiffness or damping, or"
            " raise the rate."
        )
    return f"{_describe_nearest_limit(stability)} {second}"


def _describe_nearest_limit(stability: SceneStability) -> str:
    """Returns that the scene is stable, with the nearest limit if there is one."""
    delay_s = calc_force_delay(stability.scene)
    delayed = f"{1e3 * delay_s:.3g} ms of delay" if delay_s > 0.0 else "no added delay"
    held = f"{_describe_grip(stability.scene)} and with {delayed}"
    limits = stability.limits
    nearest = min(limits, key=lambda limit: limit.gain_margin, default=None)
    if nearest is None or math.isinf(nearest.gain_margin):
        return f"Stable {held}."
    here = "in this contact" if stability.num_contacts else "in free space"
    where = (
        f"Stable {held}."
        if nearest.gain_margin >= 1.0
        else f"Stable {here} {held}, but not against {nearest.against}."
    )
    if nearest.gain_margin == 0.0:
        # Another gain is too large there: its limit is the one to know.
        known = [
            limit
            for limit in limits
            if limit.against == nearest.against and 0.0 < limit.gain_margin < 1.0
        ]
        if not known:
            return (
                f"{where} No stiffness of {nearest.kind} is stable there with the"
                " coupling's other gains."
            )
        nearest = min(known, key=lambda limit: limit.gain_margin)
    return (
        f"{where} The limit of the coupling's stiffness of {nearest.kind} is"
        f" {format_limit(nearest.eigenvalue)} {nearest.unit} against {nearest.against};"
        f" the scene has {format_limit(nearest.stiffness)} {nearest.unit}, a margin of"
        f" {nearest.gain_margin:.3g}."
    )


def describe_situation(stability: SceneStability) -> str:
    """Returns a sentence that says what was analyzed."""
    scene, handle = stability.scene, stability.handle
    contacts = stability.num_contacts
    if contacts == 0:
        touch = "the tool touches nothing"
    else:
        push = "contact pushes" if contacts == 1 else "contacts push"
        touch = f"{contacts} {push} the tool with {stability.contact_force_N:.2f} N"
    return (
        f"{scene.device.preset} {_describe_grip(scene)} at {scene.device.rate_hz:g} Hz;"
        f" the hand stops at {stability.time_s:.3f} s of its path, where {touch}."
        " Where it is held,"
        f" device and hand move like {1e3 * handle.mass_kg:.0f} g and"
        f" {handle.inertia_kgm2:.3g} kg·m² at least, and are damped by"
        f" {handle.damping_Ns_per_m:.3g} N·s/m and"
        f" {1e3 * handle.rotational_damping_Nms_per_rad:.3g} mN·m·s/rad at least."
    )


def _describe_grip(scene: Scene) -> str:
    grip = scene.hand.grip
    return "without a hand" if grip == "none" else f"in a {grip} grip"


def describe_restless(stability: SceneStability) -> str:
    """Returns where the tool is pressed harder but does not rest; empty if nowhere."""
    # With an unstable coupling the tool rests nowhere, as the verdict says.
    if not stability.restless_s or not stability.is_stable:
        return ""
    *others, last = (f"{time_s:.2f}" for time_s in sorted(stability.restless_s))
    times = f"{', '.join(others)} and {last} s" if others else f"{last} s"
    return (
        f"At {times} of the path, where the tool is pressed more, it does not come to"
        " rest: it goes from one facet to another and back. A hand that stops there"
        " may feel a small tremor, and the figures of this page do not hold for it."
    )


def describe_delay(stability: SceneStability) -> str:
    """Returns how much later the device's force may come."""
    delay_s = stability.delay_margin_s
    if math.isfinite(delay_s):
        return f"{1e3 * delay_s:.3g} ms"
    return f"more than {LONGEST_DELAY:g} ticks"


def _choose_class(stability: SceneStability) -> str:
    if not stability.is_stable:
        return "bad"
    return "good" if stability.is_passive else "fair"


def _make_limits(stability: SceneStability) -> _Table:
    header = ["", "scene", "margin", "eigenvalue", "simulation", "one axis", "formula"]
    header.append("what limits it")
    rows = []
    for limit in stability.limits:
        name = f"{limit.kind}, {limit.against}, {limit.unit}"
        scene, *found = limit.format_values()
        rows.append([name, scene, _times(limit.gain_margin), *found, limit.limited_by])
    return header, rows


def _make_margins(stability: SceneStability) -> _Table:
    worst = int(stability.damping_usage.argmax())
    rows = [
        ["further delay of the force", describe_delay(stability)],
        [
            "damping that passivity needs, of that of device and hand",
            f"{_percent(float(stability.damping_usage[worst]))} at"
            f" {stability.felt.frequencies_Hz[worst]:.3g} Hz",
        ],
        ["growth of a disturbance in a tick", f"{stability.growth:.6f} times"],
    ]
    return ["", "margin"], rows


def _make_gains(stability: SceneStability) -> _Table:
    coupling, handle = stability.scene.coupling, stability.handle
    stiffness = TRANSLATION.stiffness, ROTATION.stiffness
    damping = TRANSLATION.damping, ROTATION.damping
    mass = TRANSLATION.mass, ROTATION.mass
    rows = [
        ("coupling: stiffness, N/m and N·m/rad", coupling, stiffness),
        ("coupling: damping, N·s/m and N·m·s/rad", coupling, damping),
        ("device and hand: least mass, kg and kg·m²", handle, mass),
        ("device and hand: least damping, N·s/m and N·m·s/rad", handle, damping),
        ("hand: least stiffness, N/m and N·m/rad", handle, stiffness),
    ]
    cells = [
        [what, *(f"{getattr(part, name):.5g}" for name in names)]
        for what, part, names in rows
    ]
    return ["", "translation", "rotation"], cells


def _make_modes(stability: SceneStability) -> _Table:
    rows = [
        [f"{abs(mode.eigenvalue):.6f}", mode.describe()]
        for mode in stability.modes[:_SLOWEST_SHOWN]
    ]
    return ["|z|", f"the slowest {len(rows)} to die out"], rows


def _times(factor: float) -> str:
    return (
        f"{float(f'{factor:.3g}'):.7g} times" if math.isfinite(factor) else "none found"
    )


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"
