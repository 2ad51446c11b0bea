"""What a study says when it cannot give every result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

# Failed tasks that a message tells of; all are in the error.
_TOLD = 5


@dataclass(frozen=True)
class TaskFailure:
    """A task that has no result.

    Attributes:
        index: Its place among the tasks.
        task: The task.
        reason: Type and message of the exception.
        traceback: That of the process that computed it, for people.
    """

    index: int
    task: Any
    reason: str
    traceback: str

    def __str__(self) -> str:
        """Returns one line."""
        return f"task {self.index}, {self.task!r}: {self.reason}"


class StudyError(RuntimeError):
    """Some tasks of a study have no result; the others have.

    Attributes:
        results: A result per task, in their order; None where there is none.
        failures: The tasks whose function raised, in their order. Tasks that nobody
            came to, because the executor broke, are not among them.
    """

    def __init__(
        self, message: str, results: Sequence[Any], failures: Sequence[TaskFailure]
    ):
        super().__init__("\n".join([message, *_tell(failures)]))
        self.results = list(results)
        self.failures = tuple(failures)


def _tell(failures: Sequence[TaskFailure]) -> list[str]:
    lines = [f"  {failure}" for failure in failures[:_TOLD]]
    if len(failures) > _TOLD:
        lines.append(f"  and {len(failures) - _TOLD} more, see failures")
    if failures:
        lines.append(f"Where the first failed:\n{failures[0].traceback.rstrip()}")
    return lines
