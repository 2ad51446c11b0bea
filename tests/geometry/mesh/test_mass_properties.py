"""Center of mass and inertia of meshes whose values are known."""

import numpy as np
import pytest
import trimesh

from drake_haptics.common.errors import MeshError
from drake_haptics.geometry.mesh.mesh import (
    Mesh,
    calc_mass_properties,
    make_tool_dynamics,
)

MASS = 0.3


def intake(mesh):
    return Mesh.from_arrays(mesh.vertices, mesh.faces)


def test_a_box():
    a, b, c = 0.1, 0.2, 0.3
    box = trimesh.creation.box([a, b, c])
    box.apply_translation([1.0, -2.0, 3.0])
    center, inertia = calc_mass_properties(intake(box), MASS)
    np.testing.assert_allclose(center, [1.0, -2.0, 3.0])
    expected = MASS / 12 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
    np.testing.assert_allclose(inertia, expected, atol=1e-12)


def test_a_turned_shape_agrees_with_trimesh():
    cone = trimesh.creation.cone(0.02, 0.1, sections=24)
    cone.apply_transform(trimesh.transformations.euler_matrix(0.3, 0.5, 0.7))
    cone.density = MASS / cone.volume
    center, inertia = calc_mass_properties(intake(cone), MASS)
    np.testing.assert_allclose(center, cone.center_mass, atol=1e-12)
    np.testing.assert_allclose(inertia, cone.moment_inertia, atol=1e-12)


@pytest.mark.parametrize("is_open", [False, True])
def test_a_part_far_from_its_origin_keeps_its_inertia(is_open):
    # As in the frame of a site or of a large assembly; powers of two move exactly.
    part = trimesh.creation.icosphere(subdivisions=2, radius=2.0**-6)
    vertices = np.round(part.vertices * 2.0**30) * 2.0**-30
    faces = part.faces[:-1] if is_open else part.faces
    offset = np.array([512.0, -256.0, 1024.0])
    near = calc_mass_properties(Mesh.from_arrays(vertices, faces), MASS)
    far = calc_mass_properties(Mesh.from_arrays(vertices + offset, faces), MASS)
    np.testing.assert_allclose(far[0] - offset, near[0], atol=1e-12)
    np.testing.assert_allclose(far[1], near[1], rtol=1e-6, atol=1e-15)


def test_a_hollow_is_hollow():
    outer = trimesh.creation.icosphere(subdivisions=3, radius=0.1)
    inner = trimesh.creation.icosphere(subdivisions=3, radius=0.09)
    inner.invert()
    shell = trimesh.util.concatenate([outer, inner])
    _, inertia = calc_mass_properties(intake(shell), MASS)
    thick = 2 / 5 * MASS * (0.1**5 - 0.09**5) / (0.1**3 - 0.09**3)
    np.testing.assert_allclose(inertia, thick * np.eye(3), rtol=0.02, atol=1e-9)


def test_an_open_surface_is_a_shell():
    x = np.array([[0, 0, 0], [0.2, 0, 0], [0.2, 0.1, 0], [0, 0.1, 0]])
    plate = Mesh.from_arrays(x, np.array([[0, 1, 2], [0, 2, 3]]))
    center, inertia = calc_mass_properties(plate, MASS)
    np.testing.assert_allclose(center, [0.1, 0.05, 0.0], atol=1e-15)
    expected = MASS / 12 * np.diag([0.1**2, 0.2**2, 0.1**2 + 0.2**2])
    np.testing.assert_allclose(inertia, expected, atol=1e-15)
    assert np.linalg.eigvalsh(inertia).min() > 0


def test_mass_scales_inertia():
    box = intake(trimesh.creation.box([0.1, 0.1, 0.1]))
    one, two = (calc_mass_properties(box, m)[1] for m in (MASS, 2 * MASS))
    assert two[0, 0] == pytest.approx(2 * one[0, 0])


def test_a_tool_turns_as_its_shape_does():
    a, b, c = 0.1, 0.2, 0.3
    tool = make_tool_dynamics(intake(trimesh.creation.box([a, b, c])), MASS)
    assert tool.mass_kg == MASS
    np.testing.assert_allclose(tool.p_TTcm, 0.0, atol=1e-12)
    # A torque about each axis for a millisecond, from rest.
    principal = MASS / 12 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    state, wrench_model = np.zeros(13), np.zeros(78)
    state[0], wrench_model[:3] = 1.0, 1e-3
    turned = tool.step(state, wrench_model, 1e-3)
    np.testing.assert_allclose(turned[7:10], 1e-6 / principal, rtol=1e-6)


@pytest.mark.parametrize("mass_kg", [0.0, -1.0, np.nan])
@pytest.mark.parametrize("calc", [calc_mass_properties, make_tool_dynamics])
def test_a_mass_is_positive(calc, mass_kg):
    box = intake(trimesh.creation.box([0.1, 0.1, 0.1]))
    with pytest.raises(ValueError, match=r"^mass_kg must be positive and finite, is"):
        calc(box, mass_kg)


def test_a_tool_as_thin_as_a_line_is_told_of_its_mesh():
    corners = [[0, 0, 0], [0.1, 0, 0], [0.05, 1e-12, 0]]
    line = Mesh.from_arrays(corners, [[0, 1, 2]], name="wire.obj")
    with pytest.raises(MeshError, match=r"^wire\.obj: as a tool of .* thin as a line"):
        make_tool_dynamics(line, MASS)
