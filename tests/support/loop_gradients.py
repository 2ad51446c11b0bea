"""Derivatives of a scene's whole loop over one period, against differences.

The loop is brought into contact by simulation. Its sampled map is differentiated: the
update of all discrete state, and the rates with the updated state held.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context
from twin_check import differentiate, differentiate_to_one_side

from drake_haptics import find_scene, load_scene
from drake_haptics.analysis.diagram_systems import find_state_layout, find_timings
from drake_haptics.analysis.sampled_map import SampledMap, SampledValues, get_state
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.scene.settings import change_scene

# Between looks for contact, s.
_LOOK_S = 0.01
# Of the differences, in m, rad, m/s, rad/s, N or N·m: a smaller one where there is a
# kink within the larger one.
_STEPS = (1e-6, 1e-7, 1e-8)
# Differences to either side agree this well, relative to the size of their row, and so
# do those of a step and of its double, unless there is a kink at the state or within
# the steps.
_SMOOTH = 1e-6
# Of a row, in units of the state: what is smaller, such as a grip that is zero but for
# round-off, cannot be told from the rounding of the differences.
_SMALLEST = 1e-2


def build_scene(name: str, *settings: str) -> HapticDiagram:
    """Returns a shipped scene, ready to run, with settings as of `--set`."""
    return BuildHapticDiagram(change_scene(load_scene(find_scene(name)), settings))


def contact_states(loop: HapticDiagram, count: int, until_s: float) -> list[Context]:
    """Returns root contexts in contact, spread evenly over a run's time in contact."""
    touching = list(_run(loop, until_s))
    assert len(touching) >= count, "the run hardly touches anything"
    chosen = np.linspace(0, len(touching) - 1, count + 2)[1:-1].round().astype(int)
    return [touching[i] for i in chosen]


def _run(loop: HapticDiagram, until_s: float) -> Iterator[Context]:
    simulator = Simulator(loop.diagram)
    F_To_W = loop.diagram.GetOutputPort("F_To_W")
    while simulator.get_context().get_time() < until_s:
        simulator.AdvanceTo(simulator.get_context().get_time() + _LOOK_S)
        context = simulator.get_context()
        if F_To_W.Eval(context).any():
            yield context.Clone()


@dataclass(frozen=True)
class LoopGradients:
    """Both derivatives of one state, rows of the update above those of the rates.

    Attributes:
        values: (rows,) differentiated values.
        found: (rows, n) derivatives by AutoDiffXd.
        expected: (rows, n) derivatives by differences; NaN in columns where these tell
            of a kink.
        is_varied: (n,) whether each column is compared; the others are NaN too.
        num_updated: Number of rows of the update.
    """

    values: np.ndarray
    found: np.ndarray
    expected: np.ndarray
    is_varied: np.ndarray
    num_updated: int

    @property
    def is_kink(self) -> np.ndarray:
        """Columns (n,) that have no derivative that differences could tell."""
        return self.is_varied & np.isnan(self.expected).any(axis=0)

    @property
    def errors(self) -> np.ndarray:
        """Differences (rows, n) relative to the size of their row, or NaN.

        That is its largest derivative, or its value, as of the real part of a
        quaternion near 1, which hardly changes.
        """
        sizes = _size_rows(
            self.values, np.fmax(np.abs(self.expected), np.abs(self.found))
        )
        return np.abs(self.found - self.expected) / sizes


def calc_gradients(loop: HapticDiagram, context: Context) -> LoopGradients:
    """Differentiates update and rates by the whole state, both ways."""
    one_period = SampledMap(loop.diagram, context, find_timings(loop.diagram, context))
    x, u = one_period.x, one_period.u
    held = one_period.hold(x, u)

    def move(step: np.ndarray) -> np.ndarray:
        return _stack(one_period.calc(x + step, held + step, u))

    n, values = len(x), _stack(one_period.calc(x, held, u))
    found = one_period.differentiate(x, held, u)
    expected = np.full((len(values), n), np.nan)
    is_varied = find_varied(loop, context)
    for step in _STEPS:
        left = np.flatnonzero(is_varied & np.isnan(expected).any(axis=0))
        if len(left):
            expected[:, left] = _differentiate(move, np.eye(n)[left], step)
    return LoopGradients(values, _stack(found), expected, is_varied, len(found.update))


def find_varied(loop: HapticDiagram, context: Context) -> np.ndarray:
    """Returns which numbers of the state mean something now.

    Empty slots of friction's memory do not: they hold no contact.
    """
    is_varied = np.ones(len(get_state(context)), dtype=bool)
    friction = loop.loop.effects.friction
    if friction is None:
        return is_varied
    own = friction.GetMyContextFromRoot(context)
    memory = own.get_discrete_state_vector().value()
    names = find_state_layout(loop.diagram).names
    start = names.index(f"{friction.get_name()}/xd[0]")
    first_empty = start + np.flatnonzero(memory)[-1] + 1
    is_varied[first_empty : start + len(memory)] = False
    return is_varied


def _differentiate(
    move: Callable[[np.ndarray], np.ndarray], axes: np.ndarray, step: float
) -> np.ndarray:
    """Returns differences along axes (k, n) as columns, NaN where there is a kink."""

    def along(s: np.ndarray) -> np.ndarray:
        return move(s @ axes)

    at = np.zeros(len(axes))
    fine, coarse = (differentiate(along, at, k * step) for k in (1, 2))
    after, before = (differentiate_to_one_side(along, at, k * step) for k in (1, -1))
    spread = np.maximum(np.abs(coarse - fine), np.abs(after - before))
    is_kink = spread > _SMOOTH * _size_rows(along(at), fine)
    return np.where(is_kink.any(axis=0), np.nan, fine)


def _size_rows(values: np.ndarray, jacobian: np.ndarray) -> np.ndarray:
    """Returns the size (rows, 1) of each row."""
    largest = np.maximum(np.abs(jacobian).max(axis=1), np.abs(values))
    return np.maximum(largest, _SMALLEST)[:, np.newaxis]


def _stack(values: SampledValues) -> np.ndarray:
    return np.concatenate([values.update, values.rates])
