"""A study comes back from JSON as it was, infinities included."""

import json
import math
from dataclasses import replace

from accuracy_samples import make_errors, make_peers, make_row, make_study

from drake_haptics.evaluation.accuracy.study_json import from_json_data, to_json_data


def test_a_study_comes_back_from_json():
    study = make_study(peers=make_peers())
    text = json.dumps(to_json_data(study), allow_nan=False)
    assert from_json_data(json.loads(text)) == study


def test_numbers_that_json_lacks_come_back():
    row = make_row("contact.depth", "none", 2.0, 1.0, 0.0, contact__depth="infinite")
    odd = replace(
        make_errors(math.inf, stiffness=None),
        energy_created_J=-math.inf,
        normal_jump_deg=math.nan,
    )
    study = make_study(replace(row, errors=odd))
    data = json.loads(json.dumps(to_json_data(study), allow_nan=False))
    (back,) = from_json_data(data).rows
    assert back.errors.force_rms_N == math.inf
    assert back.errors.energy_created_J == -math.inf
    assert math.isnan(back.errors.normal_jump_deg)
    assert back.errors.stable_stiffness_N_per_m is None
    # Words stay words.
    assert back.setting == row.setting
