"""A bad network between host and device, on one machine."""

import dataclasses
import heapq
import itertools
import random
import select
import socket
import threading
import time


@dataclasses.dataclass
class Trouble:
    """The trouble of packets on their way, each way; may change while they run.

    Attributes:
        loss: Share of packets that never arrive.
        jitter_s: Largest random delay of a packet, s. One that is later than its
            successor by this is overtaken.
        reorder: Share of packets held back for `reorder_s`, so that several overtake.
        reorder_s: Time for which they are held back, s.
        duplicate: Share of packets that arrive twice.
        corrupt: Share of packets in which one bit is turned.
        cut: Whether nothing passes at all.
    """

    loss: float = 0.0
    jitter_s: float = 0.0
    reorder: float = 0.0
    reorder_s: float = 0.005
    duplicate: float = 0.0
    corrupt: float = 0.0
    cut: bool = False


class LossyLink:
    """A UDP relay in a thread: hosts speak to `port`, it speaks to the device.

    Answers go to the host that spoke last. Use it as a context manager.

    Args:
        device_port: Port of the device, on this machine.
        trouble: Trouble of the packets; none where not given.
        seed: Seed of all chance in it.
        on_state: Called in the thread with each packet that the device sent, before
            anything happens to it.

    Attributes:
        trouble: Trouble of the packets; may be changed at any time.
        counts: Numbers of packets by their fate.
        last_command: The latest packet from a host, as it came.
    """

    def __init__(self, device_port, trouble=None, *, seed=0, on_state=None):
        self.trouble = trouble or Trouble()
        self.counts = dict.fromkeys(
            ["to_device", "to_host", "lost", "corrupted", "duplicated", "held_back"], 0
        )
        self.last_command = None
        self._random = random.Random(seed)
        self._on_state = on_state or (lambda packet: None)
        self._host_side = _open_socket()
        self._device_side = _open_socket()
        self._device = ("127.0.0.1", device_port)
        self._host = None
        self._held = []
        self._order = itertools.count()
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    @property
    def port(self):
        """Port at which hosts find the device."""
        return self._host_side.getsockname()[1]

    def __enter__(self):
        """Starts the thread."""
        self._thread.start()
        return self

    def __exit__(self, *_):
        """Ends it when it has passed on what has come; what it held back is lost."""
        self._ends.set()
        self._thread.join(10.0)
        self._host_side.close()
        self._device_side.close()

    def flood(self, packets_per_s, packets, make_packet):
        """Sends packets to the device as a stranger, beside the relay.

        Args:
            packets_per_s: Rate of packets; lower where the machine cannot.
            packets: Number of packets.
            make_packet: Called with the number of each.
        """
        sent = 0
        with _open_socket() as stranger:
            start_s = time.monotonic()
            while sent < packets:
                if sent < (time.monotonic() - start_s) * packets_per_s:
                    _send(stranger, make_packet(sent), self._device)
                    sent += 1
                else:
                    time.sleep(1e-4)

    def send_to_device(self, packet):
        """Sends a packet as if a host had."""
        _send(self._device_side, packet, self._device)

    def _run(self):
        sockets = [self._host_side, self._device_side]
        while not self._ends.is_set():
            due_s = self._held[0][0] if self._held else float("inf")
            wait_s = min(max(due_s - time.monotonic(), 0.0), 0.05)
            ready, _, _ = select.select(sockets, [], [], wait_s)
            self._take_from(ready)
            while self._held and self._held[0][0] <= time.monotonic():
                _, _, packet, to_device = heapq.heappop(self._held)
                self._deliver(packet, to_device)
        self._take_from(sockets)

    def _take_from(self, sides):
        """Takes the packets that have come, and applies the trouble to them."""
        for side in sides:
            for packet, sender in _take(side):
                self._pass_on(packet, sender, to_device=side is self._host_side)

    def _pass_on(self, packet, sender, *, to_device):
        """Applies the trouble to a packet."""
        trouble, chance = self.trouble, self._random.random
        if to_device:
            self._host = sender
            self.last_command = packet
        else:
            self._on_state(packet)
        is_lost = trouble.cut or chance() < trouble.loss
        self.counts["lost"] += is_lost
        self.counts["to_device" if to_device else "to_host"] += 1
        if is_lost:
            return
        if chance() < trouble.corrupt:
            self.counts["corrupted"] += 1
            packet = self._turn_a_bit(packet)
        delay_s = chance() * trouble.jitter_s
        if chance() < trouble.reorder:
            self.counts["held_back"] += 1
            delay_s += trouble.reorder_s
        copies = 1
        if chance() < trouble.duplicate:
            self.counts["duplicated"] += 1
            copies = 2
        for _ in range(copies):
            if delay_s > 0.0:
                due_s = time.monotonic() + delay_s
                entry = (due_s, next(self._order), packet, to_device)
                heapq.heappush(self._held, entry)
            else:
                self._deliver(packet, to_device)

    def _turn_a_bit(self, packet):
        """Returns the packet with one bit the other way."""
        damaged = bytearray(packet)
        bit = self._random.randrange(8 * len(damaged))
        damaged[bit // 8] ^= 1 << bit % 8
        return bytes(damaged)

    def _deliver(self, packet, to_device):
        if to_device:
            _send(self._device_side, packet, self._device)
        elif self._host is not None:
            _send(self._host_side, packet, self._host)


def _open_socket():
    side = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    side.bind(("127.0.0.1", 0))
    side.setblocking(False)
    return side


def _take(side, most=256):
    """Yields the packets that have come, a bounded number of them."""
    for _ in range(most):
        try:
            yield side.recvfrom(4096)
        except BlockingIOError:
            return
        except ConnectionRefusedError:
            continue  # some systems report here that nobody took the last one


def _send(side, packet, to):
    try:
        side.sendto(packet, to)
    except (BlockingIOError, ConnectionRefusedError):
        pass  # as on any network, what does not fit is lost
