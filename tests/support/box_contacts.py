"""Boxes as convex pieces, and a query that is asked at a height."""

import trimesh
from pydrake.math import RigidTransform

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh

TOLERANCE = 2e-3


def box_core(*size):
    box = trimesh.creation.box(size)
    return decompose(Mesh.from_arrays(box.vertices, box.faces), cache=False).core


def at_height(z):
    return pose_to_vector(RigidTransform([0.0, 0.0, z]))


def query_at(query, context, z):
    query.GetInputPort("X_WT").FixValue(context, at_height(z))
    return query.GetOutputPort("contacts").Eval(context)
