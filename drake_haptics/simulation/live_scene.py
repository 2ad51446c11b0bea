"""Changes values of a scene while it runs."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from pydrake.systems.framework import Context

from drake_haptics.common.type_checks import require_kinds
from drake_haptics.loop.add_haptic_loop import make_coupling_gains
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.loop.contact import find_contact_gains, find_query_tolerance
from drake_haptics.scene.schema import Contact, Coupling, Scene
from drake_haptics.systems.contact.contact_clustering import (
    ClusteringMethod,
    ClusteringRule,
)


def write_live_values(haptic: HapticDiagram, root: Context, scene: Scene) -> None:
    """Writes what a scene says of its live keys into a context.

    They hold from the next tick on, in this context alone. The diagram and its
    `HapticDiagram.scene` stay as they are.

    Args:
        haptic: What `BuildHapticDiagram` returned.
        root: Context of its diagram.
        scene: Differs from what was built in live keys and the clustering alone; see
            `is_live_change`.

    Raises:
        ValueError: It differs in more, and the diagram must be built anew; or a value
            is out of range. The context is as it was.
    """
    require_kinds(
        "write_live_values(haptic, root, scene) is their order",
        haptic=(haptic, HapticDiagram),
        root=(root, Context),
        scene=(scene, Scene),
    )
    if not is_live_change(haptic.scene, scene):
        raise ValueError(
            "scene differs from what was built in more than its live keys: build its"
            " diagram and carry on there (drake_haptics.carry_on)"
        )
    put_live_values(haptic, root, scene)


def put_live_values(haptic: HapticDiagram, root: Context, scene: Scene) -> None:
    """Writes live values into a context whatever else its diagram was built with.

    As `write_live_values`, for values that are on their way to those of the diagram.
    """
    contact, loop = scene.contact, haptic.loop
    gains = make_coupling_gains(scene.coupling, loop.device)
    rule = ClusteringRule(
        cast(ClusteringMethod, contact.clustering),
        contact.tolerance_m,
        contact.cluster_size_m,
    )
    contact_gains = find_contact_gains(
        contact, [item.material for item in scene.environment]
    )
    coupling, force = loop.virtual_coupling, loop.penalty_force
    clustering, query = loop.contact_clustering, loop.contact_query
    coupling.set_gains(coupling.GetMyMutableContextFromRoot(root), gains)
    force.set_gains(force.GetMyMutableContextFromRoot(root), contact_gains)
    clustering.set_rule(clustering.GetMyMutableContextFromRoot(root), rule)
    query.set_tolerance(
        query.GetMyMutableContextFromRoot(root),
        find_query_tolerance(contact, scene.effects),
    )


def is_live_change(built: Scene, scene: Scene) -> bool:
    """Returns whether one scene becomes the other without a new diagram.

    Live are the keys of `drake_haptics.live_keys` and `contact.clustering`. But where
    passivity control finds its reserve by itself, that is a number of the stiffnesses:
    another one of these needs another diagram.
    """
    passivity = scene.effects.passivity
    if (
        passivity is not None
        and passivity.reserve_J is None
        and _list_springs(built) != _list_springs(scene)
    ):
        return False
    return _without_live_values(built) == _without_live_values(scene)


def _list_springs(scene: Scene) -> tuple[float, ...]:
    """Returns the stiffnesses that the reserve of passivity control comes of."""
    coupling = scene.coupling
    return (
        coupling.stiffness_N_per_m,
        coupling.rotational_stiffness_Nm_per_rad,
        scene.contact.stiffness_N_per_m,
    )


def _without_live_values(scene: Scene) -> Scene:
    """Returns a scene with the default of each live value."""
    default = Contact()
    contact = replace(
        scene.contact,
        tolerance_m=default.tolerance_m,
        stiffness_N_per_m=default.stiffness_N_per_m,
        damping_Ns_per_m=default.damping_Ns_per_m,
        clustering=default.clustering,
        cluster_size_m=default.cluster_size_m,
    )
    return replace(scene, coupling=Coupling(), contact=contact)
