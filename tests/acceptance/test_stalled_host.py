"""A host's Python stalls: the device goes to zero force, without a fault, and back."""

import itertools
import subprocess
import sys
from pathlib import Path

from driver_process import WatchedLink, check_figures, device_command, running
from struct_host import ACTIVE, IDLE

HOST = Path(__file__).parents[1] / "stalling_host.py"


def test_a_stall_ends_the_force_and_nothing_else(tmp_path):
    file = tmp_path / "figures.json"
    with running(device_command(file, "--ttl-ms", 1000), file) as driver:
        with WatchedLink(driver.port) as link:
            host = subprocess.Popen([sys.executable, HOST, str(link.port)])
            try:
                assert host.wait(60) == 0
                link.wait_for(lambda state: state.gate == IDLE)
            finally:
                host.kill()
            link.check_limits()
            states = link.states
        figures = driver.end()
    check_figures(figures)
    assert figures["faults"] == {}
    # Idle, then active without a break, then idle.
    gates = [gate for gate, _ in itertools.groupby(s.gate for s in states)]
    assert gates == [IDLE, ACTIVE, IDLE]
    # Force, none for a while, force again.
    active = [s for s in states if s.gate == ACTIVE]
    groups = [list(g) for _, g in itertools.groupby(active, lambda s: s.force_N > 0.0)]
    pause = max(
        (i for i in range(1, len(groups) - 1) if groups[i][0].force_N == 0.0),
        key=lambda i: len(groups[i]),
    )
    assert len(groups[pause]) > 50
    for side in (groups[:pause], groups[pause + 1 :]):
        assert max(s.force_N for group in side for s in group) > 0.5
