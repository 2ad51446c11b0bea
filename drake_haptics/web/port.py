"""The TCP port of the page."""

from __future__ import annotations

import itertools
import socket

from drake_haptics.common.errors import UserError

_ADDRESS = "127.0.0.1"
FIRST_PORT = 7100
_MOST_PORTS = 100


def open_page_port(port: int | None = None) -> socket.socket:
    """Returns a socket that listens on a port of this machine, for it alone.

    Args:
        port: None takes the first free one from `FIRST_PORT` on.

    Raises:
        UserError: The port cannot be used.
    """
    for candidate in itertools.count(FIRST_PORT) if port is None else [port]:
        try:
            return socket.create_server((_ADDRESS, candidate))
        except (OSError, OverflowError) as error:
            if port is None and candidate < FIRST_PORT + _MOST_PORTS:
                continue
            raise UserError(
                f"port {candidate} cannot be used for the page: {error}. Give another"
                f" one, or none for the first free one from {FIRST_PORT}"
            ) from error
    raise AssertionError("counting does not end")
