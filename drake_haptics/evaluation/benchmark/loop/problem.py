"""Defines the problem and the course of a loop that pulls a tool along a motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.tree import RotationalInertia, SpatialInertia

from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.evaluation.accuracy.recorded_motion import (
    RecordedMotion,
    record_motion,
)
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.geometry.mesh.mesh import calc_mass_properties
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import Scene


@dataclass(frozen=True, eq=False)
class LoopProblem:
    """The problem for all loops: a scene without effects, and the motion of its handle.

    The motion of the tool is not used; the objects are at rest.
    """

    name: str
    scene: Scene
    motion: RecordedMotion
    tool: Decomposition
    objects: tuple[Decomposition, ...]

    @property
    def X_HT(self) -> RigidTransform:
        """Pose of the tool in the handle at rest."""
        return self.scene.tool.grasp.to_rigid_transform()

    @property
    def X_WO(self) -> list[RigidTransform]:
        """Pose of each object."""
        return [item.pose.to_rigid_transform() for item in self.scene.environment]

    @property
    def X_WG(self) -> np.ndarray:
        """(n, 7) poses to which the handle pulls the tool, [qw qx qy qz x y z], m."""
        return np.array(
            [pose_to_vector(vector_to_pose(X) @ self.X_HT) for X in self.motion.X_WH]
        )

    @property
    def M_TTo_T(self) -> SpatialInertia:
        """Spatial inertia of the tool about its origin."""
        p_TTcm, I_TTcm_T = self.mass_properties()
        return SpatialInertia.MakeFromCentralInertia(
            self.scene.tool.mass_kg,
            p_TTcm,
            RotationalInertia(*moments_and_products(I_TTcm_T)),
        )

    @property
    def explicit_rotational_damping(self) -> float:
        """The coupling's rotational damping, at most I / h, N·m·s/rad.

        I is the tool's least moment of inertia and h the tick. With this damping, a
        force that is computed at the beginning of the step is stable.
        """
        least = float(np.linalg.eigvalsh(self.mass_properties()[1]).min())
        own = self.scene.coupling.rotational_damping_Nms_per_rad
        return min(own, least / self.motion.period_s)

    def mass_properties(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns p_TTcm (3,), m, and I_TTcm_T (3, 3), kg·m², of the tool."""
        return calc_mass_properties(self.tool.mesh, self.scene.tool.mass_kg)

    def spring_force(self, p_WTo: np.ndarray) -> np.ndarray:
        """Returns the force (n,) of the coupling's spring at positions (n, 3), N."""
        stretch_m = np.linalg.norm(self.X_WG[:, 4:] - p_WTo, axis=1)
        return self.scene.coupling.stiffness_N_per_m * stretch_m


@dataclass(frozen=True, eq=False)
class LoopCourse:
    """Forces and motions of a loop, at the beginning of each of n ticks.

    Attributes:
        X_WT: (n, 7) poses of the tool, m.
        num_contacts: (n,) pairs of pieces that push each other.
        nearest_m: (n,) smallest signed distance of them, m; 0 without a contact.
        force_N: (n,) force of the spring between handle and tool, N.
    """

    X_WT: np.ndarray
    num_contacts: np.ndarray
    nearest_m: np.ndarray
    force_N: np.ndarray


class Loop(Protocol):
    """A loop, ready to be run."""

    def observe(self) -> LoopCourse | None:
        """Runs the motion from its start; returns its course, None without a tool."""
        ...

    def time(self) -> np.ndarray:
        """Runs the motion from its start and returns the time (n,) of each tick, s."""
        ...


def make_problem(name: str = "cup_spoon", duration_s: float = 4.0) -> LoopProblem:
    """Returns a shipped scene without effects, with the motion of its hand."""
    scene = load_scene(find_scene(name))
    haptic = build_without_scene_warnings(scene)
    motion = record_motion(scene, duration_s)
    return LoopProblem(name, scene, motion, haptic.tool, haptic.environment)


def moments_and_products(I_BP: np.ndarray) -> np.ndarray:
    """Returns an inertia (3, 3) as six numbers: xx, yy, zz, xy, xz, yz."""
    return I_BP[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
