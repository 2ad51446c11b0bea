"""Six axes: the eigenvalues' limit is the simulation's, and not below one axis's."""

import pytest
from held_samples import load_held

from drake_haptics.analysis.stiffness_limits import find_stiffness_limits

# sphere_pen: acceptance/test_cli_stability.py. The peg is by the constraint law.
CASES = [
    ("cup_spoon", "translation", "this contact"),
    ("cup_spoon", "rotation", "a rigid wall"),
    ("peg_in_hole", "translation", "this contact"),
    ("peg_in_hole", "rotation", "this contact"),
    ("peg_in_hole", "translation", "a rigid wall"),
]


@pytest.mark.parametrize("case", CASES, ids=" ".join)
def test_eigenvalue_and_simulation_agree(case):
    name, kind, against = case
    limits = find_stiffness_limits(load_held(name), kind, against)
    assert limits.simulated == pytest.approx(limits.eigenvalue, rel=5e-3)
    if against == "a rigid wall":
        # One axis with the least inertia and damping is the worst direction.
        assert limits.eigenvalue > 0.99 * limits.one_axis
    else:
        # A contact gives way.
        assert limits.eigenvalue > limits.one_axis
