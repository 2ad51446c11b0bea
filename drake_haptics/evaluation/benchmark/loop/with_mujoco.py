"""Runs the loop in MuJoCo: a free tool, welded to a mocap body as the handle."""

from __future__ import annotations

import weakref

import numpy as np

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.evaluation.benchmark.loop.problem import (
    LoopCourse,
    LoopProblem,
    moments_and_products,
)
from drake_haptics.evaluation.measuring.native_build import (
    HANDLE,
    INTEGER,
    INTEGERS,
    REALS,
    load_mujoco_native,
    open_mjcf,
)
from drake_haptics.evaluation.measuring.pieces import (
    listed,
    mesh_assets,
    mesh_bodies,
    mesh_geoms,
)
from drake_haptics.evaluation.measuring.timing import clock_interval

# MuJoCo's impedance d: f = d m (k r + b v) for a single constraint, and 1 / (1 - d) of
# that against another one. A small d makes a spring and damper.
_IMPEDANCE = 0.05
_SOLIMP = f"{_IMPEDANCE} {_IMPEDANCE} 0.001"


class MujocoLoop:
    """`mj_step` at each tick, timed in C around the call.

    MuJoCo's gains are per mass: weld and contacts have the scene's stiffness and
    damping for the whole mass of the tool, and its torques for an axis of mean inertia.
    Pieces are meshes in single precision; flat ones are 20 µm thick. A pair has one
    contact, as elsewhere, which is also faster than several.
    """

    def __init__(self, problem: LoopProblem):
        self._X_WG = np.ascontiguousarray(problem.X_WG)
        self._native = load_mujoco_native(
            "mujoco_loop",
            run=[*(HANDLE, INTEGER, REALS), *(REALS, INTEGERS, REALS, REALS, REALS)],
        )
        self._loop = open_mjcf(self._native.mujoco_loop_new, make_mjcf(problem))
        weakref.finalize(self, self._native.mujoco_loop_delete, self._loop)

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        return self._run()[0]

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        return self._run()[1] - clock_interval()

    def _run(self) -> tuple[LoopCourse, np.ndarray]:
        n = len(self._X_WG)
        poses, num_contacts = np.empty((n, 7)), np.empty(n, dtype=np.int32)
        nearest, force, seconds = np.empty(n), np.empty(n), np.empty(n)
        self._native.mujoco_loop_run(
            self._loop, n, self._X_WG, poses, num_contacts, nearest, force, seconds
        )
        return LoopCourse(poses, num_contacts, nearest, force), seconds


def make_mjcf(problem: LoopProblem) -> str:
    """Returns the scene as a model of MuJoCo."""
    scene, mass_kg = problem.scene, problem.scene.tool.mass_kg
    p_TTcm, I_T = problem.mass_properties()
    start = problem.X_WG[0]
    placed = f'pos="{listed(start[4:])}" quat="{listed(start[:4])}"'
    coupling, contact = scene.coupling, scene.contact
    # Angles are halved, as in a quaternion, and multiplied by the torquescale.
    mean = float(np.mean(1.0 / np.linalg.eigvalsh(I_T)))
    softness = mean * mass_kg / coupling.stiffness_N_per_m
    torquescale = 2.0 * np.sqrt(coupling.rotational_stiffness_Nm_per_rad * softness)
    weld = _solref(coupling.stiffness_N_per_m, coupling.damping_Ns_per_m, mass_kg)
    touch = _solref(contact.stiffness_N_per_m, contact.damping_Ns_per_m, mass_kg)
    parts = {f"object{i}": part for i, part in enumerate(problem.objects)}
    surface = f'condim="1" solref="{touch}" solimp="{_SOLIMP}"'
    objects = mesh_bodies(parts, map(pose_to_vector, problem.X_WO), surface)
    return f"""
<mujoco>
  <option timestep="{problem.motion.period_s}" integrator="implicitfast"
          gravity="0 0 0"><flag multiccd="disable"/></option>
  <size memory="64M"/>
  <asset>{mesh_assets({"tool": problem.tool, **parts})}</asset>
  <worldbody>
    {objects}
    <body name="handle" mocap="true" {placed}/>
    <body name="tool" {placed}>
      <freejoint/>
      <inertial pos="{listed(p_TTcm)}" mass="{mass_kg}"
                fullinertia="{listed(moments_and_products(I_T))}"/>
      {mesh_geoms("tool", problem.tool, f'contype="0" conaffinity="1" {surface}')}
    </body>
  </worldbody>
  <equality>
    <weld body1="handle" body2="tool" relpose="0 0 0 1 0 0 0" solref="{weld}"
          solimp="{_SOLIMP}" torquescale="{torquescale:.17g}"/>
  </equality>
</mujoco>
"""


def _solref(stiffness: float, damping: float, mass_kg: float) -> str:
    """Returns MuJoCo's attribute for a spring and damper, per mass."""
    scale = (1.0 - _IMPEDANCE) / mass_kg
    return f"{-stiffness * scale:.17g} {-damping * scale:.17g}"
