"""Lets a device and a host run for long over a bad network, with faults all the time.

python tests/benchmarks/soak.py --minutes 10 --loss 0.01 --jitter-ms 2 --reorder 0.01

`drake-haptics device`, a relay that loses, delays and reorders packets, and a host
that runs the scene are three processes. Every few seconds something fails on purpose
(soak_injections.py), and the host takes the device up again by the documented step
(soak_host.py). The relay holds every state that the device sends against the limits.
Ends with a table, and with status 1 if a limit was broken or a fault not recovered.
"""

import argparse
import json
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1]))
from driver_process import device_command, running
from lossy_link import LossyLink, Trouble
from soak_injections import NAMES, Injections
from struct_host import ACTIVE, unpack_state

HOST = Path(__file__).with_name("soak_host.py")
# From the end of a trouble to the device at force again: with a host's start.
RECOVERY_S = 60.0


class StateWatch:
    """Counts what the device sends, and what it never may.

    Called in the relay's thread.
    """

    def __init__(self):
        self.states = 0
        self.over_limit = 0
        self.not_finite = 0
        self.max_force_N = 0.0
        self.max_torque_Nm = 0.0
        self.newest = None

    def __call__(self, packet):
        """Takes a state in."""
        state = unpack_state(packet)
        self.states += 1
        values = (*state.X_BH, *state.V_BH, *state.F_BH)
        if any(value - value != 0.0 for value in values):
            self.not_finite += 1
        # The limits are told in single precision.
        self.over_limit += not (
            state.force_N <= state.max_force_N * (1 + 1e-6)
            and state.torque_Nm <= state.max_torque_Nm * (1 + 1e-6)
            and (state.gate == ACTIVE or not any(state.F_BH))
        )
        self.max_force_N = max(self.max_force_N, state.force_N)
        self.max_torque_Nm = max(self.max_torque_Nm, state.torque_Nm)
        self.newest = state

    def wait_until_active(self, bound_s):
        """Returns whether the device is at force within that time."""
        end_s = time.monotonic() + bound_s
        while time.monotonic() < end_s:
            before = self.states
            time.sleep(0.05)
            if self.states > before and self.newest.gate == ACTIVE:
                return True
        return False


class HostKeeper:
    """The host's process, one after the other.

    Args:
        scene: What it runs.
        port: Where it finds the device.
    """

    def __init__(self, scene, port):
        self._command = [sys.executable, HOST, scene, f"udp://127.0.0.1:{port}"]
        self._start()

    def _start(self):
        self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE)

    @property
    def pid(self):
        """Of the process."""
        return self._process.pid

    def restart(self):
        """Kills it and starts another."""
        self.kill()
        self._start()

    def end(self):
        """Ends it as Ctrl-C does; returns its figures."""
        self._process.send_signal(signal.SIGINT)
        said, _ = self._process.communicate(timeout=30)
        return json.loads(said)

    def kill(self):
        """Ends it without a word."""
        self._process.kill()
        self._process.wait(10)
        self._process.stdout.close()


def soak(options, driver, link, watch, hosts, console):
    """Makes trouble until the time is over; returns how often, and what stayed."""
    injections = Injections(link, hosts, driver.pid)
    made, stayed = Counter(), Counter()
    start_s = time.monotonic()
    if not watch.wait_until_active(RECOVERY_S):
        raise SystemExit("the host never enabled the device")
    with console.status("") as line:
        while (passed_s := time.monotonic() - start_s) < 60.0 * options.minutes:
            name = NAMES[made.total() % len(NAMES)]
            line.update(
                f"{passed_s:.0f} of {60 * options.minutes:.0f} s"
                f" · {watch.states} states"
                f" · {made.total()} troubles, {stayed.total()} not recovered"
                f" · at most {watch.max_force_N:.2f} N · now {name}"
            )
            getattr(injections, name)()
            made[name] += 1
            # What the device makes of it may take as long as a command lives.
            time.sleep(0.5)
            if not watch.wait_until_active(RECOVERY_S):
                stayed[name] += 1
                hosts.restart()
            time.sleep(options.pause_s)
    return made, stayed


def make_table(figures, host, watch, link, made, stayed):
    """Returns what came of it, in rows of words and figures."""
    servo = host["device"]["servo_lateness_us"]
    return [
        ("ran", f"{figures['duration_s']:.0f} s, {figures['ticks']} ticks"),
        (
            "limit violations",
            f"{figures['limit_violations']} (seen from outside: {watch.over_limit})",
        ),
        (
            "not finite",
            f"{figures['non_finite_values']} (seen from outside: {watch.not_finite})",
        ),
        (
            "largest",
            f"{watch.max_force_N:.3f} of {figures['force_limit_N']:g} N,"
            f" {1e3 * watch.max_torque_Nm:.1f} of"
            f" {1e3 * figures['torque_limit_Nm']:g} mN·m",
        ),
        ("troubles made", _count(made)),
        ("not recovered", _count(stayed)),
        ("faults", _count(figures["faults"])),
        ("recoveries", _count(figures["recoveries"])),
        ("packets at the device", _count(figures["packets"])),
        ("packets on the way", _count(link.counts)),
        ("driver late", _describe_lateness(*_percentiles(figures))),
        ("host late", _describe_lateness(*_percentiles(host))),
        ("servo late", _describe_lateness(*servo)),
    ]


def _percentiles(figures):
    late = figures["lateness_us"]
    return late["p50"], late["p99"], late["p99_9"]


def _describe_lateness(p50, p99, p99_9):
    return f"p50 {p50:.0f} µs, p99 {p99:.0f} µs, p99.9 {p99_9:.0f} µs"


def _count(counts):
    return ", ".join(f"{n} {name.lower()}" for name, n in counts.items()) or "none"


def main():
    """Runs the soak."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--scene", default="torus_peg")
    parser.add_argument("--loss", type=float, default=0.01)
    parser.add_argument("--jitter-ms", type=float, default=2.0)
    parser.add_argument("--reorder", type=float, default=0.01)
    parser.add_argument("--ttl-ms", type=float, default=200.0)
    parser.add_argument("--pause-s", type=float, default=3.0, help="between troubles")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    console = Console(highlight=False)
    trouble = Trouble(
        loss=options.loss, jitter_s=1e-3 * options.jitter_ms, reorder=options.reorder
    )
    watch = StateWatch()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "figures.json"
        command = device_command(file, "--ttl-ms", options.ttl_ms, scene=options.scene)
        with (
            running(command, file) as driver,
            LossyLink(driver.port, trouble, seed=options.seed, on_state=watch) as link,
        ):
            hosts = HostKeeper(options.scene, link.port)
            try:
                made, stayed = soak(options, driver, link, watch, hosts, console)
                host = hosts.end()
            finally:
                hosts.kill()
            figures = driver.end()
    rows = make_table(figures, host, watch, link, made, stayed)
    table = Table(box=None, show_header=False)
    for row in rows:
        table.add_row(*row)
    console.print(table)
    if options.json:
        options.json.write_text(json.dumps(dict(rows), indent=2) + "\n")
    bad = figures["limit_violations"] + figures["non_finite_values"]
    sys.exit(1 if bad + watch.over_limit + watch.not_finite + stayed.total() else 0)


if __name__ == "__main__":
    main()
