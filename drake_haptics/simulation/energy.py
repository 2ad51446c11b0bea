"""Accounts for the energy of a haptic loop."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from pydrake.systems.framework import Context, OutputPort

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.loop.haptic_loop import HapticLoop
from drake_haptics.systems.contact.contact_clustering import ClusteringRule
from drake_haptics.systems.contact.penalty_force import ContactGains


class EnergyLedger:
    """Accounts for the energy that flows through each part of a loop, tick by tick.

    ::

        ledger = EnergyLedger(loop, simulator.get_context())
        simulator.Initialize()
        ledger.add()
        simulator.set_monitor(lambda context: ledger.add())
        simulator.AdvanceTo(10.0)
        print(ledger.to_dict()["device"])

    The parts form a chain: `display` (limits and hold of the device, and passivity
    control), `coupling`, `tool`, and each source of a wrench on the tool by the name of
    its port (`contact`, `friction`, `braking`, `gravity`). The energy that leaves one
    enters its neighbor. `device` is all of them together, as seen at the device's port.
    `core/tool/tick_energy.h` derives the energy of a tick, and how much the sampling of
    a force can seem to create.

    Objects are assumed to stand still: the work of a moving object on the tool appears
    as energy created by the source of the force. When gains are changed in the context,
    the tick that begins with them is left out, and so is the energy that the change
    adds to springs or removes from them.
    """

    def __init__(self, loop: HapticLoop, root: Context):
        """Constructs a ledger without an entry.

        Args:
            loop: Return value of `AddHapticLoop`.
            root: Root context of the diagram that contains the loop.
        """
        sources = dict(loop.wrench_sources)
        coupling = sources.pop("coupling")
        self._read_gains = _make_gains_reader(loop, root)
        self._gains = self._read_gains()
        self._ledger = _core.EnergyLedger(
            loop.haptic_tool.dynamics,
            self._gains.coupling,
            pose_to_vector(loop.virtual_coupling.X_HT),
            loop.haptic_tool.step_period_s,
            list(sources),
        )
        self._tool = loop.haptic_tool.GetMyContextFromRoot(root)
        self._X_WH = _reader(loop.device.GetOutputPort("X_WH"), root)
        self._F_Ho_W_rendered = _reader(
            loop.device.GetOutputPort("F_Ho_W_rendered"), root
        )
        self._coupling = _reader(coupling, root)
        self._sources = [_reader(port, root) for port in sources.values()]
        stored = _make_stored_readers(loop, root, lambda: self._gains)
        self._stored = [stored.get(name, lambda: 0.0) for name in sources]

    def __repr__(self) -> str:
        device = self.to_dict()["device"]
        return (
            f"EnergyLedger({device['in']:.3g} J from the hand, {device['out']:.3g} J "
            f"back to it, {device['created']:.3g} J from nothing)"
        )

    def add(self) -> None:
        """Adds the tool's step since the last call; the first call only begins one.

        Call it once after `Simulator.Initialize` and then after every step of the tool,
        which is a tick unless `device.servo_rate_hz` gives it more, as from a monitor.
        The next step needs everything that it reads, so that nothing is
        computed twice.
        """
        gains = self._read_gains()
        if gains != self._gains:
            self._gains = gains
            self._ledger.begin_again(gains.coupling)
        self._ledger.add(
            self._tool.get_discrete_state(0).value(),
            self._X_WH(),
            self._F_Ho_W_rendered(),
            self._coupling(),
            [read() for read in self._sources],
            [read() for read in self._stored],
        )

    def to_dict(self) -> dict[str, dict[str, float]]:
        """Returns the energies so far, by the name of the part, ready for JSON.

        Each has, in J:

        * `in`, `out`: energy into and out of the part through all its ports; `net`:
          their difference. For `device`, `in` comes from the hand.
        * `stored`: the energy that it holds now, in the spring of the coupling,
          compressed contacts, or the tool's speed and height.
        * `lost`: `net` minus the increase of `stored`; `damped` is the part that
          dampers take. Slip and the implicit step take the rest.
        * `created`: energy from nothing, which is the largest decrease of `lost` over
          any interval, since lost energy never comes back.
        * `bound`: the part of it that the sampling of forces explains.
        * `beyond`: the most energy created over any interval beyond what sampling
          explains. More than round-off means that a force creates energy.
        """
        return {
            name: {
                "in": account.in_J,
                "out": account.out_J,
                "net": account.in_J - account.out_J,
                "stored": account.stored_J,
                "lost": account.lost_J,
                "damped": account.damped_J,
                "created": account.created_J,
                "bound": account.bound_J,
                "beyond": account.beyond_J,
            }
            for name, account in self._ledger.accounts.items()
        }


def _reader(port: OutputPort, root: Context) -> Callable[[], Any]:
    """Returns a function that evaluates a port."""
    context = port.get_system().GetMyContextFromRoot(root)
    return lambda: port.Eval(context)


class _Gains(NamedTuple):
    """The gains in a context that determine the energy of springs.

    Contact has no gains under `contact.law: constraint`.
    """

    coupling: _core.CouplingGains
    contact: ContactGains | None = None
    clustering: ClusteringRule | None = None


def _make_gains_reader(loop: HapticLoop, root: Context) -> Callable[[], _Gains]:
    """Returns a function that reads the gains of a context."""
    coupling, penalty = loop.virtual_coupling, loop.penalty
    if penalty is None:
        own = coupling.GetMyContextFromRoot(root)
        return lambda: _Gains(coupling.get_gains(own))
    force, clustering = penalty.penalty_force, penalty.contact_clustering
    contexts = [
        part.GetMyContextFromRoot(root) for part in (coupling, force, clustering)
    ]
    return lambda: _Gains(
        coupling.get_gains(contexts[0]),
        force.get_gains(contexts[1]),
        clustering.get_rule(contexts[2]),
    )


def _make_stored_readers(
    loop: HapticLoop, root: Context, get_gains: Callable[[], _Gains]
) -> dict[str, Callable[[], float]]:
    """Returns a function of the energy (J) of each source that stores some."""
    clusters = _reader(loop.clusters, root)

    def contact_energy() -> float:
        gains = get_gains()
        assert gains.contact is not None and gains.clustering is not None
        stiffness = gains.contact.stiffness_N_per_m.tolist()
        return _core.contact_energy(clusters(), stiffness, gains.clustering.tolerance_m)

    readers: dict[str, Callable[[], float]] = {}
    if loop.penalty is not None:
        readers["contact"] = contact_energy
    if (friction := loop.effects.friction) is not None:
        friction_force = _reader(friction.GetOutputPort("friction_force"), root)
        readers["friction"] = lambda: friction_force().stored_J
    if (gravity := loop.effects.gravity) is not None:
        X_WT = _reader(loop.haptic_tool.GetOutputPort("X_WT"), root)
        weight_W, p_TTcm = gravity.weight_W_N, gravity.p_TTcm
        readers["gravity"] = lambda: _core.weight_energy(X_WT(), p_TTcm, weight_W)
    return readers
