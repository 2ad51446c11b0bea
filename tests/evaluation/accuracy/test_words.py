"""What the sentences on accuracy say of studies that are easy to reckon with."""

from dataclasses import replace

from accuracy_samples import make_peers, make_row, make_study

from drake_haptics.evaluation.accuracy.report import (
    describe_knees,
    describe_machine,
    describe_missing,
    describe_models,
    describe_peers,
    describe_reference,
    describe_verdict,
)

STUDY = make_study(peers=make_peers())


def test_the_verdict_advises_and_then_describes_the_scene():
    advice, figures = describe_verdict(STUDY)
    assert advice.startswith("Leave the scene as it is")
    assert figures == (
        "A tick of the scene as it is takes 150 µs (p99 300 µs), contact inside the"
        " core 24.0 µs of it. Its force is off by 0.004 N rms, 0.016 N at most."
    )


def test_the_most_exact_of_the_faster_knees_is_advised():
    scene = make_row("the scene", "as it is", 150.0, 100.0, 1e-9, is_scene=True)
    hull = make_row("tool.decomposition", "one hull", 120.0, 1.0, 1.0)
    good = make_row("tool.decomposition", "merged", 120.0, 10.0, 0.01)
    advice, _ = describe_verdict(make_study(scene, hull, good))
    assert advice == (
        "Leave the scene as it is, or if ticks must be faster take"
        " tool.decomposition merged: 10.0 µs in the core, a tick of 120 µs, for 0.010 N"
        " rms."
    )
    advice, _ = describe_verdict(make_study(scene))
    assert advice == (
        "Leave the scene as it is: no setting worth its error saves 10 % of a tick."
    )


def test_a_setting_that_beats_the_scene_is_named():
    scene = make_row("the scene", "as it is", 150.0, 24.0, 0.02, is_scene=True)
    better = make_row("tool.max_triangles", "900", 140.0, 6.0, 0.01)
    little = make_row("tool.max_triangles", "950", 150.0, 10.0, 0.0)
    model = make_row("contact.depth", "a", 140.0, 2.0, 0.0, contact__depth="tracked")
    words, _ = describe_verdict(make_study(scene, little, model, better))
    assert words == (
        "Take tool.max_triangles 900, which is faster and more exact: 6.00 µs in"
        " the core, a tick of 140 µs, for 0.010 N rms."
    )


def test_a_faster_setting_with_the_scenes_own_error_is_not_called_more_exact():
    scene = make_row("the scene", "as it is", 150.0, 24.0, 1e-9, is_scene=True)
    alike = make_row("tool.decomposition", "one hull", 140.0, 6.0, 0.0)
    words, _ = describe_verdict(make_study(scene, alike))
    assert "which is faster and as exact: 6.00 µs" in words


def test_a_scene_that_is_the_reference_is_exact():
    scene = make_row("the scene", "as it is", 150.0, 24.0, 1e-9, is_scene=True)
    _, figures = describe_verdict(make_study(scene))
    assert "Its force differs from the reference's by less than 0.001 N." in figures


def test_a_scene_that_touches_nothing_has_no_verdict():
    (words,) = describe_verdict(replace(STUDY, contact_ticks=0))
    assert words.startswith("The tool touched nothing in the ")
    assert "Leave the scene" not in words and "measure all of the motion" in words


def test_a_scene_without_figures_has_no_verdict():
    scene = make_row("the scene", "as it is", 150.0, 24.0, 1e-9, is_scene=True)
    broken = replace(scene, cost=None, errors=None, failure_reason="it diverges")
    words = describe_verdict(make_study(broken))
    assert words == ["The scene as it is could not be measured."]
    assert describe_missing(make_study(broken)) == ["the scene as it is: it diverges"]


def test_a_knee_is_compared_with_the_scene_and_its_neighbors():
    (words,) = describe_knees(STUDY)
    # 2.1 µs and 2.4 N on one side: 5.9 µs for 1.68 decades; 24 µs and 4 mN on the
    # other: 16 µs for 1.10.
    assert words.startswith("tool.max_triangles 200: 8.00 µs in the core")
    assert "145 µs, for 0.050 N rms, a third of the scene's time" in words
    assert "3.51 µs, beyond it 14.6" in words


def test_half_is_called_so():
    study = make_study(
        make_row("s", "as it is", 150.0, 20.0, 0.001, is_scene=True),
        make_row("k", "coarse", 150.0, 9.0, 5.0),
        make_row("k", "fine", 150.0, 10.1, 0.01),
    )
    (words,) = describe_knees(study)
    assert "half the scene's time" in words


def test_models_share_a_sentence_where_the_same_differs():
    gravity, friction = (
        make_row(f"effects.{name}", "off", 1.0, 1.0, 1.0, **{f"effects__{name}": None})
        for name in ("gravity", "friction")
    )
    assert describe_models(make_study(gravity, friction, friction)) == [
        "effects.gravity, effects.friction: what is felt besides contact"
    ]
    assert describe_models(make_study(make_row("a", "b", 1.0, 1.0, 1.0))) == []


def test_what_was_not_measured_is_told_once():
    reason = "the tool does not come to rest"
    rows = [make_row("a", str(i), 1.0, 1.0, 1.0, stiffness=None) for i in range(3)]
    rows = [
        replace(row, errors=replace(row.errors, stiffness_why_not=reason))
        for row in rows
    ]
    assert describe_missing(make_study(*rows)) == [
        f"stable stiffness of a 0, a 1, a 2: {reason}"
    ]
    assert describe_missing(STUDY) == [
        "decomposition CoACD: coacd is not installed",
        "coal 3.0.1, every pair: not installed",
    ]


def test_peers_reference_and_machine_are_named():
    assert describe_peers(STUDY) == [
        "MuJoCo 3.3.0, its own contacts: 30.0 µs, p99 60.0, for 0.600 N rms"
    ]
    assert describe_reference(STUDY).startswith(
        "Errors are against every contact by itself, exact global depth, at the same"
        " poses: 4800 ticks"
    )
    assert "4 cores" in describe_machine(STUDY)
    assert "read ratios" in describe_machine(STUDY)
