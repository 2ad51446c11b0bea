"""The hulls of the corners are within the chord error of the shapes, on both sides."""

import numpy as np
import pytest

from drake_haptics import ConvexPolytope
from drake_haptics.geometry.mesh.round_shapes import (
    make_box_corners,
    make_capsule_corners,
    make_cylinder_corners,
    make_ellipsoid_corners,
)

RADIUS, LENGTH = 0.05, 0.12
AXES = (0.07, 0.03, 0.05)
DOWN = np.array([0.0, 0.0, 0.5 * LENGTH])


def ball(p):
    return np.linalg.norm(p, axis=1) - RADIUS


def capsule(p):
    on_segment = np.clip(p[:, 2], -0.5 * LENGTH, 0.5 * LENGTH)
    return np.linalg.norm(p - on_segment[:, None] * [0, 0, 1], axis=1) - RADIUS


def cylinder(p):
    """Distance from the surface; exact but outside of a rim, where it is less."""
    return np.maximum(
        np.hypot(p[:, 0], p[:, 1]) - RADIUS, np.abs(p[:, 2]) - 0.5 * LENGTH
    )


def ellipsoid(p):
    """Distance from the surface, by Newton's method for the foot point's factor."""
    p, axes = np.abs(p), np.array(AXES)
    t = np.zeros(len(p))
    for _ in range(50):
        ratio = axes * p / (t[:, None] + axes**2)
        t += ((ratio**2).sum(axis=1) - 1) / (
            2 * (ratio**2 / (t[:, None] + axes**2)).sum(axis=1)
        )
    foot = axes**2 * p / (t[:, None] + axes**2)
    np.testing.assert_allclose(((foot / axes) ** 2).sum(axis=1), 1.0, atol=1e-12)
    return np.sign(t) * np.linalg.norm(p - foot, axis=1)


SHAPES = {
    "ball": (lambda e: make_ellipsoid_corners((RADIUS,) * 3, e), ball),
    "ellipsoid": (lambda e: make_ellipsoid_corners(AXES, e), ellipsoid),
    "capsule": (lambda e: make_capsule_corners(RADIUS, LENGTH, e), capsule),
    "cylinder": (lambda e: make_cylinder_corners(RADIUS, LENGTH, e), cylinder),
}


def points_on_hull(corners, rng):
    """Returns random points on the facets, and the corners."""
    hull = ConvexPolytope(corners)
    vertices = np.asarray(hull.vertices)
    points = [vertices]
    for loop in hull.facets:
        points.append(rng.dirichlet(np.ones(len(loop)), 5) @ vertices[loop])
        points.append(vertices[loop].mean(axis=0, keepdims=True))
    return np.concatenate(points)


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("error", [1e-4, 1e-3])
def test_every_point_of_the_hull_is_within_the_error(name, error):
    make, distance = SHAPES[name]
    found = distance(points_on_hull(make(error), np.random.default_rng(0)))
    assert np.abs(found).max() <= error
    # It is shared by both sides, and not bought with more corners than it takes.
    assert found.max() >= 0.5 * error
    assert found.min() <= -0.5 * error


@pytest.mark.parametrize("name", SHAPES)
def test_no_part_of_the_shape_is_left_out(name):
    """In any direction the hull reaches as far as the shape, within the error."""
    error = 1e-4
    u = np.random.default_rng(1).normal(size=(2000, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    reach = {
        "ball": np.full(len(u), RADIUS),
        "ellipsoid": np.linalg.norm(u * AXES, axis=1),
        "capsule": RADIUS + np.abs(u @ DOWN),
        "cylinder": RADIUS * np.hypot(u[:, 0], u[:, 1]) + np.abs(u @ DOWN),
    }[name]
    hull_reach = (u @ SHAPES[name][0](error).T).max(axis=1)
    assert np.abs(hull_reach - reach).max() <= error


def test_a_cylinder_stands_at_its_exact_height():
    z = make_cylinder_corners(RADIUS, LENGTH, 1e-3)[:, 2]
    assert set(z) == {-0.5 * LENGTH, 0.5 * LENGTH}


def test_a_box_is_exact():
    hull = ConvexPolytope(make_box_corners(np.array([0.2, 0.4, 0.6])))
    assert len(hull.facets) == 6
    np.testing.assert_array_equal(np.ptp(hull.vertices, axis=0), [0.2, 0.4, 0.6])


@pytest.mark.parametrize("error", [0.0, -1e-4, float("nan")])
def test_the_error_must_be_positive(error):
    for make, _ in SHAPES.values():
        with pytest.raises(ValueError, match="chord_error_m must be positive"):
            make(error)


@pytest.mark.parametrize(
    "make",
    [
        lambda e: make_ellipsoid_corners((1.0, 1.0, 1.0), e),
        lambda e: make_cylinder_corners(1.0, 1.0, e),
    ],
)
def test_an_error_that_is_too_small_names_one_that_is_not(make):
    with pytest.raises(ValueError, match="too small for a radius of 1 m") as info:
        make(1e-7)
    make(float(str(info.value).split("take ")[1].split()[0]))
