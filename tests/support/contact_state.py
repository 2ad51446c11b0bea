"""Contact states at random, and the chain from poses to wrenches as a function.

The derivatives of the chain are held against functions of doubles that ask the query
again at each displaced pose.
"""

from __future__ import annotations

import copy
import functools
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from autodiff_check import REACH, derivative_errors, flatten, flatten_gradients, seeded
from scipy.spatial.transform import Rotation
from touching_poses import touching_pose

from drake_haptics import _core
from drake_haptics._core import AutoDiffVector

T = 2e-3
METHODS = ("octree", "shared")
# Of the objects, in turn.
K, KV = np.array([1000.0, 600.0]), np.array([3.0, 5.0])
IDENTITY = np.array([1.0, 0, 0, 0, 0, 0, 0])


@dataclass(frozen=True, eq=False)
class WrenchJacobian:
    """Derivatives of the contact wrench on the tool at To, [N·m; N].

    Attributes:
        by_X: (1 + m, 6, 6) by displacements [rotation vector (rad); translation (m)]
            of the tool and of each object about its origin, in the world.
        by_V: (1 + m, 6, 6) by their spatial velocities [rad/s; m/s].
    """

    by_X: np.ndarray
    by_V: np.ndarray


@dataclass(frozen=True, eq=False)
class State:
    """The poses and velocities of a tool, and of objects that may overlap.

    Attributes:
        bodies: The tool and the objects.
        tracker: Tracker that knows the contacts near this state.
        method: Method of clustering.
        q: (1 + m, 7) poses of the bodies.
        V: (1 + m, 6) spatial velocities of the bodies.
    """

    bodies: tuple[_core.ConvexPieces, ...]
    tracker: _core.SceneTracker
    method: str
    q: np.ndarray
    V: np.ndarray

    @property
    def x(self) -> np.ndarray:
        """All variables: pose and velocity (13) of each body in turn."""
        return np.hstack([self.q, self.V]).ravel()

    def at(self, x: np.ndarray) -> State:
        """Returns the state with other variables."""
        rows = np.reshape(x, (-1, 13))
        return replace(self, q=rows[:, :7], V=rows[:, 7:])

    def displaced(self, body: int, by: np.ndarray) -> State:
        """Returns the state with one body turned and moved by a displacement (6,)."""
        q = self.q.copy()
        R = Rotation.from_rotvec(by[:3]) * Rotation.from_quat(q[body, [1, 2, 3, 0]])
        x, y, z, w = R.as_quat()
        q[body] = [w, x, y, z, *(q[body, 4:] + by[3:])]
        return replace(self, q=q)

    def faster(self, body: int, by: np.ndarray) -> State:
        """Returns the state with another velocity (6,) added to a body's."""
        V = self.V.copy()
        V[body] += by
        return replace(self, V=V)

    @functools.cached_property
    def contacts(self) -> _core.ContactSet:
        """The contacts of the query here."""
        tracker = copy.deepcopy(self.tracker)
        for i, q in enumerate(self.q[1:]):
            tracker.set_object_pose(i, q)
        return tracker.query(self.q[0])

    def cluster(self, contacts):
        """Returns clusters of contacts here, with derivatives if those have them."""
        if self.method == "octree":
            return _core.cluster_contacts(contacts, 2 * T, T)
        return _core.share_stiffness(contacts, T)

    def wrench(self) -> _core.PenaltyWrench:
        """Returns the chain of doubles."""
        clusters = self.cluster(self.contacts)
        m = len(self.bodies) - 1
        return _core.penalty_force(
            clusters,
            self.q[0, 4:],
            self.V[0],
            self.q[1:, 4:],
            self.V[1:],
            K[:m],
            KV[:m],
        )

    def differentiate_contacts(
        self, contacts: _core.ContactSet | None = None
    ) -> _core.AutoDiffContactSet:
        """The query's answer, or `contacts` of it, with its derivatives by `x`."""
        if contacts is None:
            contacts = self.contacts
        x = seeded(self.x)
        tool, *poses = (_rows(x, [13 * i], 7) for i in range(len(self.bodies)))
        return _core.differentiate_contacts(
            contacts, T, self.bodies[0], tool, list(self.bodies[1:]), poses
        )

    def differentiate_wrench(self) -> _core.AutoDiffPenaltyWrench:
        """The chain with its derivatives by `x`."""
        x = seeded(self.x)
        objects = 13 * np.arange(1, len(self.bodies))
        m = len(objects)
        return _core.penalty_force(
            self.cluster(self.differentiate_contacts()),
            _rows(x, [4], 3),
            _rows(x, [7], 6),
            _rows(x, objects + 4, 3),
            _rows(x, objects + 7, 6),
            K[:m],
            KV[:m],
        )

    def jacobian(self) -> WrenchJacobian:
        """The derivatives of the wrench on the tool, by turns and not quaternions."""
        by_x = self.differentiate_wrench().F_To_W.gradient
        by_X, by_V = [], []
        for body, q in enumerate(self.q):
            w, (x, y, z) = q[0], q[1:4]
            # A turn by a rotation vector changes the quaternion by half of it.
            by_turn = np.array([[-x, -y, -z], [w, z, -y], [-z, w, x], [y, -x, w]]) / 2
            columns = by_x[:, 13 * body : 13 * body + 13]
            by_X.append(np.hstack([columns[:, :4] @ by_turn, columns[:, 4:7]]))
            by_V.append(columns[:, 7:])
        return WrenchJacobian(np.array(by_X), np.array(by_V))

    def features(self) -> list[object]:
        """All that must stay for the derivatives to exist, as far as it is told."""
        contacts = self.contacts
        clusters = self.cluster(contacts)
        pieces = [contacts.object_index, contacts.piece_A, contacts.piece_B]
        columns = [*pieces, contacts.feature_A, contacts.feature_B, contacts.status]
        rows = np.column_stack(columns).tolist()
        approaches = self._speeds(clusters) < 0
        return [
            rows,
            clusters.label.tolist(),
            (clusters.compression > 0).tolist(),
            approaches.tolist(),
        ]

    def _speeds(self, clusters: _core.ClusterSet) -> np.ndarray:
        """Returns how fast surfaces part at each cluster, m/s."""

        def velocity(bodies: np.ndarray) -> np.ndarray:
            V, p = self.V[bodies], self.q[bodies, 4:]
            return V[:, 3:] + np.cross(V[:, :3], clusters.p_WC - p)

        objects = 1 + clusters.object_index
        relative = velocity(np.zeros_like(objects)) - velocity(objects)
        return np.einsum("ki,ki->k", clusters.nhat_BA_W, relative)


def _rows(vector: AutoDiffVector, starts: object, size: int) -> AutoDiffVector:
    """Parts of `size` entries from each start on."""
    rows = np.concatenate([np.arange(s, s + size) for s in np.asarray(starts)])
    return AutoDiffVector(vector.value[rows], vector.gradient[rows])


def keeps_features(state: State, reach: float) -> bool:
    """Tells whether features are the same wherever variables move by `reach`."""
    here, x = state.features(), state.x
    return all(
        state.at(x + sign * reach * axis).features() == here
        for axis in np.eye(len(x))
        for sign in (-1, 1)
    )


def random_states(
    tool: _core.ConvexPieces,
    solid: _core.ConvexPieces,
    method: str,
    count: int,
    *,
    num_objects: int = 2,
    seed: int = 0,
    touch: Callable[..., np.ndarray] = touching_pose,
) -> list[State]:
    """Random touches; a second object is a little beside the first.

    Args:
        tool: Tool that is moved there.
        solid: Shape of every object.
        method: Method of clustering.
        count: Number of states.
        num_objects: One or two.
        seed: Seed of all that is random.
        touch: Function that returns a pose (7,) of the tool at which it may touch.
    """
    rng = np.random.default_rng(seed)
    found = []
    while len(found) < count:
        q = touch(rng, tool, solid, T)
        beside = np.array([1, 0, 0, 0, *rng.uniform(-T, T, 3)])
        q = np.stack([q, IDENTITY, beside][: 1 + num_objects])
        tracker = _core.SceneTracker(tool, [solid] * num_objects, T)
        for i, q_WO in enumerate(q[1:]):
            tracker.set_object_pose(i, q_WO)
        # Deep inside, depth is walked to from tick to tick: let it arrive.
        for _ in range(4):
            tracker.query(q[0])
        V = 0.1 * rng.normal(size=(1 + num_objects, 6))
        state = State((tool, *[solid] * num_objects), tracker, method, q, V)
        if (state.contacts.distance < T).any():
            found.append(state)
    return found


def check_every_column(
    states: Iterable[State],
    evaluate: Callable[[State], object],
    differentiate: Callable[[State], object],
    columns: Sequence[str],
    step: float,
    parts: Mapping[str, object] | None = None,
) -> None:
    """Holds derivatives of a set by the whole state against differences.

    Args:
        states: Random states; those whose features change within a step are left out.
        evaluate: Function that returns a set of doubles.
        differentiate: Function that returns the same set with derivatives.
        columns: Columns of the set.
        step: Step of the differences.
        parts: Rows, by name, that are also held each for itself.
    """
    parts = dict(parts or {})
    errors: dict[str, list[float]] = {key: [] for key in (*columns, *parts)}
    for state in states:
        if not keeps_features(state, REACH * step):
            continue
        found, blocks = flatten_gradients(differentiate(state), columns)
        of_state = derivative_errors(
            lambda x, s=state: flatten(evaluate(s.at(x)), columns),
            found,
            state.x,
            step,
            blocks | parts,
        )
        for key, error in of_state.items():
            errors[key].append(error)
    for key, of_states in errors.items():
        assert len(of_states) >= 7, key
        assert np.median(of_states) < 1e-8, key
        assert max(of_states) < 1e-6, key
