"""The driver's end of the link: a UDP socket that never waits."""

from __future__ import annotations

import errno
import socket
from collections.abc import Iterator

from drake_haptics.common.errors import UserError

Peer = tuple[str, int]
# More than any packet of the protocol: what is longer is cut, and refused for it.
_BUFFER_BYTES = 2048


class DriverSocket:
    """Takes commands and sends states.

    Args:
        host: Address to listen at; only this machine can reach 127.0.0.1.
        port: To listen at; 0 lets the system choose.

    Raises:
        UserError: The address or port cannot be had.
    """

    def __init__(self, host: str, port: int):
        if not host:  # which would be every address that this machine has
            raise UserError("bind is empty: give an address, such as 127.0.0.1")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.bind((host, port))
        except OSError as error:
            self._socket.close()
            raise UserError(_explain(error, host, port)) from error

    @property
    def address(self) -> Peer:
        """Where it listens: host and port."""
        host, port = self._socket.getsockname()
        return host, port

    def receive(self, most: int) -> Iterator[tuple[bytes, Peer]]:
        """Yields the packets that have come and who sent each, oldest first.

        Args:
            most: So many at most; the others are left for the next call.
        """
        for _ in range(most):
            try:
                yield self._socket.recvfrom(_BUFFER_BYTES)
            except BlockingIOError:
                return
            except ConnectionError:
                continue  # some systems tell here that a state found nobody

    def send(self, packet: bytes, peer: Peer) -> None:
        """Sends a packet; one that cannot leave is lost, as on any network."""
        try:
            self._socket.sendto(packet, peer)
        except OSError:
            pass  # a network that is down: no command will come, and the gate sees it

    def close(self) -> None:
        """Gives the port up; may be called again."""
        self._socket.close()


def _explain(error: OSError, host: str, port: int) -> str:
    """Returns what to do about an address that cannot be had."""
    if error.errno == errno.EADDRINUSE:
        return (
            f"port {port} is taken, perhaps by another `drake-haptics device`:"
            " end that, or choose another (0: any free one)"
        )
    if error.errno == errno.EACCES:
        return f"port {port} needs rights that you lack: choose one from 1024 on"
    return (
        f"bind {host}: {error.strerror or error}; give an address of this machine,"
        " such as 127.0.0.1"
    )
