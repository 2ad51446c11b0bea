"""Convex pieces as Drake's proximity geometry."""

from __future__ import annotations

from pydrake.geometry import AddContactMaterial, Convex, ProximityProperties
from pydrake.math import RigidTransform
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant
from pydrake.multibody.tree import RigidBody

from drake_haptics.geometry.decomposition.decompose import Decomposition

# Penetration at which the contact's damping is what was asked for: Hunt and Crossley's
# grows with it, m.
_TYPICAL_DEPTH_M = 5e-4


def register_pieces(
    plant: MultibodyPlant,
    body: RigidBody,
    X_BP: RigidTransform,
    decomposition: Decomposition,
    surface: ProximityProperties,
) -> None:
    """Adds each piece to a body, flat ones as they are.

    Args:
        plant: Not yet finalized.
        body: Of it.
        X_BP: Pose of the pieces in the body's frame.
        decomposition: The pieces.
        surface: What they are made of.
    """
    for piece in decomposition.pieces:
        name = f"piece_{len(plant.GetCollisionGeometriesForBody(body))}"
        shape = Convex(points=piece.vertices.T, label=name)
        plant.RegisterCollisionGeometry(body, X_BP, shape, name, surface)


def make_surface(
    stiffness_N_per_m: float, damping_Ns_per_m: float
) -> ProximityProperties:
    """Returns a material of which two surfaces have these gains together."""
    properties = ProximityProperties()
    AddContactMaterial(
        dissipation=damping_Ns_per_m / (stiffness_N_per_m * _TYPICAL_DEPTH_M),
        # Two springs in series.
        point_stiffness=2.0 * stiffness_N_per_m,
        friction=CoulombFriction(0.0, 0.0),
        properties=properties,
    )
    return properties
