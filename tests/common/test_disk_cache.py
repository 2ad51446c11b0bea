"""The cache on disk: the same answer, whatever happens to its files."""

import os
import subprocess
import sys
import tempfile
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest
from large_cache_entry import MESH, PIECES
from mesh_samples import box, joined, l_prism

from drake_haptics.common import disk_cache
from drake_haptics.common.disk_cache import cache_folder
from drake_haptics.geometry.decomposition import decompose as decomposition
from drake_haptics.geometry.decomposition import storage
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.decomposition.storage import cache_key, load_cached
from drake_haptics.geometry.mesh.mesh import Mesh


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def mesh():
    return Mesh.from_arrays(*l_prism())


def test_the_folder_follows_the_environment(monkeypatch, tmp_path):
    monkeypatch.delenv("DRAKE_HAPTICS_CACHE", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    assert cache_folder() == tmp_path / ".cache" / "drake_haptics"
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "x"))
    assert cache_folder() == tmp_path / "x" / "drake_haptics"
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "y"))
    assert cache_folder() == tmp_path / "y"


def test_a_user_without_a_home_has_a_cache(monkeypatch):
    def find_none():
        raise RuntimeError("Could not determine home directory.")

    for name in ("DRAKE_HAPTICS_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", find_none)
    assert cache_folder() == Path(tempfile.gettempdir()) / "drake_haptics"


@pytest.mark.parametrize("method", ["surface", "hull"])
def test_the_second_time_no_search_is_made(folder, mesh, method, monkeypatch):
    first = decompose(mesh, method)
    assert not first.report.from_cache and len(list(folder.iterdir())) == 1

    def fail(*args):
        raise AssertionError("the pieces were searched again")

    monkeypatch.setattr(decomposition, "_find_pieces", fail)
    second = decompose(mesh, method)
    assert second.report.from_cache
    assert len(first.pieces) == len(second.pieces)
    for p, q in zip(first.pieces, second.pieces, strict=True):
        np.testing.assert_array_equal(p.vertices, q.vertices)
        np.testing.assert_array_equal(p.facet_original, q.facet_original)


def test_without_the_cache_nothing_is_written(folder, mesh):
    decompose(mesh, cache=False)
    assert not folder.exists()


def test_the_key_depends_on_everything_the_pieces_depend_on(mesh, monkeypatch):
    V, F = l_prism()
    moved = V.copy()
    moved[0, 0] = np.nextafter(moved[0, 0], 1)
    keys = [
        cache_key(mesh, "surface", {}),
        cache_key(Mesh.from_arrays(moved, F), "surface", {}),
        cache_key(Mesh.from_arrays(V, F[1:]), "surface", {}),
        cache_key(Mesh.from_arrays(V, np.roll(F, 1, axis=0)), "surface", {}),
        cache_key(mesh, "hull", {}),
        cache_key(mesh, "surface", {"concavity": 0.1}),
    ]
    monkeypatch.setattr(storage, "_core_digest", lambda: "another core")
    keys.append(cache_key(mesh, "surface", {}))
    assert len(set(keys)) == len(keys)
    monkeypatch.undo()
    assert cache_key(Mesh.from_arrays(V, F), "surface", {}) == keys[0]


@pytest.mark.parametrize("damage", ["truncated", "empty", "noise", "another entry"])
def test_a_damaged_entry_is_made_again_and_replaced(folder, mesh, damage):
    decompose(mesh)
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    if damage == "another entry":
        decompose(Mesh.from_arrays(*box()))
        (other,) = set(folder.iterdir()) - {path}
        path.write_bytes(other.read_bytes())
    else:
        content = {
            "truncated": whole[: len(whole) // 2],
            "empty": b"",
            "noise": b"!" * 99,
        }
        path.write_bytes(content[damage])
    assert not decompose(mesh).report.from_cache
    assert decompose(mesh).report.from_cache


def test_a_folder_that_cannot_be_written_does_not_stop_the_work(
    tmp_path, mesh, caplog, monkeypatch
):
    (tmp_path / "file").touch()
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "file" / "cache"))
    assert decompose(mesh).report.pieces > 1
    assert "no mesh can be kept in" in caplog.text


def test_old_entries_and_abandoned_files_go(folder, mesh, monkeypatch):
    folder.mkdir()
    old, fresh = folder / ".a.npz.1.tmp", folder / ".b.npz.2.tmp"
    for path in (old, fresh):
        path.touch()
    os.utime(old, (time.time() - 7200,) * 2)
    decompose(mesh)
    assert not old.exists() and fresh.exists()
    for method in ("surface", "hull"):
        decompose(Mesh.from_arrays(*box()), method)
    entries = sorted(folder.glob("*.npz"))
    for age, path in enumerate(entries):
        os.utime(path, (time.time() - 60 * age,) * 2)
    total = sum(path.stat().st_size for path in entries)
    monkeypatch.setattr(disk_cache, "MAX_CACHE_BYTES", total)
    decompose(Mesh.from_arrays(*box(at=(1, 2, 3))))  # one more has no room
    kept = set(folder.glob("*.npz"))
    assert entries[0] in kept and entries[-1] not in kept
    assert sum(path.stat().st_size for path in kept) <= total


SUPPORT = str(Path(__file__).parents[1] / "support")
WRITER = textwrap.dedent(
    """
    import sys
    sys.path.insert(0, sys.argv[2])
    from large_cache_entry import MESH, PIECES
    from drake_haptics.geometry.decomposition.storage import load_cached, store_cached

    print("ready", flush=True)
    for _ in range(int(sys.argv[1])):
        store_cached("key", PIECES)
        assert load_cached("key", MESH) is not None, "read a file that is not whole"
    """
)


def start_writer(rounds):
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(rounds), SUPPORT],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "ready\n", process.stderr.read()
    return process


def test_two_processes_may_write_the_same_entry_at_once(folder):
    writers = [start_writer(100) for _ in range(2)]
    for writer in writers:
        _, error = writer.communicate(timeout=180)
        assert writer.returncode == 0, error
    assert [path.name for path in folder.iterdir()] == ["key.npz"]


def test_a_writer_killed_at_any_time_leaves_a_whole_entry_or_none(folder):
    for delay in (0.0, 0.004, 0.011, 0.023):
        writer = start_writer(1_000_000)
        time.sleep(delay)
        writer.kill()  # SIGKILL
        writer.communicate()
        read = load_cached("key", MESH)
        if (folder / "key.npz").exists():
            np.testing.assert_array_equal(
                read.piece_of_triangle, PIECES.piece_of_triangle
            )


def test_parts_that_differ_only_in_solidity_have_different_keys():
    V, F = joined(box(), box(at=(3, 0, 0)))
    whole = Mesh.from_arrays(V, F)
    assert cache_key(whole, "surface", {}) != cache_key(
        Mesh.from_arrays(V, F[:-1]), "surface", {}
    )
