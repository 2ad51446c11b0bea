"""The paper's published figures (section 6)."""

from __future__ import annotations

from typing import NamedTuple

# Rate of the whole simulation of cup and spoon, "up to 30 contacts" (6.2).
CUP_SPOON_RATE_HZ = 500.0
CUP_SPOON_CONTACTS = 30
# "Greater than KHz" with few contacts (6.3).
FEW_CONTACTS_RATE_HZ = 1000.0
# Time of one penetration depth, "regardless of the complexity of objects" (6.3).
DEPTH_SECONDS = 1e-4
# The auxiliary machine room, and the part of it that the tool touches (6.1).
ROOM_OBJECTS, ROOM_TRIANGLES = 897, 195_926
TOUCHED_OBJECTS, TOUCHED_TRIANGLES = 17, 3_810
MACHINE = "dual 1 GHz Pentium III, 2003"


class TableRow(NamedTuple):
    """A row of the paper's Table 1."""

    model: str
    pieces: int
    triangles: int


TABLE_1 = (
    TableRow("Torus", 67, 2_000),
    TableRow("Cup", 190, 500),
    TableRow("Spoon", 78, 336),
    TableRow("Hammer", 425, 1_692),
    TableRow("Armadillo", 9_098, 31_240),
    TableRow("Digestive System", 9_913, 24_846),
)
