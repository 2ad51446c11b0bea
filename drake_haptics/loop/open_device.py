"""Opens devices by their address, as on the command line."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from urllib.parse import SplitResult, urlsplit

from pydrake.geometry import Meshcat

from drake_haptics.device.backend import DeviceBackend, DeviceError
from drake_haptics.loop.device_placement import DevicePlacement, find_device_site
from drake_haptics.scene.schema import Scene

_HAPLY_PORT = 10001


class NoPageError(DeviceError):
    """A device that is moved on a page was requested without a page."""


# Opens a device by the parts of its address.
_Opener = Callable[[SplitResult, DevicePlacement, Meshcat | None], DeviceBackend]


def open_device(
    address: str, scene: Scene, meshcat: Meshcat | None = None
) -> DeviceBackend:
    """Opens a device by its address.

    * `udp://HOST:PORT`: a driver that speaks the protocol of docs/device-protocol.md
    * `haply://HOST[:PORT]`: an Inverse3 behind Haply's Inverse Service
    * `lcm:[URL]`: a driver on LCM, at an LCM URL or the default one
    * `meshcat:`: sliders and gamepad of Meshcat's page
    * `mouse:`: the mouse, over the picture of the scene
    * `replay:FILE`: the handle in a log of `run --log`

    The address of an Inverse3 may end with options, such as `?max_force_N=4`; see
    `HaplyDevice.open`.

    Args:
        address: Address in one of these forms.
        scene: Scene that gives the placement and the limits of the device.
        meshcat: Meshcat whose page `meshcat:` and `mouse:` need; without it they raise
            `NoPageError`.

    Returns:
        The open device, which the caller must close.

    Raises:
        DeviceError: There is no such kind of device, the address is incomplete, or the
            device cannot be opened.
        SceneError: There is no such preset, or the hand's path is not valid.
        TickLogError: A log cannot be read.
        OSError: A log cannot be opened.
    """
    try:
        parts = urlsplit(address)
    except ValueError as error:  # A bracket of an IPv6 host is missing.
        raise DeviceError(f"device {address!r}: {error}") from error
    if parts.scheme not in _OPENERS:
        near = difflib.get_close_matches(parts.scheme or address, _OPENERS, n=1)
        hint = f"; did you mean '{near[0]}:'?" if near else ""
        raise DeviceError(
            f"device {address!r}: give udp://HOST:PORT, haply://HOST, lcm:, meshcat:,"
            f" mouse: or replay:FILE{hint}"
        )
    return _OPENERS[parts.scheme](parts, find_device_site(scene), meshcat)


def _open_udp(
    parts: SplitResult, site: DevicePlacement, meshcat: Meshcat | None
) -> DeviceBackend:
    from drake_haptics.device.udp_device import UdpDevice

    host, port = _split_host(parts, None)
    return UdpDevice(
        host, port, max_force_N=site.max_force_N, max_torque_Nm=site.max_torque_Nm
    )


def _open_haply(
    parts: SplitResult, site: DevicePlacement, meshcat: Meshcat | None
) -> DeviceBackend:
    from drake_haptics.device.haply.haply_device import HaplyDevice

    host, port = _split_host(parts._replace(query=""), _HAPLY_PORT)
    # The number of an IPv6 host has colons, which brackets keep from the port's.
    host = f"[{host}]" if ":" in host else host
    return HaplyDevice.open(f"ws://{host}:{port}", parts.query)


def _open_lcm(
    parts: SplitResult, site: DevicePlacement, meshcat: Meshcat | None
) -> DeviceBackend:
    from drake_haptics.device.lcm.lcm_device import LcmDevice

    return LcmDevice.open(parts.geturl().removeprefix("lcm:"))


def _split_host(parts: SplitResult, default_port: int | None) -> tuple[str, int]:
    """Returns host and port of an address."""
    try:
        port = default_port if parts.port is None else parts.port
    except ValueError as error:  # The port is not a number, or is too large.
        raise DeviceError(f"device {parts.geturl()!r}: {error}") from error
    if not parts.hostname or not port:
        raise DeviceError(
            f"device {parts.geturl()!r}: give"
            f" {'host and port' if default_port is None else 'the host'}, like"
            f" {parts.scheme}://127.0.0.1{':7400' if default_port is None else ''}"
        )
    if parts.path or parts.query or parts.fragment:
        raise DeviceError(f"device {parts.geturl()!r}: nothing may follow the port")
    return parts.hostname, port


def _open_meshcat(
    parts: SplitResult, site: DevicePlacement, meshcat: Meshcat | None
) -> DeviceBackend:
    from drake_haptics.device.meshcat_device import MeshcatDevice

    return MeshcatDevice(
        _require_page(parts, meshcat),
        X_WB=site.X_WB,
        X_BH=site.X_BH,
        workspace_radius_m=site.workspace_radius_m,
    )


def _open_mouse(
    parts: SplitResult, site: DevicePlacement, meshcat: Meshcat | None
) -> DeviceBackend:
    from drake_haptics.web.mouse_device import MouseDevice

    return MouseDevice(
        _require_page(parts, meshcat),
        X_WB=site.X_WB,
        X_BH=site.X_BH,
        workspace_radius_m=site.workspace_radius_m,
        max_force_N=site.max_force_N,
        max_torque_Nm=site.max_torque_Nm,
    )


def _require_page(parts: SplitResult, meshcat: Meshcat | None) -> Meshcat:
    if parts.netloc or parts.path or parts.query or parts.fragment:
        raise DeviceError(f"device {parts.geturl()!r}: nothing may follow the colon")
    if meshcat is None:
        raise NoPageError(
            f"device {parts.geturl()!r} is moved on a page, and there is none"
        )
    return meshcat


def _open_replay(
    parts: SplitResult, site: DevicePlacement, meshcat: Meshcat | None
) -> DeviceBackend:
    from drake_haptics.tick_log.replay_device import ReplayDevice
    from drake_haptics.tick_log.tick_log import read_tick_log

    file = parts.geturl().removeprefix("replay:")
    if not file:
        raise DeviceError("device 'replay:': give the log's file, like replay:run.tick")
    return ReplayDevice(read_tick_log(file))


_OPENERS: dict[str, _Opener] = {
    "haply": _open_haply,
    "lcm": _open_lcm,
    "meshcat": _open_meshcat,
    "mouse": _open_mouse,
    "replay": _open_replay,
    "udp": _open_udp,
}
