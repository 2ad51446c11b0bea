"""What all linear maps over a period have in common."""

import json

import numpy as np
import pytest

from drake_haptics.analysis.period_map import PeriodMap, check_return


def test_the_state_that_changes_most_for_its_size_is_named():
    x = np.array([1000.0, 0.1, 0.0])
    change = np.array([1e-6, 2e-9, -5e-9])
    assert check_return(x, change, ("a", "b", "c"), 1e-8) == pytest.approx(5e-9)
    with pytest.raises(ValueError, match="c changes by -5e-09 in one period"):
        check_return(x, change, ("a", "b", "c"), 1e-9)


def test_a_change_that_is_not_a_number_is_one():
    with pytest.raises(ValueError, match="b changes by nan"):
        check_return(np.zeros(2), np.array([0.0, np.nan]), ("a", "b"), 1e-8)


def test_a_map_goes_to_json():
    A = np.array([[0.0, -0.5], [0.5, 0.0]])
    found = PeriodMap(A, 0.5, ("q", "v"), np.zeros(2), (), 1e-12)
    assert found.spectral_radius() == pytest.approx(0.5)
    stored = json.loads(json.dumps(found.to_dict()))
    assert stored["state_names"] == ["q", "v"]
    assert stored["equilibrium_residual"] == 1e-12
    np.testing.assert_allclose(np.abs(stored["eigenvalues"]), [[0, 0.5], [0, 0.5]])
