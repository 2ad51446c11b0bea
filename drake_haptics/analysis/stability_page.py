"""Writes a scene's stability as one page that any browser shows."""

from __future__ import annotations

import base64
import html
import io
import math
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path
from string import Template

from drake_haptics.analysis.delay_margin import LONGEST_DELAY
from drake_haptics.analysis.scene_stability import SceneStability

_SLOWEST_SHOWN = 12
_DPI = 110
_LONGEST_NUMBER = 20


def write_stability_page(stability: SceneStability, name: str, path: Path) -> None:
    """Writes the page as one HTML file, and its picture beside it as PNG.

    Args:
        stability: What `analyse_scene` returned.
        name: Of the scene.
        path: Of the HTML file; the picture has the suffix `.png` instead.

    Raises:
        OSError: A file cannot be written.
    """
    picture = io.BytesIO()
    stability.plot().savefig(picture, format="png", dpi=_DPI)
    path.with_suffix(".png").write_bytes(picture.getvalue())
    template = files("drake_haptics.analysis").joinpath("stability_page.html")
    page = Template(template.read_text(encoding="utf-8")).substitute(
        name=html.escape(name),
        description=html.escape(stability.scene.description),
        verdict=html.escape(describe_verdict(stability)),
        verdict_class=_choose_class(stability),
        situation=html.escape(describe_situation(stability)),
        sheet=base64.b64encode(picture.getvalue()).decode(),
        limits=_make_limits(stability),
        margins=_make_margins(stability),
        modes=_make_modes(stability),
        warnings=_make_warnings(stability),
    )
    path.write_text(page, encoding="utf-8")


def describe_verdict(stability: SceneStability) -> str:
    """Says in a sentence or two whether the scene is stable and passive."""
    if not stability.is_stable:
        return (
            f"Unstable: a disturbance grows by {_percent(stability.growth - 1.0)} in"
            f" each tick. {stability.modes[0].describe()}"
        )
    room = min((limit.gain_margin for limit in stability.limits), default=math.inf)
    first = "Stable"
    if math.isfinite(room):
        first += f"; the coupling could be {room:.3g} times as stiff"
    if stability.is_passive:
        return f"{first}. Passive: no hand can be driven into vibration."
    return (
        f"{first}. Not passive: {_percent(float(stability.damping_usage.max()))} of the"
        " damping of device and hand would be needed, so that some other hand may"
        " be driven into vibration."
    )


def describe_situation(stability: SceneStability) -> str:
    """Says what was analysed."""
    scene, handle = stability.scene, stability.handle
    contacts = stability.num_contacts
    return (
        f"{scene.device.preset} in a {scene.hand.grip} grip at"
        f" {scene.device.rate_hz:g} Hz; the hand stops at {stability.time_s:.3f} s of"
        f" its path, where {contacts} contact{'' if contacts == 1 else 's'} push"
        f"{'es' if contacts == 1 else ''} the tool with"
        f" {stability.contact_force_N:.2f} N. Where it is held, device and hand move"
        f" like {1e3 * handle.mass_kg:.0f} g and {1e6 * handle.inertia_kgm2:.0f} kg·mm²"
        f" at least, and are damped by {handle.damping_Ns_per_m:.3g} N·s/m and"
        f" {1e3 * handle.rotational_damping_Nms_per_rad:.3g} mN·m·s/rad at least."
    )


def describe_delay(stability: SceneStability) -> str:
    """Says how much later the device's force may come."""
    delay_s = stability.delay_margin_s
    if math.isfinite(delay_s):
        return f"{1e3 * delay_s:.3g} ms"
    return f"more than {LONGEST_DELAY:g} ticks"


def _choose_class(stability: SceneStability) -> str:
    if not stability.is_stable:
        return "bad"
    return "good" if stability.is_passive else "fair"


def _make_limits(stability: SceneStability) -> str:
    header = [
        "",
        "scene",
        "eigenvalue",
        "simulation",
        "one axis",
        "formula",
        "what limits it",
    ]
    rows = [
        [
            f"{limit.kind} against {limit.against}, {limit.unit}",
            _number(limit.stiffness),
            _number(limit.eigenvalue),
            _number(limit.simulated),
            _number(limit.one_axis),
            _number(limit.formula),
            limit.limited_by,
        ]
        for limit in stability.limits
    ]
    return _make_table(header, rows)


def _make_margins(stability: SceneStability) -> str:
    rows = [
        [
            f"stiffness of {limit.kind} against {limit.against}",
            _times(limit.gain_margin),
        ]
        for limit in stability.limits
    ]
    rows.append(["further delay", describe_delay(stability)])
    usage = float(stability.damping_usage.max())
    rows.append(["damping that passivity needs, of what there is", _percent(usage)])
    rows.append(["growth per tick", f"{stability.growth:.6f}"])
    return _make_table(["", "margin"], rows)


def _make_modes(stability: SceneStability) -> str:
    rows = [
        [f"{abs(mode.eigenvalue):.6f}", mode.describe()]
        for mode in stability.modes[:_SLOWEST_SHOWN]
    ]
    return _make_table(["|z|", f"the slowest {len(rows)} to die out"], rows)


def _make_warnings(stability: SceneStability) -> str:
    if not stability.broken_bounds:
        return ""
    items = "".join(f"<li>{html.escape(s)}</li>" for s in stability.broken_bounds)
    return f"<h2>Bounds that the coupling breaks</h2><ul>{items}</ul>"


def _make_table(header: list[str], rows: Iterable[list[str]]) -> str:
    """Returns a table."""
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    body = "".join(f"<tr>{''.join(map(_make_cell, row))}</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def _make_cell(text: str) -> str:
    """Returns a cell; long ones are words, which do not line up like numbers."""
    kind = ' class="words"' if len(text) > _LONGEST_NUMBER else ""
    return f"<td{kind}>{html.escape(text)}</td>"


def _number(value: float) -> str:
    if math.isnan(value):
        return "not seen"
    return f"{value:.5g}" if math.isfinite(value) else "no limit found"


def _times(factor: float) -> str:
    return f"{factor:.3g} times" if math.isfinite(factor) else "no limit found"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"
