"""Thinned contacts: what each one that is left out must leave behind."""

import numpy as np
import pytest
from contact_samples import contacts_at
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_haptics import _core

TOLERANCE = 2e-3


def scatter(seed, count):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-0.05, 0.05, size=(count, 2))
    return contacts_at(xy, rng.uniform(-1e-3, 1e-3, count), TOLERANCE)


def columns(contacts):
    """Contacts as rows [distance, normal, point, object]."""
    return np.column_stack(
        [contacts.distance, contacts.nhat_BA_W, contacts.p_WC, contacts.object_index]
    )


@settings(max_examples=80)
@given(
    seed=st.integers(0, 10_000), count=st.integers(1, 40), cell=st.floats(1e-4, 5e-2)
)
def test_a_deeper_one_nearby_stands_for_each_that_is_left_out(seed, count, cell):
    contacts = scatter(seed, count)
    kept = _core.thin_contacts(contacts, cell)
    rows, left = columns(contacts), columns(kept)
    assert {tuple(row) for row in left} <= {tuple(row) for row in rows}
    for row in rows:
        near = np.linalg.norm(left[:, 4:7] - row[4:7], axis=1) < cell
        alike = left[:, 1:4] @ row[1:4] > np.sqrt(0.5)
        stays = (left == row).all(axis=1)
        assert (stays | (near & alike & (left[:, 0] <= row[0]))).any()


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), cell=st.floats(1e-3, 5e-2))
def test_none_that_is_kept_stands_for_another(seed, cell):
    kept = _core.thin_contacts(scatter(seed, 30), cell)
    apart = np.linalg.norm(kept.p_WC[:, None] - kept.p_WC[None], axis=2)
    alike = kept.nhat_BA_W @ kept.nhat_BA_W.T > np.sqrt(0.5)
    assert not (np.triu(alike, 1) & (apart < cell)).any()


def test_nothing_is_left_out_of_a_cell_of_no_size():
    contacts = scatter(3, 30)
    np.testing.assert_array_equal(
        columns(_core.thin_contacts(contacts, 0.0)), columns(contacts)
    )


def test_extents_are_taken_over():
    contacts = scatter(4, 30)
    kept = _core.thin_contacts(contacts, 0.02)
    assert len(kept) < len(contacts)
    np.testing.assert_allclose(kept.extent.sum(), contacts.extent.sum(), rtol=1e-12)


def test_what_stays_is_in_its_order():
    contacts = scatter(5, 30)
    order = [tuple(row) for row in columns(contacts)]
    places = [
        order.index(tuple(r)) for r in columns(_core.thin_contacts(contacts, 0.02))
    ]
    assert places == sorted(places)


@pytest.mark.parametrize("cell", [-1e-9, np.inf, np.nan])
def test_a_cell_that_is_none_is_refused(cell):
    with pytest.raises(ValueError, match="cell must be finite and at least 0"):
        _core.thin_contacts(scatter(6, 3), cell)
