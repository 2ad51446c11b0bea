"""The head of a log: the layout, and what is refused with what to do."""

import io
import json
import struct
import zlib

import pytest
from tick_log_samples import HEADER

from drake_haptics.tick_log.log_format import TickLogError, pack_header, read_header


def forge(text, *, version=1, magic=b"\x89DHLOG\r\n"):
    """Returns a head of any JSON, laid out as the page says."""
    data = struct.pack("<8sHHI", magic, version, 0, len(text)) + text
    return data + struct.pack("<I", zlib.crc32(data))


def read(data):
    return read_header(io.BytesIO(data), "run.tick")


def make_json(**changes):
    facts = vars(HEADER) | changes
    return json.dumps({k: v for k, v in facts.items() if v is not None}).encode()


def test_the_head_is_laid_out_as_documented():
    assert read(forge(make_json())) == HEADER
    assert pack_header(HEADER) == forge(make_json())


def test_the_first_block_comes_next():
    stream = io.BytesIO(pack_header(HEADER) + b"block")
    read_header(stream, "run.tick")
    assert stream.read() == b"block"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "not a tick log"),
        (b"\x89PNG\r\n\x1a\n" + bytes(100), "not a tick log; record one with"),
        (forge(make_json(), version=2), "format version 2.*reads version 1"),
        (pack_header(HEADER)[:-1], "damaged or was never finished"),
        (pack_header(HEADER)[:40], "damaged or was never finished"),
        (forge(b"[]"), "needs X_WB"),
        (forge(b"{"), "does not say"),
        (forge(b"[" * 100_000), "does not say"),
        (forge(b"\xff"), "does not say"),
        (forge(make_json(scene=None)), "needs X_WB"),
        (forge(make_json(scene=3)), "is not text"),
        (forge(make_json(mesh_sha256=[])), "not an object"),
        (forge(make_json(mesh_sha256={"a": 1})), "is not text"),
        (forge(make_json(X_WB=[1.0])), "7 numbers"),
        (forge(make_json(X_WB=[0.0] * 7)), "a pose"),
        (forge(make_json(X_WB=[1e-200, *[0.0] * 6])), "a pose"),
        (forge(make_json(X_WB=[1e200, *[0.0] * 6])), "a pose"),
        (forge(make_json(X_WB=[[], 1, 2, 3, 4, 5, 6])), "a number is not"),
        (forge(make_json(period_s=0.0)), "positive"),
        (forge(make_json(period_s=float("nan"))), "a number is not"),
        (forge(make_json(period_s=True)), "a number is not"),
    ],
)
def test_what_is_no_head_is_refused_in_words(data, words):
    with pytest.raises(TickLogError, match=words):
        read(data)


def test_a_forged_length_takes_no_room():
    data = struct.pack("<8sHHI", b"\x89DHLOG\r\n", 1, 0, 0xFFFFFFFF) + b"{}"
    with pytest.raises(TickLogError, match="damaged"):
        read(data)


def test_every_flipped_bit_is_found():
    data = bytearray(pack_header(HEADER))
    for place in range(len(data)):
        data[place] ^= 16
        with pytest.raises(TickLogError):
            read(bytes(data))
        data[place] ^= 16
