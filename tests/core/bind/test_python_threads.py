"""What a busy Python thread may delay, and what may not delay other threads."""

from __future__ import annotations

import socket
import sys
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest
import trimesh

from drake_haptics import _core

_AT_REST = np.array([1.0, 0, 0, 0, 0, 0, 0])
_NEAR = np.array([1.0, 0, 0, 0, 0, 0, 0.0605])


class BusyThread:
    """Counts up in Python whenever it gets the GIL, which it lets go soon."""

    def __init__(self) -> None:
        self.count = 0
        self._ends = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._ends:
            self.count += 1
            time.sleep(1e-4)

    def close(self) -> None:
        """Ends it."""
        self._ends = True
        self._thread.join()


def keep_busy(duration_s: float) -> None:
    """Holds the GIL until a thread that pauses for 0.1 ms waits for it."""
    end_s = time.perf_counter() + duration_s
    while time.perf_counter() < end_s:
        pass


@pytest.fixture
def busy() -> Iterator[BusyThread]:
    """A thread that waits for the GIL, and gets it only from who lets it go."""
    before_s = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    thread = BusyThread()
    try:
        while thread.count == 0:
            time.sleep(1e-3)
        keep_busy(0.05)
        yield thread
    finally:
        sys.setswitchinterval(before_s)
        thread.close()


def body(half_m: float) -> _core.ConvexPieces:
    mesh = trimesh.creation.box([2.0 * half_m] * 3)
    return _core.decompose_surface(
        mesh.vertices, mesh.faces.astype(np.int32), np.ones(12, dtype=np.uint8)
    )


TOOL, OBJECT = body(0.01), body(0.05)


def test_a_query_waits_for_no_busy_thread(busy: BusyThread) -> None:
    scene = _core.SceneTracker(TOOL, [OBJECT], 2e-3)
    pair = _core.ContactTracker(TOOL, OBJECT, 2e-3)
    keep_busy(0.01)
    before = busy.count
    for _ in range(200):
        assert len(scene.query(_NEAR)) == 1
        assert len(pair.query(_NEAR, _AT_REST)) == 1
    assert busy.count == before


def test_a_trajectory_lets_other_threads_run(busy: BusyThread) -> None:
    scene = _core.SceneTracker(TOOL, [OBJECT], 2e-3)
    poses = np.tile(_NEAR, (5000, 1))
    before = busy.count
    for _ in range(10):  # what is let go may be back before another has woken
        scene.query_trajectory(poses)
    assert busy.count > before


def test_a_servo_begins_and_ends_while_other_threads_run(busy: BusyThread) -> None:
    """It may wait for seconds until a name is found, and for its thread to end."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as driver:
        driver.bind(("127.0.0.1", 0))
        port = driver.getsockname()[1]
        servos: list[_core.UdpServo] = []
        before = busy.count
        # What is let go may be back before another has woken.
        while busy.count == before and len(servos) < 100:
            servos.append(_core.UdpServo("localhost", port))
        begun = busy.count
        assert begun > before
        servos.clear()
        assert busy.count > begun


def test_a_servo_may_be_closed_by_many_threads_at_once() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as driver:
        driver.bind(("127.0.0.1", 0))
        servo = _core.UdpServo("127.0.0.1", driver.getsockname()[1])
        all_there = threading.Barrier(4)

        def close() -> None:
            all_there.wait()
            servo.close()
            assert not servo.status().is_running

        threads = [threading.Thread(target=close) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
