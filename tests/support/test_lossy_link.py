"""The bad network of the other tests does what it says."""

import socket
import time

import pytest
from lossy_link import LossyLink, Trouble

COUNT = 60


class Ends:
    """A device and a host, with a link between them."""

    def __init__(self, trouble):
        self.device = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.device.bind(("127.0.0.1", 0))
        self.link = LossyLink(self.device.getsockname()[1], trouble, seed=1)
        self.host = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.host.connect(("127.0.0.1", self.link.port))

    def __enter__(self):
        self.link.__enter__()
        return self

    def __exit__(self, *_):
        self.link.__exit__()
        self.host.close()
        self.device.close()

    def send(self):
        """Sends numbered packets to the device; returns them."""
        packets = [bytes([number]) * 50 for number in range(COUNT)]
        for packet in packets:
            self.host.send(packet)
        return packets

    def receive_sent(self, copies=1):
        """Returns what comes at the device of what `send` sent."""
        while self.link.counts["to_device"] < COUNT:
            time.sleep(1e-3)
        return self.receive(self.device, copies * (COUNT - self.link.counts["lost"]))

    def receive(self, end, count=0):
        """Returns so many packets, and what else comes until nothing does."""
        end.settimeout(120.0)
        packets = [end.recv(100) for _ in range(count)]
        end.settimeout(0.1)
        try:
            while True:
                packets.append(end.recv(100))
        except TimeoutError:
            return packets


def test_without_trouble_all_arrives_as_it_was():
    with Ends(Trouble()) as ends:
        assert ends.receive(ends.device) == []
        sent = ends.send()
        assert ends.receive_sent() == sent
        assert ends.link.counts["to_device"] == COUNT
        assert ends.link.last_command == sent[-1]


def test_answers_go_to_the_host_that_spoke_last():
    with Ends(Trouble()) as ends:
        ends.host.send(b"first")
        relay = ends.device.recvfrom(100)[1]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.connect(("127.0.0.1", ends.link.port))
            other.send(b"second")
            assert ends.device.recv(100) == b"second"
            ends.device.sendto(b"state", relay)
            assert ends.receive(other, 1) == [b"state"]
        assert ends.receive(ends.host) == []


@pytest.mark.parametrize("trouble", [Trouble(loss=1.0), Trouble(cut=True)])
def test_what_is_lost_is_lost(trouble):
    with Ends(trouble) as ends:
        ends.send()
        assert ends.receive_sent() == []
        assert ends.link.counts["lost"] == COUNT


def test_loss_is_a_share():
    with Ends(Trouble(loss=0.5)) as ends:
        sent = ends.send()
        came = ends.receive_sent()
        assert set(came) < set(sent)
        assert 0.2 * COUNT < len(came) < 0.8 * COUNT


def test_damage_is_one_bit():
    with Ends(Trouble(corrupt=1.0)) as ends:
        sent = ends.send()
        for before, after in zip(sent, ends.receive_sent(), strict=True):
            bits = int.from_bytes(before, "big") ^ int.from_bytes(after, "big")
            assert bits.bit_count() == 1


def test_duplicates_come_twice():
    with Ends(Trouble(duplicate=1.0)) as ends:
        sent = ends.send()
        assert ends.receive_sent(copies=2) == [p for p in sent for _ in range(2)]


@pytest.mark.parametrize("trouble", [Trouble(reorder=0.3), Trouble(jitter_s=0.05)])
def test_what_is_late_is_overtaken_but_comes(trouble):
    with Ends(trouble) as ends:
        sent = ends.send()
        came = ends.receive_sent()
        assert came != sent
        assert sorted(came) == sent


def test_a_flood_comes_from_a_stranger():
    with Ends(Trouble()) as ends:
        ends.link.flood(1000, 50, lambda number: b"%d" % number)
        came = ends.receive(ends.device, 50)
        assert came == [b"%d" % number for number in range(50)]
        assert ends.link.counts["to_device"] == 0
