"""What the exit code of `drake-haptics` tells a script; docs/command-line.md has it."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """The same for all commands.

    Attributes:
        DONE: it is done. `run`, `device` and `decompose --show` end so at Ctrl-C too.
        UNUSABLE: what was given cannot be used, or the system refuses a file or a port.
        WRONG_CALL: there is no such command, option or value.
        NO: it is done, and the answer is no: a run became unstable or ended with its
            device at fault, two logs differ, no setting holds the budget.
        DEFECT: a defect of the program.
        INTERRUPTED: ended by Ctrl-C before it was done: 128 + SIGINT, as of shells.
    """

    DONE = 0
    UNUSABLE = 1
    WRONG_CALL = 2
    NO = 3
    DEFECT = 70
    INTERRUPTED = 130
