"""What Python objects of the core leave behind when the interpreter ends."""

from __future__ import annotations

import os
import subprocess
import sys

_USE = """
import numpy as np
from drake_haptics import _core

corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
body = _core.decompose_surface(
    np.array(corners, float), np.array(faces, np.int32), np.ones(12, np.uint8))
pair = _core.ContactTracker(body, body, 0.1)
pose = np.array([1.0, 0, 0, 0, 0, 0, 2.05])
contacts = pair.query(pose, pose * [1, 0, 0, 0, 0, 0, 0])
assert len(contacts) == 1
columns = [contacts.distance, contacts.nhat_BA_W, contacts[0].p_WC]
clusters = _core.share_stiffness(contacts, 0.1)
servo = _core.UdpServo("127.0.0.1", 9)
"""
_LEAK = """
import ctypes
ctypes.pythonapi.Py_IncRef(ctypes.py_object(body))
"""


def _reports(program: str, asks: bool) -> str:
    environment = dict(os.environ)
    environment.pop("DRAKE_HAPTICS_LEAK_WARNINGS", None)
    if asks:
        environment["DRAKE_HAPTICS_LEAK_WARNINGS"] = "1"
    run = subprocess.run(
        [sys.executable, "-c", program],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return run.stderr


def test_nothing_of_the_core_leaks() -> None:
    assert _reports(_USE, asks=True) == ""


def test_a_leak_is_reported_to_whom_asks() -> None:
    assert "leaked" in _reports(_USE + _LEAK, asks=True)
    assert _reports(_USE + _LEAK, asks=False) == ""
