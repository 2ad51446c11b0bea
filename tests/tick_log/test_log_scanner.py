"""Damaged logs: what is sound is given, what is not is told, nothing is invented."""

import random
import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tick_log_samples import (
    HEADER,
    assert_same_bits,
    make_part,
    make_rows,
    make_smooth_rows,
    pack_end,
    pack_rows,
    write_log,
)

from drake_haptics.tick_log.log_format import (
    BLOCK_MAGIC,
    TickLogError,
    join_rows,
    pack_header,
)
from drake_haptics.tick_log.tick_log import Gap, read_tick_log

BLOCKS = [make_rows(7), make_rows(5, first=7), make_rows(9, first=12)]
TICKS = 21
HEAD = pack_header(HEADER)
PACKED = [pack_rows(rows) for rows in BLOCKS]
SOUND = HEAD + b"".join(PACKED) + pack_end(TICKS)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("log") / "run.tick"


def read(path, data):
    path.write_bytes(data)
    return read_tick_log(path)


def check_honest(log):
    """Checks that what is given was recorded, and that the rest is told."""
    truth = join_rows(BLOCKS)
    assert_same_bits(
        log.rows,
        type(truth)(
            log.rows.ticks, truth.reals[log.rows.ticks], truth.counts[log.rows.ticks]
        ),
    )
    told = set(log.rows.ticks.tolist())
    for gap in log.gaps:
        end = TICKS if gap.ticks is None else gap.first_tick + gap.ticks
        missing = set(range(gap.first_tick, end))
        assert not missing & told
        told |= missing
    assert told == set(range(TICKS))


def test_a_sound_log_is_whole(path):
    log = read(path, SOUND)
    assert_same_bits(log.rows, join_rows(BLOCKS))
    assert (log.header, log.gaps, log.damaged_blocks) == (HEADER, (), 0)


def test_a_log_that_is_being_written_has_no_end(path):
    log = read(path, HEAD + PACKED[0])
    assert log.gaps == (Gap(7, None),)
    assert "from tick 7 (0.007 s) on is missing" in log.describe_gaps()[0]
    assert read(path, HEAD).gaps == (Gap(0, None),)


def test_a_log_is_cut_anywhere(path):
    whole = np.cumsum([len(HEAD), *map(len, PACKED)])
    borders = {int(border) + i for border in whole for i in range(-40, 40)}
    cuts = borders | set(range(len(HEAD), len(SOUND), 97))
    for length in sorted(cut for cut in cuts if len(HEAD) <= cut < len(SOUND)):
        log = read(path, SOUND[:length])
        check_honest(log)
        assert log.gaps[-1].ticks is None
        assert len(log.rows) == [0, 7, 12, 21][np.count_nonzero(whole <= length) - 1]


def test_a_damaged_block_in_the_middle_is_skipped(path):
    for place in (0, 9, 20, 29, 40, len(PACKED[1]) - 1):
        broken = bytearray(PACKED[1])
        broken[place] ^= 0x40
        log = read(path, HEAD + PACKED[0] + broken + PACKED[2] + pack_end(TICKS))
        assert log.gaps == (Gap(7, 5),)
        assert log.damaged_blocks == 1
        assert log.describe_gaps() == ["5 ticks are missing from tick 7 (0.007 s)"]
        assert len(log.rows) == 16
        assert log.count_ticks_from_start() == 7
        check_honest(log)


def test_bytes_between_blocks_do_no_harm(path):
    # Of a length that puts a header across the borders of what is read at once.
    for length in [1, 31, (1 << 20) - len(PACKED[0]) - 16, 1 << 20]:
        log = read(path, HEAD + PACKED[0] + bytes(length) + b"".join(PACKED[1:]))
        assert len(log.rows) == TICKS
        assert (log.damaged_blocks, log.gaps) == (1, (Gap(TICKS, None),))


def test_ticks_that_come_again_are_left_out(path):
    data = HEAD + PACKED[0] + PACKED[1] + PACKED[0] + PACKED[2] + pack_end(TICKS)
    log = read(path, data)
    assert_same_bits(log.rows, join_rows(BLOCKS))
    assert log.damaged_blocks == 1


@pytest.mark.parametrize("removed", [0, 1, 5])
def test_another_log_that_is_appended_does_not_continue_a_cut_one(path, removed):
    cut = HEAD + PACKED[0] + PACKED[1]
    cut = cut[: len(cut) - removed]
    log = read(path, cut + SOUND)
    kept = BLOCKS[: 1 if removed else 2]
    assert_same_bits(log.rows, join_rows(kept))
    assert log.gaps == (Gap(sum(map(len, kept)), None),)


def test_an_end_mark_that_lies_is_no_end(path):
    log = read(path, HEAD + PACKED[0] + pack_end(3) + PACKED[1] + PACKED[2])
    assert len(log.rows) == TICKS


def test_a_lost_tail_is_counted_by_the_end_mark(path):
    log = read(path, HEAD + PACKED[0] + PACKED[1] + pack_end(TICKS))
    assert log.gaps == (Gap(12, 9),)


@given(st.integers(0, len(SOUND)), st.binary(max_size=80), st.integers(0, 200))
def test_any_bytes_replaced_anywhere(path, place, data, removed):
    try:
        log = read(path, SOUND[:place] + data + SOUND[place + removed :])
    except TickLogError:
        assert place < len(HEAD)
        return
    check_honest(log)


@given(st.lists(st.integers(0, 8 * len(SOUND) - 1), min_size=1, max_size=30))
def test_any_bits_flipped(path, places):
    data = bytearray(SOUND)
    for place in places:
        data[place // 8] ^= 1 << (place % 8)
    try:
        log = read(path, bytes(data))
    except TickLogError:
        assert min(places) < 8 * len(HEAD)
        return
    check_honest(log)


@given(st.binary(max_size=2000))
def test_any_bytes_at_all(path, data):
    with pytest.raises(TickLogError):
        read(path, data)
    assert len(read(path, HEAD + data).rows) == 0


def test_a_flood_of_magic_words_is_read_in_little_room(path):
    path.write_bytes(HEAD + BLOCK_MAGIC * 50_000 + PACKED[0])
    tracemalloc.start()
    try:
        log = read_tick_log(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(log.rows) == 7
    assert peak < 8 << 20


def test_a_log_of_many_blocks_loses_only_what_is_hit(path):
    rows = make_smooth_rows(2000)
    parts = [make_part(rows, i, i + 50) for i in range(0, 2000, 50)]
    data = bytearray(write_log(path, parts, end=2000).read_bytes())
    hit = random.Random(3).sample(range(len(HEAD), len(data)), 5)
    for place in hit:
        data[place] ^= 0xFF
    log = read(path, bytes(data))
    assert 2000 - 5 * 50 <= len(log.rows) < 2000
    assert sum(gap.ticks for gap in log.gaps) == 2000 - len(log.rows)
