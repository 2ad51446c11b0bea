"""Records every tick of a haptic loop in a log."""

from __future__ import annotations

import math

from pydrake.common.value import Value
from pydrake.systems.framework import (
    Context,
    Diagram,
    DiagramBuilder,
    DiscreteValues,
    LeafSystem,
)
from pydrake.systems.primitives import Multiplexer

from drake_haptics._core import ClusterSet, ContactSet
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import DeviceReading
from drake_haptics.systems.framework.differentiable_system import (
    get_no_witness_functions,
)
from drake_haptics.tick_log.log_format import REALS, SIGNALS
from drake_haptics.tick_log.tick_recorder import TickRecorder


class TickLogSink(Diagram):
    """Passes the signals that the updates of a tick see to a `TickRecorder`.

    .. pydrake_system::

        name: TickLogSink
        input_ports:
        - X_WH
        - V_WH
        - F_Ho_W_commanded
        - F_Ho_W_rendered
        - X_WT
        - V_WT
        - status
        - contacts
        - clusters
        - reading (if there is one)

    The inputs are the outputs of these names of `HapticDevice`, `HapticTool`,
    `ContactQuery` and `ContactClustering`, and the wrench that is commanded to the
    device. `reading` is the `DeviceReading` of a device that is not simulated.

    It records them in a periodic discrete update from 0 s on, although it has no state,
    because only there do they have the values that the other updates of the tick
    sample. A publish event or a monitor runs before the device is read or after the
    tool has moved. Two Contexts of this system write to the same log, and a diagram
    with it does not convert to AutoDiffXd.
    """

    def __init__(
        self, recorder: TickRecorder, period_s: float, *, has_reading: bool = False
    ):
        """Constructs the system.

        Args:
            recorder: Recorder that writes the log.
            period_s: The tick, s.
            has_reading: Whether there is a port for a device's reading.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        builder = DiagramBuilder()
        # Drake joins the vectors, which takes less time than several ports in Python.
        signals = builder.AddNamedSystem(
            "signals", Multiplexer([*(len(REALS[name]) for name in SIGNALS), 1])
        )
        notes = builder.AddNamedSystem(
            "notes",
            _Notes(recorder, period_s, signals.get_output_port().size(), has_reading),
        )
        builder.Connect(signals.get_output_port(), notes.GetInputPort("signals"))
        for i, name in enumerate([*SIGNALS, "status"]):
            builder.ExportInput(signals.get_input_port(i), name)
        for name in ["contacts", "clusters"] + ["reading"] * has_reading:
            builder.ExportInput(notes.GetInputPort(name), name)
        builder.BuildInto(self)


class _Notes(LeafSystem):
    """The event of a `TickLogSink`."""

    DoGetWitnessFunctions = get_no_witness_functions

    def __init__(
        self, recorder: TickRecorder, period_s: float, size: int, has_reading: bool
    ):
        super().__init__()
        self._recorder = recorder
        self._signals = self.DeclareVectorInputPort("signals", size)
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._reading = None
        if has_reading:
            self._reading = self.DeclareAbstractInputPort("reading", Value[object]())
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._note)

    def _note(self, context: Context, _: DiscreteValues) -> None:
        signals = self._signals.Eval(context)
        contacts: ContactSet = self._contacts.Eval(context)
        clusters: ClusterSet = self._clusters.Eval(context)
        told, device_time_s = (0, 0, 0, 0), math.nan
        if self._reading is not None:
            reading: DeviceReading = self._reading.Eval(context)
            told = (
                reading.sequence & 0xFFFFFFFF,
                reading.buttons & 0xFFFFFFFF,
                int(reading.gate),
                int(reading.fault),
            )
            device_time_s = reading.time_s
        self._recorder.add(
            context.get_time(),
            signals[:-1],
            (len(contacts), len(clusters), int(signals[-1]), *told),
            query_s=contacts.query_seconds,
            distance_m=min(contacts.distance.tolist(), default=math.inf),
            device_time_s=device_time_s,
        )
