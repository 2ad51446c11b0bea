"""Sentences on the paper follow the figures, whichever way they are."""

from dataclasses import replace

import numpy as np
import pytest
from paper_samples import (
    make_analysis,
    make_evaluation,
    make_forces,
    make_profile,
    make_run,
    make_table1,
)

from drake_haptics.paper.pen_pass import OURS
from drake_haptics.paper.profile_figures import sum_up
from drake_haptics.paper.words import (
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
    assert fewer.verdict == "passes" and "Torus (own shape) 54 for 67" in fewer.text
    assert more.verdict == "differs" and "Cup (cup_500.obj) 197 for 190" in more.text
    assert lacks.verdict == "lacks" and "Armadillo" in lacks.text
    assert verdicts(judge_table1(make_table1()[:1])) == ["passes"]


@pytest.mark.parametrize(
    ("tick_us", "verdict", "words"),
    [
        (100.0, "passes", "10,000 Hz, 20.0 times the paper's 500 Hz. With all"),
        (1000.0, "agrees", "1,000 Hz, 2.0 times the paper's 500 Hz. With all"),
        (4000.0, "differs", "250 Hz, 0.5 times the paper's 500 Hz. With all"),
    ],
)
def test_the_rate_is_compared_with_the_papers(tick_us, verdict, words):
    rate = find(judge_run(make_run(tick_us=tick_us).figures), "99 of 100")
    assert rate.verdict == verdict
    assert words in rate.text
    held = "75.00 %" if tick_us < 1000.0 else "0.00 %"
    assert f"less than 5,000 µs, and {held} of the ticks held" in rate.text


def test_contacts_and_overhead_are_compared():
    statements = judge_run(make_run().figures)
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


def test_the_beginning_of_a_path_decides_nothing_but_the_rate():
    figures = make_run(figure="11-(c)", touched=9).figures
    rate, *others = judge_run(figures, is_cut_short=True)
    assert rate == judge_run(figures)[0]
    assert len(others) == len(judge_run(figures)) - 1 > 0
    assert {statement.verdict for statement in others} == {"lacks"}
    assert all("cut short" in statement.text for statement in others)


def test_the_room_must_be_the_papers():
    room = make_run(figure="11-(c)", touched=17)
    assert find(judge_run(room.figures), "897 objects").verdict == "agrees"
    other = make_run(figure="11-(c)", touched=9)
    assert find(judge_run(other.figures), "897 objects").verdict == "differs"


@pytest.mark.parametrize(
    ("power", "verdict"), [(1.0, "agrees"), (0.3, "passes"), (1.8, "differs")]
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
    assert verdicts(statements) == ["agrees", "passes", "agrees", "agrees", "differs"]
    assert "200 times less" in find(statements, "One depth").text
    assert "1 force for 256 contacts" in find(statements, "paper's clusters").text
    steep = make_analysis(depth_exponent=0.8, depth_us=300.0)
    statements = judge_analysis(replace(steep, forces=(make_forces("octree", 1.2),)))
    assert verdicts(statements) == ["differs", "differs", "agrees", "differs"]
