"""What is written is YAML that says what was changed."""

import pytest
import yaml

from drake_haptics.web.changes_yaml import write_changes


@pytest.mark.parametrize(
    "changes",
    [
        {"coupling": {"stiffness_N_per_m": 912.5, "damping_Ns_per_m": 0.0}},
        {"contact": {"clustering": "octree", "cluster_size_m": None}, "effects": {}},
        {
            "effects": {
                "gravity": {"acceleration_m_per_s2": [0, 0, -1.5]},
                "braking": {},
            }
        },
    ],
)
def test_it_can_be_read_back(changes):
    assert yaml.safe_load(write_changes(changes)) == changes


def test_nothing_is_written_of_no_change():
    assert write_changes({}) == ""
