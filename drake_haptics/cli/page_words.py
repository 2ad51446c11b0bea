"""What a command says of the page that it serves."""

from __future__ import annotations

import os
from collections.abc import Sequence
from urllib.parse import urlsplit


def describe_page(url: str, parts: Sequence[str] = ()) -> list[str]:
    """Returns where a page is to be seen and, to one who works over ssh, how.

    Args:
        url: Of the page.
        parts: Addresses of what the page shows besides, each at a port of its own.
    """
    lines = [f"Open {url} to see it."]
    if connection := os.environ.get("SSH_CONNECTION"):
        # Client's address and port, then the server's.
        host = connection.split()[2:3] or ["THIS_COMPUTER"]
        ports = dict.fromkeys(urlsplit(address).port for address in (url, *parts))
        forwards = " ".join(f"-L {port}:localhost:{port}" for port in ports)
        lines.append(
            "Over ssh, run this on your own computer and open it there:"
            f" ssh -N {forwards} {host[0]}"
        )
    return lines
