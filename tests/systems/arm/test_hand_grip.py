"""What pages and docstrings say of the grips is what they are."""

import re
from dataclasses import asdict
from pathlib import Path

import pytest

from drake_haptics.scene.schema import HandParameters
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS

PAGE = Path(__file__).parents[3] / "docs" / "device-twin.md"
COLUMNS = (
    "stiffness_N_per_m",
    "damping_Ns_per_m",
    "mass_kg",
    "rotational_stiffness_Nm_per_rad",
    "rotational_damping_Nms_per_rad",
    "inertia_kgm2",
)


def read_table():
    """Returns the figures of each grip by its name."""
    text = PAGE.read_text(encoding="utf-8").partition("## The hand\n")[2]
    rows = re.findall(r"^\| `(\w+)` \| (.*) \|$", text.partition("\n## ")[0], re.M)
    return {name: [float(cell) for cell in row.split(" | ")] for name, row in rows}


def test_the_page_has_every_grip_and_all_of_its_figures():
    table = read_table()
    assert table.keys() == HAND_GRIPS.keys()
    for name, grip in HAND_GRIPS.items():
        figures = dict.fromkeys(COLUMNS, 0.0) if grip is None else asdict(grip)
        assert figures.keys() == set(COLUMNS)
        assert table[name] == [figures[column] for column in COLUMNS]


def test_the_docstring_of_a_scenes_hand_names_the_springs():
    said = re.search(
        r"springs of (\d+), (\d+) and (\d+) N/m", HandParameters.__doc__ or ""
    )
    springs = [grip.stiffness_N_per_m for grip in HAND_GRIPS.values() if grip]
    assert said is not None
    assert [float(number) for number in said.groups()] == springs


@pytest.mark.parametrize("name", ["light", "nominal", "firm"])
def test_a_grip_is_within_what_was_measured(name):
    """Ranges of Hasser and Cutkosky (2002) and Israr, Choi and Tan (2006)."""
    grip = HAND_GRIPS[name]
    assert 0.05 <= grip.mass_kg <= 0.3
    assert 1.0 <= grip.damping_Ns_per_m <= 20.0
    assert 50.0 <= grip.stiffness_N_per_m <= 1000.0
    assert 1e-4 <= grip.inertia_kgm2 <= 1e-3
    assert 0.002 <= grip.rotational_damping_Nms_per_rad <= 0.05
    assert 0.1 <= grip.rotational_stiffness_Nm_per_rad <= 3.0
