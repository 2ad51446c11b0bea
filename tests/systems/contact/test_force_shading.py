"""Force shading as a Drake system; its normals have their own tests in the core."""

import numpy as np
import pytest
import trimesh
from box_contacts import TOLERANCE, box_core
from effect_chain import make_chain
from pydrake.common.value import Value
from pydrake.math import RigidTransform, RotationMatrix
from twin_check import check_twin

from drake_haptics._core import SceneTracker
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.force_shading import ForceShading

RADIUS = 0.02
OUT = np.array([0.36, 0.48, 0.8])  # where the tool touches: far from any vertex


@pytest.fixture(scope="module")
def tool():
    return box_core(1e-4, 1e-4, 1e-4)


@pytest.fixture(scope="module")
def ball():
    sphere = trimesh.creation.icosphere(2, RADIUS)
    return decompose(Mesh.from_arrays(sphere.vertices, sphere.faces), cache=False).core


def make_shading(tool, objects, shaded, crease_angle_deg=40.0):
    shading = ForceShading(
        tool, objects, crease_angle_deg=crease_angle_deg, shaded=shaded
    )
    return shading, shading.CreateDefaultContext()


def shade(shading, context, contacts, X_WT):
    shading.GetInputPort("contacts").FixValue(context, Value[object](contacts))
    shading.GetInputPort("X_WT").FixValue(context, pose_to_vector(X_WT))
    return shading.GetOutputPort("contacts").Eval(context)


def contacts_at(tool, ball, X_WT, X_WO):
    tracker = SceneTracker(tool, [ball], TOLERANCE)
    tracker.set_object_pose(0, X_WO)
    return tracker.query(X_WT)


def degrees_between(u, v):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v)), np.dot(u, v)))


@pytest.mark.parametrize("moves", [False, True])
def test_the_normal_of_a_tessellated_ball_is_that_of_the_sphere(tool, ball, moves):
    X_WO = RigidTransform([0.3, -0.1, 0.5])
    X_WT = RigidTransform(X_WO.translation() + (RADIUS - 1e-4) * OUT)
    contacts = contacts_at(tool, ball, X_WT, X_WO)
    item = ContactObject("ball", ball, None if moves else X_WO)
    shading, context = make_shading(tool, [item], [True])
    if moves:
        pose = pose_to_vector(X_WO)
        shading.GetInputPort("X_WO_ball").FixValue(context, pose)
    shaded = shade(shading, context, contacts, X_WT)
    assert len(shaded) == len(contacts) == 1
    # The corner of the tool that is deepest is not quite at its origin.
    out = contacts.p_WCa[0] - X_WO.translation()
    assert degrees_between(shaded.nhat_BA_W[0], out) < 0.6
    assert degrees_between(contacts.nhat_BA_W[0], out) > 2.0
    np.testing.assert_array_equal(shaded.distance, contacts.distance)


def test_an_object_that_is_not_shaded_keeps_its_facets(tool, ball):
    X_WO = RigidTransform()
    X_WT = RigidTransform((RADIUS - 1e-4) * OUT)
    contacts = contacts_at(tool, ball, X_WT, X_WO)
    other = ContactObject("other", ball, RigidTransform([1.0, 0, 0]))
    shading, context = make_shading(
        tool, [ContactObject("ball", ball, X_WO), other], [False, True]
    )
    shaded = shade(shading, context, contacts, X_WT)
    np.testing.assert_array_equal(shaded.nhat_BA_W, contacts.nhat_BA_W)


@pytest.mark.parametrize("moves", [False, True])
def test_its_twin_turns_the_force_with_place_and_poses(tool, ball, moves):
    """The way of the tool turns the normal: with facets it would not."""
    X_WO = RigidTransform(RotationMatrix.MakeXRotation(0.3), [0.3, -0.1, 0.5])
    turn = RotationMatrix.MakeYRotation(0.2)
    X_WT = RigidTransform(
        turn, X_WO.translation() + (RADIUS - 1e-4) * (X_WO.rotation() @ OUT)
    )
    item = ContactObject("ball", ball, None if moves else X_WO)
    inputs = {
        "X_WT": pose_to_vector(X_WT),
        "V_WT": np.array([0.1, 0.2, -0.3, 0.01, -0.02, 0.03]),
    }
    if moves:
        inputs["X_WO_ball"] = 1.0 * pose_to_vector(X_WO)
        inputs["V_WO_ball"] = np.array([-0.3, 0.1, 0.2, 0.02, 0.03, -0.01])
    shadings = [make_shading(tool, [item], [smooth])[0] for smooth in (True, False)]
    shaded, faceted = (
        check_twin(
            make_chain(tool, [item], TOLERANCE, shading=shading),
            inputs,
            step=1e-6,
            rtol=1e-6,
        )
        for shading in shadings
    )
    across = np.eye(3) - np.outer(OUT, OUT)
    across = X_WO.rotation().matrix() @ across @ X_WO.rotation().matrix().T
    by_way = [across @ J[3:6, 4:7] @ across for J in (shaded, faceted)]
    # A force f that stays normal to a sphere turns by f / r on its way; the facet's
    # stays, and its length changes with the way along what the facet is off the sphere.
    assert np.linalg.norm(by_way[0] - by_way[1]) > 0.1 * np.linalg.norm(by_way[1])


@pytest.mark.parametrize("angle", [-1.0, 180.5, float("nan")])
def test_an_angle_out_of_range_is_refused(tool, ball, angle):
    with pytest.raises(ValueError, match=r"crease_angle_deg must be in \[0, 180\]"):
        make_shading(tool, [ContactObject("ball", ball)], [True], angle)


def test_each_object_must_be_told_of(tool, ball):
    with pytest.raises(ValueError, match="one entry for each of the 1 objects, has 2"):
        make_shading(tool, [ContactObject("ball", ball)], [True, False])
