"""Parts are measured that were asked for, with their progress."""

import pytest

from drake_haptics.evaluation.paper import evaluation
from drake_haptics.evaluation.paper.evaluation import PARTS, Effort, evaluate_paper
from drake_haptics.evaluation.paper.scenarios import scenario_makers


@pytest.fixture
def one_scenario(monkeypatch):
    """Only the spoon, which is built in no time."""
    name, make = next(iter(scenario_makers(None).items()))
    monkeypatch.setattr(evaluation, "scenario_makers", lambda meshes: {name: make})


def test_parts_come_in_the_papers_order_with_progress(one_scenario):
    shown = []
    effort = Effort(
        profile_s=0.2,
        pen_s=0.1,
        presses=1,
        slide_ticks=5,
        force_repeats=2,
        instructions=False,
    )
    found = evaluate_paper(
        PARTS[::-1], effort, None, lambda what, share: shown.append((what, share))
    )
    assert len(found.table1) == 6
    assert [profile.name for profile in found.figure11] == ["spoon in cup"]
    # Less the first of the 200, that has no beginning, and 20 that warm up.
    assert len(found.figure11[0].tick_s) == 179
    assert [passed.triangles for passed in found.figure12] == [1280, 20480]
    assert found.analysis.depths.rows[0].instructions is None
    shares = [share for _, share in shown]
    assert shares == sorted(shares) and 0.0 <= shares[0] and shares[-1] <= 1.0
    parts = list(dict.fromkeys(what.partition(":")[0] for what, _ in shown))
    assert parts == list(PARTS)


def test_a_part_that_was_not_asked_for_is_not_there(one_scenario):
    found = evaluate_paper(["figure11"], Effort(profile_s=0.1))
    assert found.table1 == () and found.figure12 == () and found.analysis is None
    assert found.to_dict()["analysis"] is None
