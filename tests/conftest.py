"""What holds for all tests."""

import os
import signal
from pathlib import Path

from skip_summary import skip_summary

# Matrices here are small, and several workers share the cores: threads of linear
# algebra would wait for one another, a hundred times longer than the work takes.
# Before anything imports NumPy; programs that tests start inherit it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A job in a shell's background is born deaf to Ctrl-C, one under nohup to the end of
# its terminal, and so would be the programs that tests start and end by these signals.
# What is caught here is not ignored there.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, lambda *_: None)

# The files that take longest, longest first: begun last, they would be waited for.
LONGEST = (
    "test_core_cpp.py",
    "test_readme.py",
    "test_cockpit_in_browser.py",
    "test_slow_ticks.py",
    "test_docs_site.py",
    "test_rest_cup_and_spoon.py",
    "test_six_dof_limits.py",
    "test_examples.py",
    "test_tutorials.py",
    "test_cli_stability.py",
    "test_closed_loop_two_processes.py",
    "test_accuracy_study.py",
    "test_stability_docs.py",
    "test_cli_accuracy.py",
    "test_types_consumer.py",
)


def pytest_collection_modifyitems(items):
    """Puts the longest files first, as `LONGEST` has them; within a file as it is."""
    ranks = {name: rank for rank, name in enumerate(LONGEST)}
    items.sort(key=lambda item: ranks.get(Path(item.path).name, len(ranks)))


def pytest_unconfigure(config):
    """Ends the run with a line that says what was not checked."""
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    if reporter is None or hasattr(config, "workerinput"):
        return
    skipped = reporter.stats.get("skipped", [])
    reporter.write_line(skip_summary(report.longrepr[2] for report in skipped))
