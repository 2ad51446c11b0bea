"""The recorder: every bit, also when it is killed, never a wait, every loss told."""

import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from tick_log_samples import HEADER, assert_same_bits, make_rows
from waiting import wait_until

from drake_haptics.tick_log import tick_recorder
from drake_haptics.tick_log.log_format import TickLogError, TickRows
from drake_haptics.tick_log.tick_log import Gap, TickLogReader, read_tick_log
from drake_haptics.tick_log.tick_recorder import TickRecorder

LONG_S = 180.0


def add_rows(recorder, rows):
    for i in range(len(rows)):
        time_s, _, query_s, device_time_s, distance_m = rows.reals[i, :5].tolist()
        recorder.add(
            time_s,
            rows.reals[i, 5:],
            tuple(rows.counts[i].tolist()),
            query_s=query_s,
            distance_m=distance_m,
            device_time_s=device_time_s,
        )


# More than one chunk, and no multiple of a block.
@pytest.mark.parametrize("ticks", [0, 1, 256, 2500])
def test_every_bit_comes_back(tmp_path, ticks):
    rows = make_rows(ticks)
    with TickRecorder(tmp_path / "run.tick", HEADER) as recorder:
        add_rows(recorder, rows)
        assert recorder.ticks == ticks
    log = read_tick_log(tmp_path / "run.tick")
    assert (log.header, log.gaps) == (HEADER, ())
    clock_s = log.rows["clock_s"].copy()
    assert (np.diff(clock_s, prepend=0.0) >= 0.0).all()
    log.rows["clock_s"][:] = rows["clock_s"]
    assert_same_bits(log.rows, rows)


def test_ticks_are_on_the_disk_while_it_runs(tmp_path):
    path = tmp_path / "run.tick"
    with TickRecorder(path, HEADER) as recorder:
        add_rows(recorder, make_rows(10))
        wait_until(lambda: len(read_tick_log(path).rows) == 10)
        add_rows(recorder, make_rows(5, first=10))
        wait_until(lambda: len(read_tick_log(path).rows) == 15)
        assert read_tick_log(path).gaps == (Gap(15, None),)
    assert read_tick_log(path).gaps == ()


RECORDS_FOR_EVER = """
import sys, time
import numpy as np
from tick_log_samples import HEADER
from drake_haptics.tick_log.tick_recorder import TickRecorder
recorder = TickRecorder(sys.argv[1], HEADER)
for k in range(1_000_000):
    recorder.add(1e-3 * k, np.full(38, k + 0.5), (k,) * 7,
                 query_s=0.0, distance_m=0.0, device_time_s=time.monotonic())
    print(k, flush=True)
    time.sleep(1e-3)
"""


def test_a_killed_process_leaves_all_but_the_last_second(tmp_path):
    path = tmp_path / "run.tick"
    process = subprocess.Popen(
        [sys.executable, "-c", RECORDS_FOR_EVER, str(path)],
        stdout=subprocess.PIPE,
        env={"PYTHONPATH": ":".join(sys.path)},
    )
    watchdog = threading.Timer(LONG_S, process.kill)
    watchdog.start()
    try:
        # Long enough that there is something to lose besides the last second.
        while int(process.stdout.readline()) < 1500:
            pass
        process.send_signal(signal.SIGKILL)
        process.wait(LONG_S)
    finally:
        watchdog.cancel()
        process.kill()
        process.wait()
        process.stdout.close()
    log = read_tick_log(path)
    ticks = len(log.rows)
    assert log.gaps == (Gap(ticks, None),)
    np.testing.assert_array_equal(log.rows["contacts"], np.arange(ticks))
    np.testing.assert_array_equal(log.rows["X_WH"][:, 0], np.arange(ticks) + 0.5)
    # 1500 ticks take 1.5 s at least; of the rest the last second may be missing.
    clock_s = log.rows["clock_s"]
    assert clock_s[-1] > 0.5
    assert ticks > 300


def test_a_full_disk_is_told_at_once():
    with pytest.raises(OSError, match=r"No space left.*/dev/full"):
        TickRecorder("/dev/full", HEADER)


class FullDisk:
    """A stream that is full after the head."""

    closed = False

    def write(self, data):
        """Refuses."""
        raise OSError(28, "No space left on device")

    def flush(self):
        """Has nothing to do."""

    def close(self):
        """Notes that it was closed."""
        self.closed = True


def test_a_disk_that_fills_up_stops_the_log_but_not_the_loop(tmp_path):
    recorder = TickRecorder(tmp_path / "run.tick", HEADER)
    stream, recorder._stream = recorder._stream, FullDisk()
    stream.close()
    add_rows(recorder, make_rows(3000))
    with pytest.raises(TickLogError, match=r"ends early.*No space left.*make room"):
        recorder.close()
    recorder.close()


class SlowDisk(FullDisk):
    """A stream that waits until it may go on."""

    def __init__(self, stream):
        self.go_on = threading.Event()
        self._stream = stream

    def write(self, data):
        """Waits, then writes."""
        assert self.go_on.wait(LONG_S)
        self._stream.write(data)

    def close(self):
        """Closes the file."""
        self.closed = True
        self._stream.close()


def test_no_tick_waits_for_a_slow_disk_and_the_loss_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(tick_recorder, "_MAX_CHUNKS", 2)
    recorder = TickRecorder(tmp_path / "run.tick", HEADER)
    recorder._stream = disk = SlowDisk(recorder._stream)
    rows = make_rows(3000)
    try:
        add_rows(recorder, rows)  # would never end if it waited
    finally:
        disk.go_on.set()
    wait_until(lambda: len(recorder._chunks) < 2)
    add_rows(recorder, make_rows(10, first=3000))
    with pytest.raises(TickLogError, match=r"952 ticks are missing.*disk was too slow"):
        recorder.close()
    log = read_tick_log(tmp_path / "run.tick")
    assert log.gaps == (Gap(2048, 952),)
    assert len(log.rows) == 2058
    np.testing.assert_array_equal(
        log.rows.counts[2048:], make_rows(10, first=3000).counts
    )


def test_what_went_wrong_in_the_loop_is_not_hidden(tmp_path):
    with pytest.raises(ZeroDivisionError):
        with TickRecorder(tmp_path / "run.tick", HEADER) as recorder:
            stream, recorder._stream = recorder._stream, FullDisk()
            stream.close()
            raise ZeroDivisionError


def test_closing_twice_is_closing_once(tmp_path):
    recorder = TickRecorder(tmp_path / "run.tick", HEADER)
    recorder.close()
    recorder.close()
    assert read_tick_log(tmp_path / "run.tick").gaps == ()


def test_no_tick_is_lost_silently_after_closing(tmp_path):
    with TickRecorder(tmp_path / "run.tick", HEADER) as recorder:
        add_rows(recorder, make_rows(3))
    with pytest.raises(ValueError, match=r"run\.tick is closed: simulate before"):
        add_rows(recorder, make_rows(1))
    assert recorder.ticks == 3


def test_a_folder_that_is_not_there_is_told_at_once(tmp_path):
    with pytest.raises(FileNotFoundError):
        TickRecorder(tmp_path / "none" / "run.tick", HEADER)


def test_blocks_can_be_read_one_by_one(tmp_path):
    with TickRecorder(tmp_path / "run.tick", HEADER) as recorder:
        add_rows(recorder, make_rows(1000))
    reader = TickLogReader(tmp_path / "run.tick")
    shares = []
    blocks = list(reader.iterate_blocks(lambda what, share: shares.append(share)))
    assert len(shares) == len(blocks)
    assert 0.9 < shares[-1] < 1.0  # then comes the end mark
    assert isinstance(blocks[0], TickRows)
    assert max(map(len, blocks)) <= 256
    assert sum(map(len, blocks)) == 1000
    assert reader.gaps == []
