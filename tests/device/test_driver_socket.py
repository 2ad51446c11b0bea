"""The driver's port: never waits, never takes more than it is told."""

import socket

import pytest

from drake_haptics.common.errors import HapticsError
from drake_haptics.device.driver import DriverSocket


@pytest.fixture
def driver():
    driver = DriverSocket("127.0.0.1", 0)
    yield driver
    driver.close()


@pytest.fixture
def host(driver):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as host:
        host.settimeout(10.0)
        host.connect(driver.address)
        yield host


def test_nothing_there_is_nothing_and_no_wait(driver):
    assert list(driver.receive(10)) == []


def test_packets_come_oldest_first_and_no_more_than_asked_for(driver, host):
    for number in range(5):
        host.send(bytes([number]))
    peer = host.getsockname()
    assert list(driver.receive(3)) == [(bytes([i]), peer) for i in range(3)]
    assert list(driver.receive(3)) == [(bytes([i]), peer) for i in (3, 4)]


def test_an_answer_reaches_who_asked(driver, host):
    host.send(b"")
    ((packet, peer),) = driver.receive(1)
    assert packet == b""
    driver.send(b"state", peer)
    assert host.recv(100) == b"state"


def test_a_peer_that_is_gone_or_impossible_is_no_error(driver):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as gone:
        gone.bind(("127.0.0.1", 0))
        peer = gone.getsockname()
    for _ in range(3):
        driver.send(b"state", peer)
        assert list(driver.receive(3)) == []
    driver.send(b"state", ("127.0.0.1", 0))


def test_a_port_that_is_taken_is_the_users_error(driver):
    port = driver.address[1]
    with pytest.raises(HapticsError, match=f"port {port} is taken.*choose another"):
        DriverSocket("127.0.0.1", port)


@pytest.mark.parametrize("address", ["192.0.2.1", "no.such.host.invalid", "ä..b"])
def test_an_address_of_another_machine_is_the_users_error(address):
    with pytest.raises(HapticsError, match=f"^bind {address}: .*127.0.0.1"):
        DriverSocket(address, 0)


def test_an_address_of_ipv6_is_told_that_it_must_be_ipv4():
    with pytest.raises(HapticsError, match=r"^bind ::1: .*give an IPv4 address"):
        DriverSocket("::1", 0)


def test_no_address_is_not_taken_for_every_address():
    with pytest.raises(HapticsError, match=r"^bind is empty"):
        DriverSocket("", 0)


@pytest.mark.parametrize("port", [-1, 65536])
def test_a_number_that_no_port_has_is_the_users_error(port):
    with pytest.raises(HapticsError, match=f"from 0 to 65535, is {port}"):
        DriverSocket("127.0.0.1", port)


def test_a_port_is_free_again_after_close():
    first = DriverSocket("127.0.0.1", 0)
    port = first.address[1]
    first.close()
    first.close()
    DriverSocket("127.0.0.1", port).close()
