"""A host's Python stalls: the device goes to zero force, without a fault, and back."""

import itertools
import subprocess
import sys
from pathlib import Path

from driver_process import WatchedLink, check_figures, device_command, running
from struct_host import ACTIVE, IDLE

HOST = Path(__file__).parents[1] / "support" / "stalling_host.py"


def test_a_stall_ends_the_force_and_nothing_else(tmp_path):
    file = tmp_path / "figures.json"
    with running(device_command(file, "--ttl-ms", 1000), file) as driver:
        with WatchedLink(driver.port) as link:
            host = subprocess.Popen(
                [sys.executable, HOST, str(link.port)], stdin=subprocess.PIPE, bufsize=0
            )
            try:
                link.wait_for(is_felt)
                host.stdin.write(b"s")  # stall
                still = link.wait_for(lambda s: s.gate == ACTIVE and s.force_N == 0.0)
                later = link.wait_for(lambda s: s.sequence > still.sequence + 300)
                host.stdin.write(b"g")  # go on
                link.wait_for(is_felt)
                host.stdin.write(b"e")  # end
                assert host.wait(120) == 0
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
    stalled = [s for s in states if still.sequence <= s.sequence <= later.sequence]
    assert len(stalled) > 200
    assert {s.force_N for s in stalled} == {0.0}


def is_felt(state):
    """Whether there is most of the force that the host asks for."""
    return state.force_N > 1.5
