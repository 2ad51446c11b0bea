"""Addresses of devices, right and wrong."""

import pytest

from drake_haptics.device.backend import DeviceError
from drake_haptics.device_address import open_device
from drake_haptics.scene import load_scene
from drake_haptics.scene_library import find_scene


@pytest.fixture(scope="module")
def scene():
    return load_scene(find_scene("sphere_pen"))


@pytest.mark.parametrize("address", ["", "nonsense", "localhost:7400", "tcp://a:1"])
def test_what_is_no_kind_of_device_is_told_the_kinds(scene, address):
    with pytest.raises(DeviceError, match=r"give udp://HOST:PORT, haply://HOST"):
        open_device(address, scene)


@pytest.mark.parametrize("address", ["udp:", "udp://", "udp://127.0.0.1", "udp://:1"])
def test_a_network_device_needs_host_and_port(scene, address):
    with pytest.raises(DeviceError, match=r"give host and port, like udp://"):
        open_device(address, scene)


@pytest.mark.parametrize("port", ["x", "70000", "-1"])
def test_a_port_must_be_one(scene, port):
    with pytest.raises(DeviceError, match=r"udp://127.0.0.1:.*[Pp]ort"):
        open_device(f"udp://127.0.0.1:{port}", scene)
