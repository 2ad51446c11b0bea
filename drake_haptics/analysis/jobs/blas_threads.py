"""Runs linear algebra of small matrices on one thread.

A BLAS splits a product among as many threads as there are cores. The matrices of a loop
are too small for that: the threads mostly wait for each other. Beyond some hundred rows
the last bits of a sum would also depend on the number of cores.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from functools import wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

_P = ParamSpec("_P")
_R = TypeVar("_R")

_is_held = ContextVar("_is_held", default=False)


def one_blas_thread() -> threadpool_limits:
    """Returns a context in which the BLAS of this process uses one thread."""
    return threadpool_limits(limits=1, user_api="blas")


def on_one_blas_thread(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Returns a function whose linear algebra runs on one thread.

    It is a decorator. A call takes about a millisecond, and nothing within another
    decorated function.
    """

    @wraps(function)
    def run(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        if _is_held.get():
            return function(*args, **kwargs)
        token = _is_held.set(True)
        try:
            with one_blas_thread():
                return function(*args, **kwargs)
        finally:
            _is_held.reset(token)

    return run
