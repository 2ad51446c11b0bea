"""What the adapters that find contacts in C++ have in common."""

from __future__ import annotations

from typing import Any

import numpy as np

from drake_haptics.evaluation.accuracy.peers.our_law import FoundContacts
from drake_haptics.evaluation.measuring.native_build import HANDLE, INTEGERS, REALS
from drake_haptics.evaluation.measuring.timing import clock_interval, typical

# Types of the arguments of an adapter's function that copies contacts.
COPY = (HANDLE, INTEGERS, REALS)
# The size of a contact in measuring/native/found_contacts.h.
_CONTACT_SIZE = 11


def copy_contacts(
    copy: Any, scene: int, count: int, seconds: np.ndarray
) -> FoundContacts:
    """Returns the contacts that an adapter holds after a run.

    Args:
        copy: Its function.
        scene: Its object.
        count: What its run returned.
        seconds: (PASSES, k) what each tick took, the clock included, s.
    """
    start = np.empty(seconds.shape[1] + 1, dtype=np.int32)
    rows = np.empty((count, _CONTACT_SIZE))
    copy(scene, start, rows)
    distance, normal, p_WCa, p_WCb, owner = np.split(rows, [1, 4, 7, 10], axis=1)
    return FoundContacts(
        start=start,
        distance=distance[:, 0],
        nhat_BA_W=normal,
        p_WCa=p_WCa,
        p_WCb=p_WCb,
        object_index=owner[:, 0].astype(np.int32),
        seconds=np.maximum(typical(seconds) - clock_interval(), 0.0),
    )
