"""Small logs for tests, and their contents."""

import numpy as np

from drake_haptics.tick_log.log_format import (
    COUNTS,
    NUM_REALS,
    TickLogHeader,
    TickRows,
    pack_block,
    pack_header,
)

HEADER = TickLogHeader(
    program_version="1.2.3",
    period_s=1e-3,
    scene="description: für Menschen\n",
    mesh_sha256={"/meshes/cup.obj": "00ff"},
    X_WB=[1.0, 0.0, 0.0, 0.0, 0.1, -0.2, 0.3],
)


def make_rows(ticks, *, first=0, seed=0):
    """Returns rows of any bit patterns at all, NaN of all kinds among them."""
    random = np.random.default_rng([seed, first])
    bits = random.integers(0, 1 << 64, (ticks, NUM_REALS), np.uint64)
    return TickRows(
        np.arange(first, first + ticks),
        bits.view(np.float64),
        random.integers(0, 1 << 32, (ticks, len(COUNTS)), np.uint32),
    )


def make_smooth_rows(ticks, *, amplitude=1.0):
    """Returns rows of waves, with unit quaternions, as a run could have them."""
    rows = make_rows(ticks)
    time = 1e-3 * np.arange(ticks)[:, None]
    rows.reals[:] = amplitude * np.sin(time * np.linspace(1.0, 9.0, NUM_REALS))
    rows["X_WH"][:, :4] = rows["X_WT"][:, :4] = [1.0, 0.0, 0.0, 0.0]
    rows.reals[:, 0] = time[:, 0]
    rows.counts[:] = 1
    return rows


def make_part(rows, start, end):
    """Returns some of the rows."""
    part = slice(start, end)
    return TickRows(rows.ticks[part], rows.reals[part], rows.counts[part])


def pack_rows(rows):
    """Returns a block of rows."""
    return pack_block(int(rows.ticks[0]), rows.reals, rows.counts)


def pack_end(ticks):
    """Returns the end mark."""
    rows = make_rows(0)
    return pack_block(ticks, rows.reals, rows.counts)


def write_log(path, blocks, *, end=None, header=HEADER):
    """Writes a log of blocks, and the end mark of so many ticks if given."""
    data = pack_header(header) + b"".join(map(pack_rows, blocks))
    path.write_bytes(data + (b"" if end is None else pack_end(end)))
    return path


def assert_same_bits(a, b):
    """Compares rows to the last bit, that of a NaN too."""
    np.testing.assert_array_equal(a.ticks, b.ticks)
    np.testing.assert_array_equal(
        np.ascontiguousarray(a.reals).view(np.uint64),
        np.ascontiguousarray(b.reals).view(np.uint64),
    )
    np.testing.assert_array_equal(a.counts, b.counts)
