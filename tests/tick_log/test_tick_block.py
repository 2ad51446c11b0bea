"""Blocks of a log: the layout, to the byte, and what does not pass for a block."""

import struct
import zlib

import numpy as np
import pytest
from tick_log_samples import assert_same_bits, make_rows, make_smooth_rows, pack_rows

from drake_haptics.tick_log.tick_block import (
    BLOCK_HEADER_BYTES,
    MAX_BLOCK_TICKS,
    pack_block,
    parse_block_header,
    unpack_block,
)


def unpack(data):
    header = parse_block_header(data[:BLOCK_HEADER_BYTES])
    return unpack_block(header, data[BLOCK_HEADER_BYTES:])


@pytest.mark.parametrize("ticks", [1, 2, 255, MAX_BLOCK_TICKS])
@pytest.mark.parametrize("make", [make_rows, make_smooth_rows])
def test_a_block_gives_every_bit_back(ticks, make):
    rows = make(ticks)
    assert_same_bits(unpack(pack_rows(rows)), rows)


def decode_by_the_page(data):
    """Reads a block as docs/record-replay.md says, one byte at a time."""
    magic, first, ticks, size, crc, head_crc = struct.unpack_from("<8sQIIII", data)
    assert magic == bytes([0x89]) + b"DHBLK\r\n"
    assert head_crc == zlib.crc32(data[:28])
    payload = data[32 : 32 + size]
    assert crc == zlib.crc32(payload)
    raw = zlib.decompress(payload)
    place, columns = 0, []
    for width, number in [(8, 43), (4, 7)]:
        for _ in range(number):
            planes = [
                raw[place + i * ticks : place + (i + 1) * ticks] for i in range(width)
            ]
            place += width * ticks
            value, column = 0, []
            for k in range(ticks):
                step = sum(plane[k] << (8 * i) for i, plane in enumerate(planes))
                value = (value + step) % (1 << (8 * width))
                column.append(value)
            columns.append(column)
    assert place == len(raw)
    return first, columns


def test_the_layout_is_the_documented_one():
    rows = make_rows(5, first=1 << 40)
    first, columns = decode_by_the_page(pack_rows(rows))
    assert first == 1 << 40
    for i in range(43):
        bits = [struct.unpack("<Q", struct.pack("<d", x))[0] for x in rows.reals[:, i]]
        assert columns[i] == bits
    assert columns[43:] == rows.counts.T.tolist()


def test_smooth_motion_takes_less_room():
    assert len(pack_rows(make_smooth_rows(256))) < 0.9 * 256 * (43 * 8 + 7 * 4)


def forge_header(first=0, ticks=4, size=100, crc=0):
    head = struct.pack("<8sQIII", b"\x89DHBLK\r\n", first, ticks, size, crc)
    return head + struct.pack("<I", zlib.crc32(head))


def test_a_sound_header_is_read():
    header = parse_block_header(forge_header(first=7, ticks=4, size=100, crc=5))
    assert (header.first_tick, header.ticks) == (7, 4)
    assert (header.payload_bytes, header.payload_crc) == (100, 5)


@pytest.mark.parametrize(
    "data",
    [
        forge_header(ticks=MAX_BLOCK_TICKS + 1),
        forge_header(ticks=0xFFFFFFFF),
        forge_header(size=0xFFFFFFFF),
        forge_header(first=(1 << 64) - 1),
        forge_header(ticks=0),
        forge_header(size=0),
        forge_header()[:-1],
        b"X" + forge_header()[1:],
        forge_header()[:-1] + b"\0",
        b"",
    ],
)
def test_a_header_that_cannot_be_believed_is_none(data):
    assert parse_block_header(data) is None


def forge(payload, ticks=4):
    data = forge_header(0, ticks, len(payload), zlib.crc32(payload)) + payload
    return unpack(data)


ROW = 43 * 8 + 7 * 4


@pytest.mark.parametrize(
    "payload",
    [
        b"no zlib",
        zlib.compress(bytes(4 * ROW - 1)),
        zlib.compress(bytes(4 * ROW + 1)),
        zlib.compress(bytes(100_000_000)),
        zlib.compress(bytes(4 * ROW)) + b"more",
        zlib.compress(bytes(4 * ROW))[:-1],
    ],
)
def test_a_payload_of_another_length_is_none(payload):
    assert forge(payload) is None


def test_a_payload_of_the_right_length_is_read():
    rows = forge(zlib.compress(bytes(4 * ROW)))
    assert len(rows) == 4
    assert not rows.reals.any()


def test_one_flipped_bit_is_found():
    data = bytearray(pack_rows(make_smooth_rows(3)))
    for place in range(BLOCK_HEADER_BYTES, len(data)):
        data[place] ^= 1
        assert unpack(bytes(data)) is None
        data[place] ^= 1


def test_nothing_but_an_end_mark_has_no_payload():
    data = pack_block(12, np.zeros((0, 43)), np.zeros((0, 7), np.uint32))
    assert len(data) == BLOCK_HEADER_BYTES
    assert parse_block_header(data).first_tick == 12
