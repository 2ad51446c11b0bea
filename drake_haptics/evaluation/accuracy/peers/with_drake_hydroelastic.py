"""Drake's hydroelastic contact: a compliant tool on rigid objects."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    ProximityProperties,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import ContactResults, CoulombFriction, MultibodyPlant
from pydrake.multibody.tree import RigidBody

from drake_haptics.evaluation.accuracy.peers.drake_plant import make_plant
from drake_haptics.evaluation.accuracy.peers.problem import PeerAnswers, PeerProblem
from drake_haptics.evaluation.accuracy.peers.with_drake_point import to_drake_mesh
from drake_haptics.evaluation.measuring.pieces import register_pieces

# Against a rigid object forces are proportional to the modulus: any will do at first.
_MODULUS_PA = 1e6
# Pieces and meshes are exact; this is for round shapes alone, m.
_RESOLUTION_M = 2e-3

_AddTool = Callable[[MultibodyPlant, RigidBody, ProximityProperties], None]


def answer_with_hull(problem: PeerProblem) -> PeerAnswers:
    """Has the tool as a compliant `Mesh`, which Drake fills as its convex hull."""

    def add(plant: MultibodyPlant, body: RigidBody, soft: ProximityProperties) -> None:
        shape = to_drake_mesh(problem.tool)
        plant.RegisterCollisionGeometry(body, RigidTransform(), shape, "tool", soft)

    return _answer(problem, add)


def answer_with_pieces(problem: PeerProblem) -> PeerAnswers:
    """Has the tool's pieces compliant, each by itself."""

    def add(plant: MultibodyPlant, body: RigidBody, soft: ProximityProperties) -> None:
        register_pieces(plant, body, RigidTransform(), problem.tool, soft)

    return _answer(problem, add)


def _answer(problem: PeerProblem, add_tool: _AddTool) -> PeerAnswers:
    """Takes the plant's hydroelastic forces; there is no distance.

    No modulus is the scene's stiffness: it is the one whose forces are nearest to the
    reference's, in least squares over the whole motion.
    """
    rigid, soft = _make_surface(), _make_surface()
    AddRigidHydroelasticProperties(_RESOLUTION_M, rigid)
    AddCompliantHydroelasticProperties(_RESOLUTION_M, _MODULUS_PA, soft)

    def add(
        plant: MultibodyPlant, body: RigidBody, which: int, X_BM: RigidTransform
    ) -> None:
        if which < 0:
            add_tool(plant, body, soft)
        else:
            shape = to_drake_mesh(problem.objects[which])
            plant.RegisterCollisionGeometry(body, X_BM, shape, f"mesh_{which}", rigid)

    drake = make_plant("hydroelastic", problem.part.X_WO, add)
    motion = problem.motion
    own = set(drake.plant.GetCollisionGeometriesForBody(drake.tool))
    F_Tool_W = np.zeros((len(motion), 6))

    def read(tick: int, results: ContactResults) -> None:
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            surface, F_Ac_W = info.contact_surface(), info.F_Ac_W()
            # The force is the one on M, at the surface's centroid.
            sign = 1 if surface.id_M() in own else -1
            force = sign * F_Ac_W.translational()
            arm = surface.centroid() - motion.X_WTool[tick, 4:]
            torque = sign * F_Ac_W.rotational() + np.cross(arm, force)
            F_Tool_W[tick] += np.concatenate([torque, force])

    port = drake.plant.get_contact_results_output_port()
    seconds = drake.ask(motion, port, lambda results: results, read)
    scale = _fit(F_Tool_W[:, 3:], problem.f_W)
    return PeerAnswers(
        scale * F_Tool_W,
        np.full(len(motion), np.nan),
        0.0,
        seconds,
        f"with {scale * _MODULUS_PA:.1e} Pa, which fits best",
    )


def _make_surface() -> ProximityProperties:
    """Returns a surface without friction and damping."""
    surface = ProximityProperties()
    AddContactMaterial(
        dissipation=0.0, friction=CoulombFriction(0.0, 0.0), properties=surface
    )
    return surface


def _fit(f_W: np.ndarray, wanted_W: np.ndarray) -> float:
    """Returns the factor that brings forces nearest to others; 1 where there are none.

    Raises:
        ValueError: None above zero does.
    """
    if not f_W.any():
        return 1.0
    scale = float((f_W * wanted_W).sum() / (f_W**2).sum())
    if scale <= 0.0:
        raise ValueError("its forces point against the reference's on the whole")
    return scale
