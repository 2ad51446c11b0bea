"""Counts how a library answers all poses of a hard case."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np
from exact_minkowski import ExactPair
from hard_cases import Passage
from pair_peers import Query
from pair_verdict import Verdict, judge

# From this error on, as a share of the size, a distance is grossly wrong.
GROSS_SHARE = 1e-3


@dataclass(frozen=True)
class Library:
    """A library and the way to ask it.

    Attributes:
        make: Returns a query of two vertex sets; raises for bodies it cannot hold.
        is_tracked: Whether a depth need only be a proven local minimum.
        is_warm: Whether the query remembers; each pose is asked in turn and once more
            afresh.
    """

    make: Callable[[np.ndarray, np.ndarray], Query]
    is_tracked: bool = False
    is_warm: bool = False


@dataclass
class Score:
    """The answers of one library to all questions of a case.

    Attributes:
        asked: Number of questions.
        refused: Number of questions about bodies that the library cannot hold; not
            asked.
        wrong: Number of answers with any complaint.
        gross: Number of answers that are not finite, exceptions, or grossly wrong
            distances.
        not_global: Number of right answers that are a local but not the exact depth.
        worst: Largest error of a finite distance, as a share of the size.
        complaints: First complaints, in words.
    """

    asked: int = 0
    refused: int = 0
    wrong: int = 0
    gross: int = 0
    not_global: int = 0
    worst: float = 0.0
    complaints: list[str] = field(default_factory=list)

    def add(self, where: str, verdict: Verdict) -> None:
        """Counts one answer."""
        self.asked += 1
        self.gross += not verdict.error <= GROSS_SHARE
        if np.isfinite(verdict.error):
            self.worst = max(self.worst, verdict.error)
        if not verdict.complaints:
            self.not_global += not verdict.is_global
            return
        self.wrong += 1
        if len(self.complaints) < 5:
            self.complaints.append(f"{where}: {'; '.join(verdict.complaints)}")


def ask(
    query: Query,
    exact: ExactPair,
    k: int,
    passage: Passage,
    tracked: bool,
    judged: dict[tuple[bool, bytes], Verdict],
) -> Verdict:
    """Returns the verdict on a library's answer at pose k, or on its exception.

    Answers that were judged at this pose are kept in `judged`: most come again to the
    last bit.
    """
    try:
        answer = query(passage.X_WA[k], passage.X_WB[k])
    except (RuntimeError, ValueError) as error:
        return Verdict(np.inf, (f"raises {error}",), False)
    parts = (answer.distance, *answer.nhat_BA_W, *answer.p_WCa, *answer.p_WCb)
    key = (tracked, np.array(parts).tobytes())
    if key not in judged:
        judged[key] = judge(exact, answer, tracked)
    return judged[key]


def score_case(
    passages: Iterable[Passage], libraries: dict[str, Library]
) -> dict[str, Score]:
    """Asks each library at each pose of a case."""
    scores = {name: Score() for name in libraries}
    for number, passage in enumerate(passages):
        count = len(passage.X_WA)
        queries = {}
        for name, library in libraries.items():
            try:
                queries[name] = library.make(passage.A, passage.B)
            except (RuntimeError, ValueError):
                scores[name].refused += count
        for k in range(count):
            exact = ExactPair(passage.A, passage.B, passage.X_WA[k], passage.X_WB[k])
            judged: dict[tuple[bool, bytes], Verdict] = {}
            for name, query in queries.items():
                library = libraries[name]
                fresh = library.make(passage.A, passage.B) if library.is_warm else None
                for how, asked in (("in turn", query), ("afresh", fresh)):
                    if asked is not None:
                        where = f"passage {number}, pose {k}, {how}"
                        verdict = ask(
                            asked, exact, k, passage, library.is_tracked, judged
                        )
                        scores[name].add(where, verdict)
    return scores
