"""What holds for all tests."""

import os
import signal
import sys
from pathlib import Path

import hypothesis_profile
from skip_summary import skip_summary

# Matrices here are small, and several workers share the cores: threads of linear
# algebra would wait for one another, a hundred times longer than the work takes.
# Before anything imports NumPy; programs that tests start inherit it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Some containers tell Python to keep no bytecode. Then each of the hundreds of programs
# that tests start compiles all that it imports: most of a short program's time.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# A job in a shell's background is born deaf to Ctrl-C, one under nohup to the end of
# its terminal, and so would be the programs that tests start and end by these signals.
# What is caught here is not ignored there.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, lambda *_: None)

hypothesis_profile.load()

FOLDER = Path(__file__).parent
# The files that take longest, longest first: begun last, they would be waited for.
LONGEST = (
    "core/test_cpp.py",
    "acceptance/test_docs_site.py",
    "acceptance/cockpit_in_browser/test_picture_and_hands.py",
    "acceptance/cockpit_in_browser/test_values.py",
    "acceptance/test_cli_stability.py",
    "acceptance/test_cli_run.py",
    "stability/test_rest_cup_and_spoon.py",
    "stability/test_six_dof_limits.py",
    "acceptance/test_closed_loop_two_processes.py",
    "acceptance/test_tutorials.py",
    "acceptance/test_examples.py",
    "acceptance/test_readme.py",
    "acceptance/test_cli_accuracy.py",
    "stability/test_slow_ticks.py",
    "evaluation/benchmark/test_loop.py",
    "evaluation/accuracy/test_study.py",
    "consumer/test_whole_api.py",
)


def pytest_collection_modifyitems(items):
    """Puts the longest files first, as `LONGEST` has them; within a file as it is."""
    ranks = {FOLDER / name: rank for rank, name in enumerate(LONGEST)}
    items.sort(key=lambda item: ranks.get(item.path, len(ranks)))


def pytest_unconfigure(config):
    """Ends the run with a line that says what was not checked."""
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    if reporter is None or hasattr(config, "workerinput"):
        return
    skipped = reporter.stats.get("skipped", [])
    reporter.write_line(skip_summary(report.longrepr[2] for report in skipped))
