"""Finds the bodies of a plant that take part in haptic rendering."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from pydrake.geometry import (
    CollisionFilterDeclaration,
    GeometrySet,
    Role,
    SceneGraph,
    SceneGraphInspector,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import BodyIndex, QuaternionFloatingJoint, RigidBody

from drake_haptics import _core
from drake_haptics.geometry.parsing.body_shapes import (
    decompose_body,
    find_body_geometries,
)


@dataclass(frozen=True)
class RenderedBody:
    """A body of a plant with its contact pieces.

    Attributes:
        name: Name in the ports: that of the body; if several rendered bodies have it,
            `model_name`, or `model::name` where `model_name` is taken too.
        body: Body of the plant, whose frame is that of the pieces.
        pieces: Convex pieces of its shapes.
        X_WB: Pose of the body in the world, if it is welded to the world; None if it
            can move.
    """

    name: str
    body: RigidBody
    pieces: _core.ConvexPieces
    X_WB: RigidTransform | None

    @property
    def index(self) -> BodyIndex:
        """Index of the body in its plant."""
        return self.body.index()


def find_body(plant: MultibodyPlant, body: RigidBody | str, argument: str) -> RigidBody:
    """Returns the body that is given as a `Body`, a name, or `model::name`.

    Args:
        plant: Plant of the body.
        body: Body, its name, or `model::name`.
        argument: Name of the argument in messages.

    Raises:
        ValueError: There is no such body, there are several, or it is of another plant.
    """
    if isinstance(body, RigidBody):
        if int(body.index()) >= plant.num_bodies() or (
            plant.get_body(body.index()) is not body
        ):
            raise ValueError(f"{argument}: body {body.name()!r} is of another plant")
        return body
    found = [
        other
        for other in _all_bodies(plant)
        if body in (other.name(), other.scoped_name().get_full())
    ]
    if len(found) == 1:
        return found[0]
    if found:
        names = ", ".join(other.scoped_name().get_full() for other in found)
        raise ValueError(f"{argument}: several bodies are called {body!r}: {names}")
    names = ", ".join(other.name() for other in _all_bodies(plant))
    raise ValueError(f"{argument}: no body is called {body!r}; there are {names}")


def find_in_state(body: RigidBody) -> tuple[int, int] | None:
    """Returns where a plant's state [q; v] holds the pose and velocity of a body.

    Returns:
        Indices of the pose (7) [qw qx qy qz x y z] of its frame in the world and of its
        spatial velocity (6) [ω; v]; None if the body is not free.
    """
    plant = body.GetParentPlant()
    frames = (plant.world_frame().index(), body.body_frame().index())
    for joint in map(plant.get_joint, plant.GetJointIndices()):
        if isinstance(joint, QuaternionFloatingJoint) and frames == (
            joint.frame_on_parent().index(),
            joint.frame_on_child().index(),
        ):
            return (
                joint.position_start(),
                plant.num_positions() + joint.velocity_start(),
            )
    return None


def find_environment(
    plant: MultibodyPlant, inspector: SceneGraphInspector, tool: RigidBody, role: Role
) -> list[RigidBody]:
    """Returns all bodies with shapes that a tool can meet.

    Bodies that are rigidly attached to the tool are left out, and so are those whose
    contact with it a collision filter excludes (as Drake does for bodies that a joint
    connects).
    """
    attached = _find_attached(plant, tool)
    return [
        body
        for body in _all_bodies(plant)
        if body.index() not in attached
        and find_body_geometries(plant, inspector, body, role)
        and not _is_filtered(plant, inspector, tool, body)
    ]


def make_rendered_bodies(
    plant: MultibodyPlant,
    inspector: SceneGraphInspector,
    tool: RigidBody,
    environment: Sequence[RigidBody],
    *,
    role: Role,
    chord_error_m: float,
    progress: Callable[[str, float], None] | None,
) -> tuple[RenderedBody, list[RenderedBody]]:
    """Returns the tool and the objects that it meets, with their pieces.

    Raises:
        ValueError: There is no object to meet, the tool cannot move, a body of the
            environment is rigidly attached to it or named twice, or a body's shapes
            cannot be used
            (`drake_haptics.geometry.parsing.body_shapes.decompose_body`).
    """
    fixed = {body.index() for body in plant.GetBodiesWeldedTo(plant.world_body())}
    if tool.index() in fixed:
        raise ValueError(
            f"tool_body: {tool.name()!r} is welded to the world, so that it cannot move"
        )
    if not environment:
        raise ValueError(
            f"environment: there is no body that {tool.name()!r} can meet, beside those"
            " that it meets in earlier renderings; give another body a shape with the"
            f" role {role.name[1:].lower()}"
        )
    indices = [body.index() for body in environment]
    attached = _find_attached(plant, tool)
    for body in environment:
        if body.index() in attached:
            raise ValueError(
                f"environment: {body.name()!r} is rigidly attached to the tool"
                f" {tool.name()!r}, so that the two cannot meet"
            )
        if indices.count(body.index()) > 1:
            raise ValueError(f"environment: {body.name()!r} is named twice")
    context = plant.CreateDefaultContext()

    def render(body: RigidBody, name: str) -> RenderedBody:
        return RenderedBody(
            name,
            body,
            decompose_body(
                plant,
                inspector,
                body,
                role=role,
                chord_error_m=chord_error_m,
                progress=partial(progress, name) if progress else None,
            ),
            plant.EvalBodyPoseInWorld(context, body) if body.index() in fixed else None,
        )

    objects = list(map(render, environment, _name_bodies(environment)))
    return render(tool, tool.name()), objects


def exclude_own_contact(
    plant: MultibodyPlant,
    scene_graph: SceneGraph,
    tool: RigidBody,
    environment: Sequence[RigidBody],
) -> list[str]:
    """Keeps the plant's own contact from acting between the tool and rendered bodies.

    Args:
        plant: Plant of the bodies.
        scene_graph: Scene graph of the plant, whose collision filters are changed, in
            the model.
        tool: Body that is the tool.
        environment: Bodies that are rendered.

    Returns:
        Names of other bodies that the plant lets the tool touch.
    """
    inspector = scene_graph.model_inspector()
    own = find_body_geometries(plant, inspector, tool)
    others = [
        shape
        for body in environment
        for shape in find_body_geometries(plant, inspector, body)
    ]
    scene_graph.collision_filter_manager().Apply(
        CollisionFilterDeclaration().ExcludeBetween(
            GeometrySet(own), GeometrySet(others)
        )
    )
    if not own:
        return []
    touching = find_environment(plant, inspector, tool, Role.kProximity)
    return [body.name() for body in touching]


def _all_bodies(plant: MultibodyPlant) -> list[RigidBody]:
    return [plant.get_body(BodyIndex(i)) for i in range(plant.num_bodies())]


def _name_bodies(bodies: Sequence[RigidBody]) -> list[str]:
    """Returns a name for each body that no other has."""
    counts = Counter(body.name() for body in bodies)
    unique = [counts[body.name()] == 1 for body in bodies]
    full = [body.scoped_name().get_full() for body in bodies]
    names = [
        body.name() if alone else name.replace("::", "_")
        for body, alone, name in zip(bodies, unique, full, strict=True)
    ]
    # Body c of model a_b and body b_c of model a would both become a_b_c.
    counts = Counter(names)
    return [
        name if alone or counts[name] == 1 else scoped
        for name, alone, scoped in zip(names, unique, full, strict=True)
    ]


def _find_attached(plant: MultibodyPlant, tool: RigidBody) -> set[BodyIndex]:
    """Returns the tool and all that is welded to it."""
    return {body.index() for body in plant.GetBodiesWeldedTo(tool)}


def _is_filtered(
    plant: MultibodyPlant,
    inspector: SceneGraphInspector,
    tool: RigidBody,
    body: RigidBody,
) -> bool:
    """Returns whether the model filters out contact between two bodies."""
    pairs = [
        (a, b)
        for a in find_body_geometries(plant, inspector, tool)
        for b in find_body_geometries(plant, inspector, body)
    ]
    # Bodies that are only drawn have no pairs, so no filter excludes them.
    return bool(pairs) and all(inspector.CollisionFiltered(a, b) for a, b in pairs)
