"""A machine room of about 900 objects, and a wrench that works in it."""

from drake_haptics.evaluation.shapes.machine_room.instrument_panel import wrench_path
from drake_haptics.evaluation.shapes.machine_room.layout import make_machine_room
from drake_haptics.evaluation.shapes.machine_room.room import MachineRoom, PlacedShape
from drake_haptics.evaluation.shapes.machine_room.wrench import make_wrench

__all__ = [
    "MachineRoom",
    "PlacedShape",
    "make_machine_room",
    "make_wrench",
    "wrench_path",
]
