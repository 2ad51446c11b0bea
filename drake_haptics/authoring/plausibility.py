"""Warns about scenes that run but are probably not intended."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.common.one_line import count
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.mesh.checks import (
    LARGEST_USUAL_EXTENT_M,
    SMALLEST_USUAL_EXTENT_M,
    make_tolerance_warnings,
)
from drake_haptics.geometry.mesh.placement import (
    describe_origin_beside,
    find_origin_beside,
)
from drake_haptics.geometry.mesh.report import Severity, length
from drake_haptics.geometry.mesh.topology import winding_numbers
from drake_haptics.geometry.mesh.units import METERS_PER_UNIT, guess_unit
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.loop.clearance import (
    find_clearance,
    fit_skin,
    round_down,
    sample_path,
)
from drake_haptics.loop.contact import find_skins
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.contact_law import calc_first_touch, is_constraint
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import EnvironmentObject, Tool
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery

# Largest extent of a tool, which is held in one hand.
_LARGEST_USUAL_TOOL_M = 1.0
# Largest number of the tool's vertices that are checked.
_VERTICES = 16


def check_plausibility(haptic: HapticDiagram) -> list[str]:
    """Returns a sentence for each thing in a scene that is probably not intended."""
    return [
        *_make_size_warnings(haptic),
        *_make_open_mesh_warnings(haptic),
        *_make_decimation_warnings(haptic),
        *make_tolerance_warnings(
            calc_first_touch(haptic.scene.contact),
            "the tool",
            max(haptic.tool.mesh.report.extent),
        ),
        *_make_clearance_warnings(haptic),
        *_make_origin_warnings(haptic),
        *_make_reach_warnings(haptic),
        *_make_device_warnings(haptic),
        *make_start_warnings(haptic),
    ]


def _list_objects(
    haptic: HapticDiagram,
) -> list[tuple[EnvironmentObject, Decomposition, RigidTransform]]:
    """Returns description, pieces and pose of each object."""
    return [
        (item, part, item.pose.to_rigid_transform())
        for item, part in zip(haptic.scene.environment, haptic.environment, strict=True)
    ]


def _list_parts(
    haptic: HapticDiagram,
) -> list[tuple[str, Tool | EnvironmentObject, Decomposition]]:
    """Returns key, description and pieces of the tool, then of the objects."""
    return [
        ("tool", haptic.scene.tool, haptic.tool),
        *(
            (f"environment[{i}]", item, part)
            for i, (item, part, _) in enumerate(_list_objects(haptic))
        ),
    ]


def _make_size_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about meshes that are probably in another unit."""
    sentences = []
    for key, item, part in _list_parts(haptic):
        largest_m = _LARGEST_USUAL_TOOL_M if key == "tool" else LARGEST_USUAL_EXTENT_M
        extent_m = max(part.mesh.report.extent)
        if not SMALLEST_USUAL_EXTENT_M <= extent_m <= largest_m:
            size = f"{key}: {Path(item.mesh).name} is {length(extent_m)} wide"
            unit = guess_unit(extent_m / item.scale, SMALLEST_USUAL_EXTENT_M, largest_m)
            sentences.append(
                f"{size}; is its scale ({item.scale:g}) right?"
                if unit is None
                else f"{size}; if the file is in {unit}:"
                f" {key}.scale: {METERS_PER_UNIT[unit]:g}"
            )
    return sentences


def _make_open_mesh_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about open meshes that are probably meant to be solids."""
    return [
        f"{key}: {Path(item.mesh).name} is open: {report.one_sided_triangles:,} of"
        f" {count(report.triangles, 'triangle')} bound no solid, so that a tool can get"
        " behind them, and their pieces are many and flat; drake-haptics check lists"
        " the holes"
        for key, item, part in _list_parts(haptic)
        if (report := part.mesh.report).one_sided_triangles
    ]


def _make_decimation_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about meshes that have lost their shape by decimation."""
    touch_m = calc_first_touch(haptic.scene.contact)
    return [
        f"{key}: {Path(item.mesh).name} is {finding.message}: {finding.action}"
        for key, item, part in _list_parts(haptic)
        for finding in part.mesh.report.findings
        if finding.code == "decimated"
        and finding.severity is Severity.QUESTION
        and part.mesh.report.decimation_error_m > touch_m
    ]


def _make_clearance_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about a tolerance or skin wider than the tool's clearance.

    The tool is moved along the path of the scene's hand, even with a real device.
    """
    scene, tool = haptic.scene, haptic.tool.core
    objects = [(part.core, X_WO) for _, part, X_WO in _list_objects(haptic)]
    materials = [item.material for item in scene.environment]
    keys = ["contact.tolerance_m"] * len(objects)
    kept_m = [scene.contact.tolerance_m] * len(objects)
    if is_constraint(scene.contact):
        kept_m = find_skins(fit_skin(scene, tool, objects), materials)
        keys = [
            "contact.skin_m"
            if material.skin_m is None
            else f"environment[{i}].material.skin_m"
            for i, material in enumerate(materials)
        ]
    found = find_clearance(tool, objects, sample_path(scene.hand.path), kept_m)
    if found is None:
        return []
    names = " and ".join(f"'{scene.environment[i].name}'" for i in found.objects)
    wide = dict.fromkeys((keys[i], kept_m[i]) for i in found.objects)
    are = " and ".join(f"{key}: is {length(kept)}" for key, kept in wide)
    left = " and ".join(length(found.share * kept) for _, kept in wide)
    fits = ", ".join(
        f"{key}: {round_down(found.share * kept):.2g}" for key, kept in wide
    )
    return [
        f"{are}, but on the hand's path {names}"
        f" {'leaves' if len(found.objects) == 1 else 'leave'} the tool"
        f" {left} on each side: it is pushed from all sides at once"
        f" and may not go in; {fits} fits"
    ]


def _make_origin_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about a tool whose mesh is far from its origin.

    The coupling pulls at the origin: far from the hand its force mostly turns the
    handle, and the apparent mass there is small.
    """
    beside_m = find_origin_beside(haptic.tool.mesh)
    if beside_m is None:
        return []
    return [
        f"tool: {describe_origin_beside(Path(haptic.scene.tool.mesh).name, beside_m)},"
        " and the coupling pulls there: force on the hand becomes torque, and may"
        " shake;"
        " tool.center: true moves the middle of the mesh to the origin (tool.grasp and"
        " hand.path are then those of the middle)"
    ]


def _make_reach_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns a sentence if no object is within reach."""
    if haptic.backend is None:
        where = "where the hand's path leads the tool"
        p_WT, radius_m = _sample_tool_box(haptic), 0.0
    else:
        where = "where the device's workspace lets the tool go"
        p_WT, radius_m = _find_workspace(haptic)
    gaps_m = [_calc_gap(p_WT, X_WO, part) for _, part, X_WO in _list_objects(haptic)]
    gap_m = min(gaps_m) - radius_m
    if gap_m <= calc_first_touch(haptic.scene.contact):
        return []
    return [
        f"no object is within reach {where}; the nearest is {length(gap_m)} away:"
        " nothing will be felt. Is environment[...].pose, a scale or"
        " hand.path.waypoints as meant?"
    ]


def _sample_tool_box(haptic: HapticDiagram) -> np.ndarray:
    """Returns corners of the tool's box along the hand's path, (n, 8, 3), m."""
    box = zip(*_find_box(haptic.tool.mesh.vertices), strict=True)
    corners = np.array(np.meshgrid(*box)).reshape(3, -1)
    places = sample_path(haptic.scene.hand.path)
    return np.array([(X_WT @ corners).T for X_WT in places])


def _find_workspace(haptic: HapticDiagram) -> tuple[np.ndarray, float]:
    """Returns the middle of the workspace, (1, 1, 3), and the reach of the tool, m."""
    scene = haptic.scene
    site = find_device_site(scene)
    center = load_device_preset(scene.device.preset).workspace_center_m
    X_HT = scene.tool.grasp.to_rigid_transform()
    p_HTv = haptic.tool.mesh.vertices @ X_HT.rotation().matrix().T + X_HT.translation()
    reach_m = site.workspace_radius_m + np.linalg.norm(p_HTv, axis=1).max()
    return (site.X_WB @ np.array(center)).reshape(1, 1, 3), float(reach_m)


def _calc_gap(p_WT: np.ndarray, X_WO: RigidTransform, part: Decomposition) -> float:
    """Returns the least gap between boxes of points and an object's box, m.

    Args:
        p_WT: (n, k, 3) points; every k of them have a box along the object's axes.
        X_WO: Pose of the object.
        part: Pieces of the object's mesh.
    """
    low, high = _find_box(part.mesh.vertices)
    R_OW = X_WO.rotation().matrix().T
    p_OT = (p_WT - X_WO.translation()) @ R_OW.T
    apart = np.maximum(p_OT.min(axis=1) - high, low - p_OT.max(axis=1))
    return float(np.linalg.norm(np.maximum(apart, 0.0), axis=1).min())


def _find_box(vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return vertices.min(axis=0), vertices.max(axis=0)


def _make_device_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about a device that probably is not the scene's preset."""
    device, backend = haptic.scene.device, haptic.backend
    preset = load_device_preset(device.preset)
    sentences = []
    for key, unit in [("max_force_N", "N"), ("max_torque_Nm", "N·m")]:
        asked, rated = getattr(device, key), getattr(preset, key)
        if asked is not None and asked > rated:
            sentences.append(
                f"device.{key} is {asked:g}: more than the {rated:g} {unit} that"
                f" '{device.preset}' is rated for"
            )
    if backend is None or (reading := backend.read()) is None:
        return sentences
    if haptic.scene.device.base is None and not backend.is_placed:
        return sentences
    away_m = float(
        np.linalg.norm(reading.X_BH[4:] - np.array(preset.workspace_center_m))
    )
    if away_m > preset.workspace_radius_m:
        sentences.append(
            f"the handle is {length(away_m)} from the middle of the workspace of"
            f" '{device.preset}', whose radius is {length(preset.workspace_radius_m)}:"
            " is that the device? device.preset names it, device.base says where it"
            " stands"
        )
    return sentences


def make_start_warnings(haptic: HapticDiagram) -> list[str]:
    """Returns sentences about objects inside which the tool starts.

    Args:
        haptic: Diagram of the scene; a device's handle is taken at its present pose.
    """
    scene = haptic.scene
    if haptic.backend is None:
        X_WT = make_hand_path(scene.hand.path).start
        # The scene's hand may begin pressed, but not with all the force of its device.
        max_force_N = find_device_site(scene).max_force_N
        allowed_m = max_force_N / scene.contact.stiffness_N_per_m
        remedy = "move hand.path.waypoints[0] to a place beside it"
    else:
        reading = haptic.backend.read()
        if reading is None:
            return []
        X_WH = haptic.X_WB @ vector_to_pose(reading.X_BH)
        X_WT = X_WH @ scene.tool.grasp.to_rigid_transform()
        allowed_m = scene.contact.tolerance_m
        remedy = "lead the device's handle to a place beside it and start again"
    if is_constraint(scene.contact):
        allowed_m = 0.0
    depths_m = _calc_depths(haptic, X_WT)
    sentences = []
    for (item, part, X_WO), depth_m in zip(
        _list_objects(haptic), depths_m, strict=True
    ):
        if depth_m > allowed_m:
            how = f"{length(depth_m)} deep in '{item.name}'"
        elif _is_inside(haptic.tool, part, X_WO.inverse() @ X_WT):
            how = f"inside '{item.name}', and no contact leads it out"
        else:
            continue
        sentences.append(f"the tool starts {how}: {remedy}")
    return sentences


def _calc_depths(haptic: HapticDiagram, X_WT: RigidTransform) -> list[float]:
    """Returns how deep the tool is in each object, m; 0 without a contact.

    The query of the diagram is evaluated in a new Context, so that the depth is the one
    with which the run begins; under the constraint law a similar query is made.
    """
    penalty = haptic.loop.penalty
    query = _make_query(haptic) if penalty is None else penalty.contact_query
    context = query.CreateDefaultContext()
    query.GetInputPort("X_WT").FixValue(context, pose_to_vector(X_WT))
    if query.HasInputPort("load_shedding"):
        query.GetInputPort("load_shedding").FixValue(context, np.ones(3))
    contacts = query.GetOutputPort("contacts").Eval(context)
    depths_m = np.zeros(len(haptic.environment))
    np.maximum.at(depths_m, contacts.object_index, -contacts.distance)
    return depths_m.tolist()


def _make_query(haptic: HapticDiagram) -> ContactQuery:
    """Returns a query of a scene's tool and objects."""
    objects = [
        ContactObject(item.name, part.core, X_WO)
        for item, part, X_WO in _list_objects(haptic)
    ]
    return ContactQuery(haptic.tool.core, objects, 0.0)


def _is_inside(tool: Decomposition, part: Decomposition, X_OT: RigidTransform) -> bool:
    """Returns whether the whole tool is in the solid, far from its surface."""
    solid = part.mesh.triangles[part.mesh.solid.astype(bool)]
    step = max(1, len(tool.mesh.vertices) // _VERTICES)
    p_TV = tool.mesh.vertices[::step]
    p_OV = p_TV @ X_OT.rotation().matrix().T + X_OT.translation()
    low, high = _find_box(part.mesh.vertices)
    if not len(solid) or not np.all((p_OV > low) & (p_OV < high)):
        return False
    return bool(np.all(winding_numbers(p_OV, part.mesh.vertices, solid) > 0.5))
