"""Linear algebra on one thread, so that its rounding is the same everywhere."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits

_lock = threading.Lock()
_users = 0
_limits: threadpool_limits | None = None


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Holds the BLAS libraries of this process to one thread while it is entered.

    A BLAS cuts a product into parts by the number of its threads, and sums the parts
    in that order: from some hundred rows on, the last bits depend on the machine's
    cores. Several threads may be inside; the last to leave restores what was before.
    Libraries that are loaded while inside are not held. Costs about a millisecond.
    """
    global _users, _limits
    with _lock:
        if _users == 0:
            _limits = threadpool_limits(limits=1, user_api="blas")
        _users += 1
    try:
        yield
    finally:
        with _lock:
            _users -= 1
            if _users == 0 and _limits is not None:
                _limits.restore_original_limits()
                _limits = None
