"""What sources of wrench store, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import contacts_at
from energy_rig import pose
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def test_the_weight_s_energy_is_that_of_its_height():
    q = pose(Rotation.from_euler("y", 90, degrees=True), [1, 2, 3])
    weight = np.array([0, 0, -0.5])
    # The center of mass, on the tool's x axis, hangs 0.1 below its origin.
    energy = _core.weight_energy(q, np.array([0.1, 0, 0]), weight)
    assert energy == pytest.approx(0.5 * 2.9)


TOLERANCE = 1e-3
POINTS = [[0, 0, 0], [0.03, 0, 0], [0.03, 0.04, 0]]
DEPTHS = np.array([1e-4, 3e-4, 2e-4])


def test_contacts_of_the_paper_are_springs_of_their_own():
    contacts = contacts_at(POINTS, DEPTHS, TOLERANCE)
    clusters = _core.cluster_contacts(contacts, 5e-3, TOLERANCE)
    assert len(clusters) == 3
    assert _core.contact_energy(clusters, [800.0], TOLERANCE) == pytest.approx(
        0.5 * 800 * np.sum((TOLERANCE + DEPTHS) ** 2)
    )


@pytest.mark.parametrize("cluster", ["octree", "shared"])
def test_the_derivative_of_the_energy_by_depth_is_the_force(cluster):
    k, step = 800.0, 1e-7

    def clusters(depths):
        contacts = contacts_at(POINTS, depths, TOLERANCE)
        if cluster == "shared":
            return _core.share_stiffness(contacts, TOLERANCE)
        return _core.cluster_contacts(contacts, 5e-3, TOLERANCE)

    def energy(depths):
        return _core.contact_energy(clusters(depths), [k], TOLERANCE)

    forces = k * clusters(DEPTHS).compression
    for unit, force in zip(np.eye(3), forces, strict=True):
        rise = energy(DEPTHS + step * unit) - energy(DEPTHS - step * unit)
        assert rise / (2 * step) == pytest.approx(force, rel=1e-6)


def test_an_object_without_a_stiffness_is_refused():
    clusters = _core.cluster_contacts(
        contacts_at(POINTS, DEPTHS, TOLERANCE), 5e-3, TOLERANCE
    )
    with pytest.raises(IndexError, match="with object 0, but there are 0 here"):
        _core.contact_energy(clusters, [], TOLERANCE)
