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
from collections import Counter, defaultdict
from pathlib import Path

from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
from driver_process import device_command, running
from lossy_link import LossyLink, Trouble
from soak_injections import NAMES, Injections
from soak_watch import StateWatch

HOST = Path(__file__).with_name("soak_host.py")
# From the end of a trouble until the device is active again: with a host's start.
RECOVERY_S = 60.0
# What a trouble does to the device shows within the life of a command.
SETTLE_S = 0.5


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


def soak(options, injections, watch, hosts, console):
    """Makes troubles until the time is over.

    Returns:
        How often each was made; the faults that came of each, by kind; and those
        after which the device did not come back.
    """
    made, came, stayed = Counter(), defaultdict(Counter), Counter()
    if not watch.wait_until_active(RECOVERY_S):
        raise SystemExit("the host never enabled the device")
    start_s = time.monotonic()
    with console.status("") as line:
        while (passed_s := time.monotonic() - start_s) < 60.0 * options.minutes:
            name = NAMES[made.total() % len(NAMES)]
            line.update(
                f"{passed_s:.0f} of {60 * options.minutes:.0f} s"
                f" · {watch.states} states, {watch.violations} violations"
                f" · {made.total()} troubles, {stayed.total()} not recovered"
                f" · at most {watch.max_force_N:.2f} N · now {name}"
            )
            before = watch.faults.copy()
            getattr(injections, name)()
            made[name] += 1
            time.sleep(SETTLE_S)
            if not watch.wait_until_active(RECOVERY_S):
                stayed[name] += 1
                hosts.restart()
            time.sleep(options.pause_s)
            came[name] += watch.faults - before
    return made, came, stayed


def make_rows(figures, host, watch, link, troubles):
    """Returns what came of it, in words and figures."""
    made, came, stayed = troubles
    return {
        "ran": f"{figures['duration_s']:.0f} s, {figures['ticks']} ticks",
        "limit violations": f"{figures['limit_violations']}"
        f" (seen from outside: {watch.over_limit} of {watch.states} states)",
        "not finite": f"{figures['non_finite_values']}"
        f" (seen from outside: {watch.not_finite})",
        "largest": f"{watch.max_force_N:.3f} of {figures['force_limit_N']:g} N,"
        f" {1e3 * watch.max_torque_Nm:.1f} of"
        f" {1e3 * figures['torque_limit_Nm']:g} mN·m",
        **{f"{n} x {name}": _count(came[name]) for name, n in made.items()},
        "faults in the driver's books": _count(figures["faults"]),
        "recovered from": _count(figures["recoveries"]),
        "not recovered after": _count(stayed),
        "packets at the device": _count(figures["packets"]),
        "packets on the way": _count(link.counts),
        "driver late": _describe_lateness(figures["lateness_us"]),
        "host late": _describe_lateness(host["lateness_us"]),
        "servo late": _describe_lateness(host["device"]["servo_lateness_us"]),
    }


def _describe_lateness(late_us):
    return (
        f"p50 {late_us['p50']:.0f} µs, p99 {late_us['p99']:.0f} µs,"
        f" p99.9 {late_us['p99_9']:.0f} µs"
    )


def _count(counts):
    words = [f"{n} {name.lower()}" for name, n in counts.items()]
    return ", ".join(words) or "none"


def parse_options():
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("--minutes", type=float, default=10.0)
    add("--scene", default="torus_peg")
    add("--loss", type=float, default=0.01, help="share of packets, each way")
    add("--jitter-ms", type=float, default=2.0)
    add("--reorder", type=float, default=0.01, help="share of packets, each way")
    add("--ttl-ms", type=float, default=200.0, help="longest life of a command")
    add("--pause-s", type=float, default=3.0, help="between troubles")
    add("--seed", type=int, default=0)
    add("--json", type=Path, metavar="FILE", help="write the table there too")
    return parser.parse_args()


def main():
    """Runs the soak."""
    options = parse_options()
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
                injections = Injections(link, hosts, driver.pid)
                troubles = soak(options, injections, watch, hosts, console)
                host = hosts.end()
            finally:
                hosts.kill()
            figures = driver.end()
    rows = make_rows(figures, host, watch, link, troubles)
    table = Table(box=None, show_header=False)
    for row in rows.items():
        table.add_row(*row)
    console.print(table)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=2, ensure_ascii=False) + "\n")
    failed = (
        figures["limit_violations"] + figures["non_finite_values"] + watch.violations
        or figures["faults"] != figures["recoveries"]
        or troubles[-1]
    )
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
