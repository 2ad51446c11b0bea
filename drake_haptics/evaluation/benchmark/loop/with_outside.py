"""Runs the loop with contacts of an outside library."""

from __future__ import annotations

import time
from dataclasses import asdict

import numpy as np

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.evaluation.benchmark.loop.problem import LoopCourse, LoopProblem
from drake_haptics.evaluation.benchmark.outside_library import (
    OutsideLibrary,
    PiecePairs,
)
from drake_haptics.evaluation.measuring.timing import steady_memory
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench


class OutsideLoop:
    """Law, coupling and step of this package, in Python; contacts of another library.

    The law is that of `NativeLoop`, but a contact of two overlapping faces is at the
    library's witness point.
    """

    def __init__(self, problem: LoopProblem, library: type[OutsideLibrary]):
        self._problem = problem
        scene = problem.scene
        self._arguments = (
            library,
            problem.tool,
            problem.objects,
            np.array([X.GetAsMatrix4() for X in problem.X_WO]),
            scene.contact.tolerance_m,
        )
        self._dynamics = _core.RigidToolDynamics(
            scene.tool.mass_kg, *problem.mass_properties()
        )
        self._gains = _core.CouplingGains(**asdict(scene.coupling))
        self._X_HT = pose_to_vector(problem.X_HT)
        count = len(problem.objects)
        self._rest = np.zeros((count, 3)), np.zeros((count, 6))
        self._contact_gains = tuple(
            np.full(count, gain)
            for gain in (
                scene.contact.stiffness_N_per_m,
                scene.contact.damping_Ns_per_m,
            )
        )

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        return self._run()[0]

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        with steady_memory():
            return self._run()[1]

    def _run(self) -> tuple[LoopCourse, np.ndarray]:
        """Returns the course of the loop, and the time (n,) of each tick, s."""
        motion, n = self._problem.motion, len(self._problem.motion)
        tolerance_m = self._problem.scene.contact.tolerance_m
        pairs = PiecePairs(*self._arguments)
        state = np.concatenate([self._problem.X_WG[0], np.zeros(6)])
        X_WT, count = np.empty((n, 7)), np.zeros(n, dtype=int)
        nearest, seconds = np.zeros(n), np.empty(n)
        for k in range(n):
            start = time.perf_counter()
            X_WT[k] = state[:7]
            found, owners = pairs.find(vector_to_pose(state[:7]).GetAsMatrix4())
            contacts = _core.contact_set(
                np.array([c.distance for c in found]),
                np.array([c.nhat_BA_W for c in found]).reshape(-1, 3),
                np.array([c.p_WCa for c in found]).reshape(-1, 3),
                np.array([c.p_WCb for c in found]).reshape(-1, 3),
                owners,
            )
            contact = _core.penalty_force(
                _core.share_stiffness(contacts, tolerance_m),
                state[4:7],
                state[7:],
                *self._rest,
                *self._contact_gains,
            ).wrench_model
            coupling = coupling_wrench(
                motion.X_WH[k],
                motion.V_WH[k],
                self._X_HT,
                state[:7],
                state[7:],
                self._gains,
            )[: len(contact)]
            state = self._dynamics.step(state, contact + coupling, motion.period_s)
            seconds[k] = time.perf_counter() - start
            count[k] = len(found)
            nearest[k] = min((c.distance for c in found), default=0.0)
        force_N = self._problem.spring_force(X_WT[:, 4:])
        return LoopCourse(X_WT, count, nearest, force_N), seconds
