"""A library from outside: one class in a file, and it stands in every table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.benchmark.benchmark import BenchFigures, make_tables
from drake_haptics.evaluation.benchmark.loop.figures import NATIVE, OURS
from drake_haptics.evaluation.benchmark.loop.problem import make_problem
from drake_haptics.evaluation.benchmark.loop.runs import run_loops
from drake_haptics.evaluation.benchmark.loop.this_package import NativeLoop, ThisLoop
from drake_haptics.evaluation.benchmark.loop.with_outside import OutsideLoop
from drake_haptics.evaluation.benchmark.outside_library import (
    OutsideScene,
    load_library,
    make_pair_library,
)
from drake_haptics.evaluation.benchmark.pair_runs import run_pair
from drake_haptics.evaluation.benchmark.pairs import make_pair
from drake_haptics.evaluation.benchmark.python_pairs import run_python_pair
from drake_haptics.evaluation.benchmark.scene_runs import (
    NAME,
    DrakeHapticsScene,
    run_scene,
)
from drake_haptics.evaluation.benchmark.scenes import SceneProblem, make_touches
from drake_haptics.evaluation.models import cut_shape

# Right but for a share, so that its errors are known.
TOY = '''
"""A toy."""
import numpy as np
from drake_haptics import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.outside_library import (
    OutsideContact,
    OutsideLibrary,
)


class Toy(OutsideLibrary):
    """This package's own query, a share too far."""

    name = "toy"
    version = "7"
    too_far = TOO_FAR

    def __init__(self, A_vertices, B_vertices):
        self._pair = ConvexPair(ConvexPolytope(A_vertices), ConvexPolytope(B_vertices))

    def query(self, X_WA):
        c = self._pair.query(X_WA, np.eye(4))
        distance = c.distance * (1 + self.too_far)
        return OutsideContact(distance, c.nhat_BA_W, c.p_WCa, c.p_WCb)
'''


def load_toy(folder: Path, too_far: float = 0.0):
    """The toy, from its file."""
    file = folder / "toy.py"
    file.write_text(TOY.replace("TOO_FAR", str(too_far)))
    return load_library(file)


def test_a_toy_stands_in_every_table(tmp_path: Path) -> None:
    pytest.importorskip("coal", reason="one query from Python is compared with coal's")
    toy = load_toy(tmp_path)
    pair = make_pair("ball", 42)
    libraries = [make_pair_library(toy)]
    from drake_haptics.evaluation.benchmark.libraries import with_drake_haptics

    box = cut_shape("peg")
    scene = SceneProblem(
        "small", box, [box], np.eye(4)[None], make_touches(box, box, 1, 0)
    )
    problem = make_problem(duration_s=0.3)
    figures = BenchFigures(
        machine={},
        pairs=run_pair(pair, [*with_drake_haptics.LIBRARIES, *libraries], 1, 3),
        python=[run_python_pair(pair, 3, [toy])],
        scenes=run_scene(
            scene,
            {NAME: DrakeHapticsScene(scene), toy.name: OutsideScene(scene, toy)},
            3,
        ),
        loop=run_loops(
            problem,
            {
                OURS: ThisLoop(problem),
                NATIVE: NativeLoop(problem),
                toy.name: OutsideLoop(problem, toy),
            },
            3,
        ),
    )
    tables = make_tables(figures)
    assert len(tables) == 7
    for table in tables:
        words = " ".join([*table.header, *(row[0] for row in table.rows)])
        assert "toy" in words, table.title
        assert all(len(row) == len(table.header) for row in table.rows)
    plain = figures.to_dict()
    assert BenchFigures.from_dict(plain).to_dict() == plain


def test_its_errors_are_found(tmp_path: Path) -> None:
    from drake_haptics.evaluation.benchmark.libraries import with_drake_haptics

    toy = load_toy(tmp_path, 0.01)
    libraries = [*with_drake_haptics.LIBRARIES, make_pair_library(toy)]
    *_, wrong = run_pair(make_pair("ball", 42), libraries, 1, 3)
    assert wrong.library == "toy" and wrong.outside and not wrong.ours
    assert wrong.max_relative_error == pytest.approx(0.01, rel=1e-3)
    assert wrong.wrong_share == 1.0 and wrong.exact_depth_share == 0.0


def test_it_finds_the_contacts_of_a_scene(tmp_path: Path) -> None:
    """Of one convex piece each, where no rule of surfaces leaves any out."""
    peg = cut_shape("peg")
    motion = make_touches(peg, peg, 1, 0)[0]
    X_WO = np.eye(4)
    X_WO[:3, 3] = [0.1, -0.2, 0.3]
    X_WT = X_WO @ motion
    problem = SceneProblem("small", peg, [peg], X_WO[None], [X_WT])
    mine = DrakeHapticsScene(problem).run(X_WT)
    its = OutsideScene(problem, load_toy(tmp_path)).run(X_WT)
    assert mine.num_contacts.max() == 1
    np.testing.assert_array_equal(its.num_contacts, mine.num_contacts)
    # A hull of points and a piece of a mesh take nearly flat quads as flat otherwise.
    np.testing.assert_allclose(its.nearest_m, mine.nearest_m, rtol=0, atol=2e-9)


def test_its_loop_does_what_the_native_one_does(tmp_path: Path) -> None:
    problem = make_problem("hammer_block", duration_s=1.0)
    native = NativeLoop(problem).observe()
    its = OutsideLoop(problem, load_toy(tmp_path)).observe()
    assert native.num_contacts.max() > 0 and its.num_contacts.max() > 0
    apart_m = np.linalg.norm(its.X_WT[:, 4:] - native.X_WT[:, 4:], axis=1)
    assert apart_m.max() < 2e-4
    assert its.force_N.max() == pytest.approx(native.force_N.max(), rel=0.05)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "must define one subclass of OutsideLibrary"),
        ("import a_library_that_nobody_has", "cannot be imported"),
        ("class", "cannot be imported"),
        ("{}['speed']", "cannot be imported: KeyError: 'speed'"),
        (TOY.replace("TOO_FAR", "0") + "\nclass Other(Toy):\n    pass", "it has 2"),
        (TOY.replace("TOO_FAR", "0").replace("def query", "def ask"), "it has 0"),
    ],
)
def test_a_file_without_a_class_is_told_what_to_do(
    tmp_path: Path, text: str, words: str
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(text)
    with pytest.raises(HapticsError, match=words):
        load_library(file)
    result = invoke("bench", "pairs", "--library", str(file))
    assert result.exit_code == 1 and words in " ".join(result.stderr.split())
