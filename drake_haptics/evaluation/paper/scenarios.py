"""Makes the scenarios of Figure 11, and others with the largest models of Table 1."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import cycle
from pathlib import Path

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

from drake_haptics.evaluation.models import (
    MODELS,
    OWN,
    cut_shape,
    find_sources,
    load_machine_room,
    load_model,
    wrench_path,
)
from drake_haptics.evaluation.paper.exploration import Place, Scenario, plan_exploration
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.scene.schema import ContactParameters
from drake_haptics.systems.contact.contact_query import ContactObject

# Aims of the hand beyond first touch, m, in turn: off, lightly, firmly, and so on.
_PRESSES_M = 1e-3 * np.array([-4, 0.5, 1, 5, 8, 6, 1, 0.5, 6, 8, 0.5])
_REACH_M = 0.3
# The real cup and spoon in the frames of the package's shapes: the cup stands at the
# origin, the spoon lies along +x from its tip, its bowl open to +z.
_X_OF_REAL = {
    "Cup": RigidTransform([0.0, 0.0, 0.0302]),
    "Spoon": RigidTransform(
        RotationMatrix(np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])),
        [0.151, 0.0, 0.0],
    ),
}


def scenario_makers(meshes: Path | None) -> dict[str, Callable[[], Scenario]]:
    """Returns scenario name -> a function that makes it, those of Figure 11 first.

    Cup and spoon, the digestive system and the armadillo are also explored if the
    folder has real meshes of them.
    """
    makers: dict[str, Callable[[], Scenario]] = {
        "spoon in cup": partial(_make_cup_spoon, None, "spoon in cup", "11-(a)"),
        "probe on organ": partial(
            _make_probe, "Digestive System", OWN, None, "probe on organ", "11-(b)"
        ),
        "wrench in machine room": _make_machine_room,
    }
    real = {
        model: file
        for model in MODELS
        for file in find_sources(model, meshes)
        if file != OWN
    }
    if {"Cup", "Spoon"} <= real.keys():
        name = "spoon in cup, real meshes"
        makers[name] = partial(_make_cup_spoon, meshes, name, "11-(a)")
    for model, name in (
        ("Digestive System", "probe on digestive system, real mesh"),
        ("Armadillo", "probe on armadillo, real mesh"),
    ):
        if model in real:
            figure = "11-(b)" if model == "Digestive System" else ""
            makers[name] = partial(
                _make_probe, model, real[model], meshes, name, figure
            )
    return makers


def _soft_contact(tolerance_m: float, stiffness_N_per_m: float) -> ContactParameters:
    """Returns contact with the paper's clustering, which a few newtons penetrate."""
    return ContactParameters(
        tolerance_m=tolerance_m,
        stiffness_N_per_m=stiffness_N_per_m,
        damping_Ns_per_m=1.0,
        clustering="octree",
        cluster_size_m=8e-3,
    )


def _make_cup_spoon(meshes: Path | None, name: str, figure: str) -> Scenario:
    """Makes a spoon go down into the cup, around its wall and across its floor."""
    if meshes is None:
        cup, spoon = cut_shape("cup"), cut_shape("spoon")
    else:
        cup, spoon = (
            decompose(_move(load_model(model, MODELS[model].file, meshes), X_OM))
            for model, X_OM in _X_OF_REAL.items()
        )
    objects = (ContactObject("cup", cup.core, RigidTransform()),)
    places = []
    press = cycle(_PRESSES_M)
    for turn in np.linspace(0.0, 2.0 * np.pi, 33):
        # The bowl's edge is at the wall, and the handle leans to the other side.
        yaw = RotationMatrix.MakeZRotation(turn)
        lean = np.deg2rad(-80.0 + 10.0 * np.sin(2.0 * turn))
        R_WT = yaw @ RotationMatrix.MakeYRotation(lean)
        start_W = np.array([0.0, 0.0, 0.022 + 0.006 * np.cos(3.0 * turn)])
        toward_W = yaw @ np.array([-1.0, 0.0, 0.0])
        places.append(Place(RigidTransform(R_WT, start_W), toward_W, next(press)))
    R_WT = RotationMatrix(RollPitchYaw(0.0, np.deg2rad(-70.0), 0.0))
    for x in np.linspace(-0.008, 0.002, 6):
        start = RigidTransform(R_WT, [x, 0.0, 0.04])
        places.append(Place(start, np.array([0.0, 0.0, -1.0]), next(press)))
    return Scenario(
        name=name,
        figure=figure,
        tool=spoon,
        mass_kg=0.05,
        p_TH=np.array([0.07, 0.0, 0.0]),
        objects=objects,
        path=plan_exploration(spoon, objects, places, _REACH_M),
        contact=_soft_contact(2e-3, 750.0),
    )


def _make_probe(
    model: str, source: str, meshes: Path | None, name: str, figure: str
) -> Scenario:
    """Makes a convex probe go over the front of a model, upright and nearly flat."""
    # Round and convex, 24 mm thick.
    probe, mesh = cut_shape("peg"), load_model(model, source, meshes)
    target = decompose(mesh)
    objects = (ContactObject("target", target.core, RigidTransform()),)
    places = []
    press = cycle(_PRESSES_M)
    for k, p_WQ in enumerate(_find_front(mesh)):
        # Its end leans to -y out of the model and up, by varying amounts.
        lean = np.deg2rad(55.0 - 25.0 * np.cos(0.25 * k))
        end_W = np.array([0.0, -np.cos(lean), np.sin(lean)])
        R_WT = RotationMatrix.MakeFromOneVector(end_W, axis_index=2)
        start = RigidTransform(R_WT, p_WQ - [0.0, 0.12, 0.0])
        places.append(Place(start, np.array([0.0, 1.0, 0.0]), next(press)))
    return Scenario(
        name=name,
        figure=figure,
        tool=probe,
        mass_kg=0.05,
        p_TH=np.array([0.0, 0.0, 0.06]),
        objects=objects,
        path=plan_exploration(probe, objects, places, _REACH_M),
        contact=_soft_contact(2e-3, 750.0),
    )


def _find_front(mesh: Mesh) -> Iterator[np.ndarray]:
    """Yields the foremost vertices (-y) near a line that goes back and forth."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2
    for row, z in enumerate(np.linspace(0.35, -0.35, 5)):
        for x in np.linspace(-0.4, 0.4, 13)[:: -1 if row % 2 else 1]:
            at = middle[[0, 2]] + half[[0, 2]] * [x, z]
            aside = np.linalg.norm(mesh.vertices[:, [0, 2]] - at, axis=1)
            near = mesh.vertices[aside < max(8e-3, aside.min() + 1e-6)]
            yield near[near[:, 1].argmin()]


def _make_machine_room() -> Scenario:
    """Makes the wrench's flat go over the tubes of the panel, up and down, rocking."""
    objects = tuple(
        ContactObject(name, pieces.core, RigidTransform(X_WO))
        for name, pieces, X_WO in load_machine_room()
    )
    wrench = cut_shape("wrench")
    low, high = (RigidTransform(X) for X in wrench_path(2))
    places = []
    press = cycle(_PRESSES_M)
    for k, share in enumerate(0.5 - 0.5 * np.cos(np.linspace(0.0, 4 * np.pi, 45))):
        rock = RotationMatrix.MakeZRotation(0.01 * np.sin(0.9 * k))
        p_WT = (1.0 - share) * low.translation() + share * high.translation()
        start = RigidTransform(rock @ low.rotation(), p_WT)
        places.append(Place(start, np.array([0.0, 1.0, 0.0]), next(press)))
    return Scenario(
        name="wrench in machine room",
        figure="11-(c)",
        tool=wrench,
        mass_kg=0.2,
        p_TH=np.zeros(3),
        objects=objects,
        path=plan_exploration(wrench, objects, places, _REACH_M),
        contact=_soft_contact(1e-3, 250.0),
    )


def _move(mesh: Mesh, X_OM: RigidTransform) -> Mesh:
    vertices = mesh.vertices @ X_OM.rotation().matrix().T + X_OM.translation()
    return Mesh.from_arrays(vertices, mesh.triangles, name=mesh.report.source)
