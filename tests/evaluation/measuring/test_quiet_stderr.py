"""What libraries say is dropped while asked, and nothing else is."""

from __future__ import annotations

import os
import sys

import pytest

from drake_haptics.evaluation.measuring.quiet_stderr import quiet_stderr


def test_only_what_is_written_meanwhile_is_dropped(
    capfd: pytest.CaptureFixture[str],
) -> None:
    os.write(2, b"before ")
    with pytest.raises(ZeroDivisionError), quiet_stderr():
        os.write(2, b"compiled ")
        _ = 1 / 0
    print("after", file=sys.stderr)
    assert capfd.readouterr().err == "before after\n"
