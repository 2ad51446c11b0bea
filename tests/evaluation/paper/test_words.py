"""Sentences on the paper follow the figures, whichever way they are."""

from dataclasses import replace

import numpy as np
import pytest
from paper_samples import (
    make_analysis,
    make_evaluation,
    make_forces,
    make_profile,
    make_table1,
)

from drake_haptics.evaluation.paper.pen_pass import OURS
from drake_haptics.evaluation.paper.profile import sum_up
from drake_haptics.evaluation.paper.words import (
    judge_analysis,
    judge_figure12,
    judge_run,
    judge_table1,
)


def verdicts(statements):
    return [statement.verdict for statement in statements]


def find(statements, words):
    (found,) = [s for s in statements if words in s.text]
    return found


def test_pieces_are_compared_row_by_row():
    fewer, more, lacks = judge_table1(make_table1())
    assert fewer.verdict == "better" and "Torus (own shape) 54 for 67" in fewer.text
    assert more.verdict == "differs" and "Cup (cup_500.obj) 197 for 190" in more.text
    assert lacks.verdict == "not measured" and "Armadillo" in lacks.text
    assert verdicts(judge_table1(make_table1()[:1])) == ["better"]


@pytest.mark.parametrize(
    ("disturbed_us", "verdict", "words"),
    [
        (399.0, "better", "less than 399 µs, 5.0 times the paper's 500 Hz, and 100.00"),
        (401.0, "agrees", "less than 401 µs, 5.0 times the paper's 500 Hz, and 100.00"),
        (1800.0, "agrees", "than 1,800 µs, 1.1 times the paper's 500 Hz, and 0.00"),
        (5e3, "differs", "less than 5,000 µs, 0.4 times the paper's 500 Hz, and 0.00"),
    ],
)
def test_the_disturbed_rate_is_compared_with_the_papers(disturbed_us, verdict, words):
    """However fast the ticks are that nothing disturbed."""
    profile = make_profile(tick_us=100.0)
    profile = replace(
        profile, disturbed_s=np.full(profile.disturbed_s.shape, 1e-6 * disturbed_us)
    )
    rate = find(judge_run(sum_up(profile)), "99 of 100")
    assert rate.verdict == verdict
    assert "Undisturbed, half of the ticks" in rate.text
    assert "99 of 100 less than 100 µs, which is 10,000 Hz." in rate.text
    assert words in rate.text


def test_contacts_and_overhead_are_compared():
    statements = judge_run(sum_up(make_profile()))
    assert find(statements, "Up to 20 contacts").verdict == "agrees"
    overhead = find(statements, "100 % more where objects penetrate")
    assert overhead.verdict == "differs"
    profile = make_profile()
    quick = replace(profile, query_s=0.9 * profile.query_s.min() + 0 * profile.query_s)
    same = judge_run(sum_up(quick))
    assert find(same, "0 % more").verdict == "agrees"
    few = replace(profile, contacts=profile.contacts // 4)
    statement = find(judge_run(sum_up(few)), "Up to 5 contacts")
    assert statement.verdict == "differs"


@pytest.mark.parametrize(
    ("figure", "at_most"), [("11-(a)", "Up to 5"), ("11-(c)", "897 objects")]
)
def test_the_beginning_of_a_path_leaves_open_what_happens_at_most(figure, at_most):
    profile = make_profile(figure=figure, touched=9)
    profile = replace(profile, contacts=profile.contacts // 4)
    whole = judge_run(sum_up(profile))
    begun = judge_run(sum_up(profile), is_cut_short=True)
    assert find(whole, at_most).verdict == "differs"
    assert find(begun, at_most).verdict == "not measured"
    assert "cut short" in find(begun, at_most).text
    # A difference that was measured is one, on the beginning of a path too.
    assert find(begun, "100 % more where").verdict == "differs"
    assert [s for s in begun if at_most not in s.text] == [
        s for s in whole if at_most not in s.text
    ]


def test_the_room_must_be_the_papers():
    room = make_profile(figure="11-(c)", touched=17)
    assert find(judge_run(sum_up(room)), "897 objects").verdict == "agrees"
    other = make_profile(figure="11-(c)", touched=9)
    assert find(judge_run(sum_up(other)), "897 objects").verdict == "differs"


@pytest.mark.parametrize(
    ("power", "verdict"), [(1.0, "agrees"), (0.3, "better"), (1.8, "differs")]
)
def test_the_growth_with_contacts_is_compared(power, verdict):
    contacts = 1 + np.arange(1000) // 100
    profile = replace(
        make_profile(),
        contacts=contacts,
        query_s=1e-5 * contacts.astype(float) ** power,
    )
    statement = find(judge_run(sum_up(profile)), f"power {power:.2f}")
    assert statement.verdict == verdict


def test_nearly_equal_numbers_of_contacts_show_no_growth():
    profile = make_profile()
    near = replace(profile, contacts=30 + np.arange(1000) // 200)
    assert sum_up(near).contact_growth is None


def test_a_run_in_one_state_says_nothing_of_the_other():
    profile = make_profile()
    apart = replace(profile, distance_m=abs(profile.distance_m))
    figures = sum_up(apart)
    assert figures.penetrating is None and figures.depth_overhead is None
    assert figures.deepest_m == 0.0
    assert not [s for s in judge_run(figures) if "penetrate" in s.text]


def test_smoothness_is_that_of_the_exact_depth():
    (passed,) = make_evaluation().figure12
    statements = judge_figure12([passed])
    assert find(statements, "Normal on").verdict == "agrees"
    ours = passed.smoothness[OURS]
    worse = replace(ours, normal_step_deg=3 * ours.normal_step_deg, crossing_step_m=1.0)
    jerky = replace(passed, smoothness={**passed.smoothness, OURS: worse})
    statements = judge_figure12([jerky])
    assert find(statements, "Normal on").verdict == "differs"
    assert "more than the exact depth" in find(statements, "Normal on").text
    assert find(statements, "Distance on").verdict == "differs"


def test_a_growth_of_nothing_has_no_sign():
    statements = judge_analysis(make_analysis(depth_exponent=-1e-4))
    assert "the power 0.00 of" in find(statements, "Depth over").text


def test_growths_are_compared():
    statements = judge_analysis(make_analysis())
    assert verdicts(statements) == ["agrees", "better", "agrees", "agrees", "differs"]
    assert "200 times less" in find(statements, "One depth").text
    assert "1 force for 256 contacts" in find(statements, "paper's clusters").text
    steep = make_analysis(depth_exponent=0.8, depth_us=300.0)
    statements = judge_analysis(replace(steep, forces=(make_forces("octree", 1.2),)))
    assert verdicts(statements) == ["differs", "differs", "agrees", "differs"]
