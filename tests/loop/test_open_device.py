"""Addresses of devices, right and wrong."""

import pytest
from pydrake.geometry import Meshcat

from drake_haptics import find_scene, load_scene
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.device.backend import DeviceError
from drake_haptics.loop.device_placement import find_device_site, wait_for_reading
from drake_haptics.loop.open_device import open_device


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


@pytest.mark.parametrize("kind", ["udp", "haply"])
def test_an_ipv6_host_needs_both_brackets(scene, kind):
    with pytest.raises(DeviceError, match=rf"device '{kind}://\[::1:7400': .*IPv6"):
        open_device(f"{kind}://[::1:7400", scene)


def test_the_number_of_an_ipv6_host_is_an_address_of_a_service_too(scene):
    # Nothing listens at this port, so that the attempt is told with its address.
    with pytest.raises(DeviceError, match=r"ws://\[::1\]:1: (?!.*valid URI)"):
        open_device("haply://[::1]:1", scene)


@pytest.mark.parametrize("end", ["/x", "?ttl_ms=5", "#a"])
def test_nothing_follows_a_drivers_port(scene, end):
    with pytest.raises(DeviceError, match="nothing may follow the port"):
        open_device(f"udp://127.0.0.1:7400{end}", scene)


def test_nothing_but_options_follows_the_port_of_a_service(scene):
    with pytest.raises(DeviceError, match=r"haply://.*1/x': nothing may follow the"):
        open_device("haply://127.0.0.1:1/x?max_force_N=1", scene)


def test_no_service_is_at_port_0(scene):
    with pytest.raises(DeviceError, match=r"'haply://127\.0\.0\.1:0': give the host"):
        open_device("haply://127.0.0.1:0", scene)


@pytest.mark.parametrize("address", ["meshcat:x", "mouse://x", "mouse:?x"])
def test_nothing_follows_what_is_moved_on_a_page(scene, address):
    with pytest.raises(DeviceError, match="nothing may follow the colon"):
        open_device(address, scene, Meshcat())


def test_a_replay_needs_a_file(scene):
    with pytest.raises(DeviceError, match=r"like replay:run\.tick"):
        open_device("replay:", scene)


@pytest.mark.parametrize("address", ["meshcat:", "mouse:"])
def test_what_is_moved_on_a_page_needs_one(scene, address):
    with pytest.raises(DeviceError, match="is moved on a page"):
        open_device(address, scene)


@pytest.mark.parametrize("address", ["meshcat:", "mouse:"])
def test_what_is_moved_on_a_page_starts_where_the_scene_has_its_hand(scene, address):
    with open_device(address, scene, Meshcat()) as device:
        reading = wait_for_reading(device)
        expected = find_device_site(scene).X_BH
        assert vector_to_pose(reading.X_BH).IsNearlyEqualTo(expected, 1e-12)
        assert (device.url is not None) == (address == "mouse:")
