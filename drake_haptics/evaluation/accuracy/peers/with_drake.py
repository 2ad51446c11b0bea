"""Answers with Drake: signed distances, point contact and hydroelastic contact."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    GeometryId,
    ProximityProperties,
    SceneGraph,
    SignedDistancePair,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    ContactResults,
    CoulombFriction,
    MultibodyPlant,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import RigidBody, SpatialInertia
from pydrake.systems.framework import Context, DiagramBuilder, OutputPort

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.peers.problem import (
    PASSES,
    FoundContacts,
    PeerAnswers,
    PeerProblem,
    apply_law,
)
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.measuring.pieces import (
    make_surface,
    quiet_streams,
    register_mesh,
    register_pieces,
)
from drake_haptics.evaluation.measuring.timing import typical
from drake_haptics.geometry.decomposition.decompose import Decomposition

# Inertia of a tool whose motion is given, which does not matter.
_MASS_KG, _RADIUS_M = 0.1, 0.1
# Forces on a rigid object are proportional to the modulus, so it is fitted afterwards.
_MODULUS_PA = 1e6
# For round shapes only, m; pieces and meshes are exact.
_RESOLUTION_M = 2e-3
Register = Callable[
    [MultibodyPlant, RigidBody, RigidTransform, Decomposition, ProximityProperties],
    None,
]


class Shapes(NamedTuple):
    """Geometry of a body: what registers its shapes, and their surface."""

    register: Register
    surface: ProximityProperties


@dataclass(frozen=True)
class DrakePlant:
    """A continuous plant, whose contacts depend only on pose and velocity.

    Attributes:
        plant: Finalized plant.
        scene_graph: Scene graph with its geometry.
        tool: Body of the tool in the plant.
        root: Context of the diagram.
    """

    plant: MultibodyPlant
    scene_graph: SceneGraph
    tool: RigidBody
    root: Context

    def ask(
        self,
        motion: RecordedMotion,
        port: OutputPort,
        ask: Callable[[Any], Any],
        read: Callable[[int, Any], None],
    ) -> np.ndarray:
        """Moves the tool as recorded and evaluates a port at each tick.

        Args:
            motion: Motion of the tool.
            port: Port that is evaluated at each tick.
            ask: Function of the port's value that returns the answer.
            read: Function that is called with each tick and its answer.

        Returns:
            (n,) times of evaluating and answering, s, including the update of poses.
        """
        context = self.plant.GetMyMutableContextFromRoot(self.root)
        of_port = port.get_system().GetMyContextFromRoot(self.root)
        states = np.hstack([motion.X_WT, motion.V_WT])
        seconds = np.zeros((PASSES, len(motion)))
        for i, one_pass in enumerate(seconds):
            for k, state in enumerate(states):
                self.plant.SetPositionsAndVelocities(context, state)
                start = time.perf_counter()
                answer = ask(port.Eval(of_port))
                one_pass[k] = time.perf_counter() - start
                if i == 0:
                    read(k, answer)
        return typical(seconds)


def make_plant(
    problem: PeerProblem, contact_model: str, tool: Shapes, objects: Shapes
) -> DrakePlant:
    """Builds a plant with a tool and objects.

    Args:
        problem: Problem with the shapes, and the poses of the objects.
        contact_model: Name of the contact model, see `MultibodyPlantConfig`.
        tool: Geometry of the tool.
        objects: Geometry of the objects.
    """
    builder = DiagramBuilder()
    config = MultibodyPlantConfig(time_step=0.0, contact_model=contact_model)
    inertia = SpatialInertia.SolidSphereWithMass(_MASS_KG, _RADIUS_M)
    # Qhull warns of flat pieces.
    with quiet_streams(2):
        plant, scene_graph = AddMultibodyPlant(config, builder)
        body = plant.AddRigidBody("tool", inertia)
        tool.register(plant, body, RigidTransform(), problem.tool, tool.surface)
        for part, pose in zip(problem.objects, problem.part.X_WO, strict=True):
            X_WO, world = vector_to_pose(pose), plant.world_body()
            objects.register(plant, world, X_WO, part, objects.surface)
        plant.Finalize()
        context = builder.Build().CreateDefaultContext()
    return DrakePlant(plant, scene_graph, body, context)


def answer_on_pieces(problem: PeerProblem) -> PeerAnswers:
    """Returns the plant's forces on the same pieces."""
    return _read_forces(problem, register_pieces)


def answer_on_meshes(problem: PeerProblem) -> PeerAnswers:
    """Returns the plant's forces on `Mesh` shapes, of which it uses the hulls."""
    return _read_forces(problem, register_mesh)


def answer_by_distances(problem: PeerProblem) -> PeerAnswers:
    """Answers by signed distances of the same pieces within the tolerance."""
    drake = _make_point_plant(problem, register_pieces)
    owners = _find_owners(problem, drake)
    start = [0]
    rows: list[np.ndarray] = []

    def read(tick: int, pairs: list[SignedDistancePair]) -> None:
        X_WT = vector_to_pose(problem.motion.X_WT[tick])
        rows.extend(_to_row(pair, X_WT, owners) for pair in pairs)
        start.append(len(rows))

    seconds = drake.ask(
        problem.motion,
        drake.scene_graph.get_query_output_port(),
        lambda query: query.ComputeSignedDistancePairwiseClosestPoints(
            problem.tolerance_m
        ),
        read,
    )
    columns = np.array(rows).reshape(-1, 11)
    found = FoundContacts(np.array(start), columns, seconds)
    return apply_law(problem, found)


def _make_point_plant(problem: PeerProblem, register: Register) -> DrakePlant:
    """Builds a plant whose point contact has the scene's gains.

    Raises:
        ValueError: The tool would need a different surface for each object.
    """
    stiffness, damping = problem.part.stiffness_N_per_m, problem.part.damping_Ns_per_m
    if np.ptp(stiffness) > 0.0 or np.ptp(damping) > 0.0:
        raise ValueError("the objects differ in stiffness or damping")
    springs = Shapes(register, make_surface(float(stiffness[0]), float(damping[0])))
    return make_plant(problem, "point", springs, springs)


def _read_forces(problem: PeerProblem, register: Register) -> PeerAnswers:
    """Sums the forces of the plant's point contacts at the tool's origin."""
    drake = _make_point_plant(problem, register)
    motion, tool = problem.motion, drake.tool.index()
    F_To_W = np.zeros((len(motion), 6))
    distance = np.full(len(motion), np.inf)

    def read(tick: int, results: ContactResults) -> None:
        for i in range(results.num_point_pair_contacts()):
            info = results.point_pair_contact_info(i)
            # The force is the one on B, at C.
            force = info.contact_force() * (1 if info.bodyB_index() == tool else -1)
            arm = info.contact_point() - motion.X_WT[tick, 4:]
            F_To_W[tick] += np.concatenate([np.cross(arm, force), force])
            distance[tick] = min(distance[tick], -info.point_pair().depth)

    port = drake.plant.get_contact_results_output_port()
    seconds = drake.ask(motion, port, lambda results: results, read)
    return PeerAnswers(F_To_W, distance, 0.0, seconds)


def _find_owners(
    problem: PeerProblem, drake: DrakePlant
) -> dict[GeometryId, tuple[int, RigidTransform]]:
    """Returns the object (or -1) of each piece, and the piece's pose in the body."""
    inspector = drake.scene_graph.model_inspector()
    owners = {
        piece: (-1, inspector.GetPoseInFrame(piece))
        for piece in drake.plant.GetCollisionGeometriesForBody(drake.tool)
    }
    anchored = iter(drake.plant.GetCollisionGeometriesForBody(drake.plant.world_body()))
    # Geometries are in the order in which they were added.
    for i, part in enumerate(problem.objects):
        for _ in part.pieces:
            piece = next(anchored)
            owners[piece] = (i, inspector.GetPoseInFrame(piece))
    return owners


def _to_row(
    pair: SignedDistancePair,
    X_WT: RigidTransform,
    owners: dict[GeometryId, tuple[int, RigidTransform]],
) -> np.ndarray:
    """Returns distance, normal out of the object, both points, and the object."""
    points = {}
    for piece, p in ((pair.id_A, pair.p_ACa), (pair.id_B, pair.p_BCb)):
        owner, X_BP = owners[piece]
        points[owner] = (X_WT @ X_BP if owner < 0 else X_BP) @ p
    is_A = owners[pair.id_A][0] < 0
    normal = pair.nhat_BA_W if is_A else -pair.nhat_BA_W
    which = max(points)
    return np.array([pair.distance, *normal, *points[-1], *points[which], which])


def answer_with_hull(problem: PeerProblem) -> PeerAnswers:
    """Answers with a compliant `Mesh` as the tool, of which Drake fills the hull."""
    return _answer(problem, register_mesh)


def answer_with_pieces(problem: PeerProblem) -> PeerAnswers:
    """Answers with separately compliant pieces of the tool."""
    return _answer(problem, register_pieces)


def _answer(problem: PeerProblem, register_tool: Register) -> PeerAnswers:
    """Returns the plant's hydroelastic forces, without distances.

    No modulus corresponds to the scene's stiffness, so it is fitted to the reference's
    forces by least squares over the whole motion.
    """
    rigid, soft = _make_surface(), _make_surface()
    AddRigidHydroelasticProperties(_RESOLUTION_M, rigid)
    AddCompliantHydroelasticProperties(_RESOLUTION_M, _MODULUS_PA, soft)

    drake = make_plant(
        problem,
        "hydroelastic",
        Shapes(register_tool, soft),
        Shapes(register_mesh, rigid),
    )
    motion = problem.motion
    own = set(drake.plant.GetCollisionGeometriesForBody(drake.tool))
    F_To_W = np.zeros((len(motion), 6))

    def read(tick: int, results: ContactResults) -> None:
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            surface, F_Ac_W = info.contact_surface(), info.F_Ac_W()
            # The force is the one on M, at the surface's centroid.
            sign = 1 if surface.id_M() in own else -1
            force = sign * F_Ac_W.translational()
            arm = surface.centroid() - motion.X_WT[tick, 4:]
            torque = sign * F_Ac_W.rotational() + np.cross(arm, force)
            F_To_W[tick] += np.concatenate([torque, force])

    port = drake.plant.get_contact_results_output_port()
    seconds = drake.ask(motion, port, lambda results: results, read)
    scale = _fit(F_To_W[:, 3:], problem.f_W)
    return PeerAnswers(
        scale * F_To_W,
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
    """Returns the factor that fits forces best to others; 1 if all are 0.

    Raises:
        ValueError: The factor is not positive.
    """
    if not f_W.any():
        return 1.0
    scale = float((f_W * wanted_W).sum() / (f_W**2).sum())
    if scale <= 0.0:
        raise ValueError("its forces point against the reference's on the whole")
    return scale
