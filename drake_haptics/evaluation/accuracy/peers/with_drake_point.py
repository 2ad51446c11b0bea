"""Drake's point contact, and its signed distances under this package's law."""

from __future__ import annotations

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    GeometryId,
    InMemoryMesh,
    Mesh,
    ProximityProperties,
    SignedDistancePair,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.multibody.tree import RigidBody

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.peers.drake_plant import (
    AddGeometry,
    DrakePlant,
    make_plant,
)
from drake_haptics.evaluation.accuracy.peers.our_law import FoundContacts, apply_law
from drake_haptics.evaluation.accuracy.peers.problem import PeerAnswers, PeerProblem
from drake_haptics.evaluation.measuring.pieces import (
    make_surface,
    register_pieces,
)
from drake_haptics.geometry.decomposition.decompose import Decomposition


def answer_on_pieces(problem: PeerProblem) -> PeerAnswers:
    """Takes the plant's own forces on the same pieces."""
    return _read_forces(problem, _add_pieces(problem))


def answer_on_meshes(problem: PeerProblem) -> PeerAnswers:
    """Takes the plant's own forces on `Mesh` shapes, of which it uses the hulls."""

    def add(
        plant: MultibodyPlant, body: RigidBody, which: int, X_BM: RigidTransform
    ) -> None:
        part, surface = _find_part(problem, which)
        shape = to_drake_mesh(part)
        plant.RegisterCollisionGeometry(body, X_BM, shape, f"mesh_{which}", surface)

    return _read_forces(problem, add)


def answer_by_distances(problem: PeerProblem) -> PeerAnswers:
    """Takes signed distances within the tolerance, of the same pieces."""
    drake = make_plant("point", problem.part.X_WO, _add_pieces(problem))
    owners = _find_owners(problem, drake)
    start = [0]
    rows: list[np.ndarray] = []

    def read(tick: int, pairs: list[SignedDistancePair]) -> None:
        X_WTool = vector_to_pose(problem.motion.X_WTool[tick])
        rows.extend(_to_row(pair, X_WTool, owners) for pair in pairs)
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
    distance, normal, p_WCa, p_WCb, owner = np.split(columns, [1, 4, 7, 10], axis=1)
    found = FoundContacts(
        start=np.array(start),
        distance=distance[:, 0],
        nhat_BA_W=normal,
        p_WCa=p_WCa,
        p_WCb=p_WCb,
        object_index=owner[:, 0].astype(np.int32),
        seconds=seconds,
    )
    return apply_law(problem, found)


def to_drake_mesh(part: Decomposition) -> Mesh:
    """Returns a mesh as Drake's, without a file."""
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in part.mesh.vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in (part.mesh.triangles + 1).tolist()]
    file = MemoryFile("\n".join(lines) + "\n", ".obj", "mesh")
    return Mesh(mesh_data=InMemoryMesh(mesh_file=file))


def _find_part(
    problem: PeerProblem, which: int
) -> tuple[Decomposition, ProximityProperties]:
    """Returns the shape of the tool (-1) or an object, and what it is made of."""
    stiffness, damping = problem.part.stiffness_N_per_m, problem.part.damping_Ns_per_m
    if np.ptp(stiffness) > 0.0 or np.ptp(damping) > 0.0:
        # The tool would need another surface for each object.
        raise ValueError("the objects differ in stiffness or damping")
    surface = make_surface(float(stiffness[0]), float(damping[0]))
    return problem.tool if which < 0 else problem.objects[which], surface


def _add_pieces(problem: PeerProblem) -> AddGeometry:
    def add(
        plant: MultibodyPlant, body: RigidBody, which: int, X_BP: RigidTransform
    ) -> None:
        register_pieces(plant, body, X_BP, *_find_part(problem, which))

    return add


def _read_forces(problem: PeerProblem, add: AddGeometry) -> PeerAnswers:
    """Sums the forces of the plant's point contacts at the tool's origin."""
    drake = make_plant("point", problem.part.X_WO, add)
    motion, tool = problem.motion, drake.tool.index()
    F_Tool_W = np.zeros((len(motion), 6))
    distance = np.full(len(motion), np.inf)

    def read(tick: int, results: ContactResults) -> None:
        for i in range(results.num_point_pair_contacts()):
            info = results.point_pair_contact_info(i)
            # The force is the one on B, at C.
            force = info.contact_force() * (1 if info.bodyB_index() == tool else -1)
            arm = info.contact_point() - motion.X_WTool[tick, 4:]
            F_Tool_W[tick] += np.concatenate([np.cross(arm, force), force])
            distance[tick] = min(distance[tick], -info.point_pair().depth)

    port = drake.plant.get_contact_results_output_port()
    seconds = drake.ask(motion, port, lambda results: results, read)
    return PeerAnswers(F_Tool_W, distance, 0.0, seconds)


def _find_owners(
    problem: PeerProblem, drake: DrakePlant
) -> dict[GeometryId, tuple[int, RigidTransform]]:
    """Returns the object (or -1) of each piece, and where its frame is in the body."""
    inspector = drake.scene_graph.model_inspector()
    owners = {
        piece: (-1, inspector.GetPoseInFrame(piece))
        for piece in drake.plant.GetCollisionGeometriesForBody(drake.tool)
    }
    anchored = iter(drake.plant.GetCollisionGeometriesForBody(drake.plant.world_body()))
    # In the order in which they were added.
    for i, part in enumerate(problem.objects):
        for _ in part.pieces:
            piece = next(anchored)
            owners[piece] = (i, inspector.GetPoseInFrame(piece))
    return owners


def _to_row(
    pair: SignedDistancePair,
    X_WTool: RigidTransform,
    owners: dict[GeometryId, tuple[int, RigidTransform]],
) -> np.ndarray:
    """Returns distance, normal out of the object, both points, and the object."""
    points = {}
    for piece, p in ((pair.id_A, pair.p_ACa), (pair.id_B, pair.p_BCb)):
        owner, X_BP = owners[piece]
        points[owner] = (X_WTool @ X_BP if owner < 0 else X_BP) @ p
    is_A = owners[pair.id_A][0] < 0
    normal = pair.nhat_BA_W if is_A else -pair.nhat_BA_W
    which = max(points)
    return np.array([pair.distance, *normal, *points[-1], *points[which], which])
