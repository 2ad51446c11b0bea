"""Settings of how exactly the shapes of tool and objects are taken."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from typing import Any

from drake_haptics.evaluation.accuracy.knob_values import format_length, with_own
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.geometry.mesh.mesh import load_mesh
from drake_haptics.geometry.parsing.model_file import (
    DEFAULT_CHORD_ERROR_M,
    is_model_file,
    load_model_mesh,
)
from drake_haptics.scene.schema import EnvironmentObject, Scene, Tool

# Shares of a mesh's triangles; fewer than this many are no shape any more.
_TRIANGLES = (2, 4, 8)
_LEAST_TRIANGLES = 20
_MERGED_M = (1e-4, 3e-4, 1e-3)
_CHORDS_M = (2.5e-5, 4e-4, 1.6e-3)


def list_decompositions(scene: Scene, where: str) -> list[Setting]:
    """Returns ways to cut a mesh, those that are installed.

    Args:
        scene: Has the meshes.
        where: `tool`, or `environment` for all objects.
    """
    key, error = f"{where}.decomposition", f"{where}.decomposition_error_m"
    words = {"surface": "exact pieces", "coacd": "CoACD's pieces", "hull": "one hull"}
    if find_spec("coacd") is None:
        del words["coacd"]
    exact, *approximate = [
        Setting(key, label, {key: name, error: None}) for name, label in words.items()
    ]
    merged = [
        Setting(key, f"merged within {format_length(m)}", {key: "merged", error: m})
        for m in with_own(_MERGED_M, _find_own(scene, where, "decomposition_error_m"))
    ]
    return [exact, *merged, *approximate]


def list_triangle_counts(scene: Scene, where: str) -> list[Setting]:
    """Returns decimations, of meshes that have triangles to spare."""
    key = f"{where}.max_triangles"
    largest = max(_count_triangles(part) for part in _find_parts(scene, where))
    counts = with_own(
        [largest // n for n in _TRIANGLES if largest // n >= _LEAST_TRIANGLES],
        _find_own(scene, where, "max_triangles"),
    )
    return [
        Setting(key, f"all of {largest} triangles", {key: None}),
        *(
            Setting(key, f"{count} triangles", {key: count})
            for count in reversed(counts)
        ),
    ]


def list_chord_errors(scene: Scene, where: str) -> list[Setting]:
    """Returns how well polytopes follow round shapes, where there are any."""
    key, own_m = f"{where}.chord_error_m", _find_own(scene, where, "chord_error_m")
    parts = _find_parts(scene, where)
    # Meshes of triangles have none, and no such key.
    if not all(is_model_file(part.mesh) for part in parts):
        return []
    if not any(_is_round(part) for part in parts):
        return []
    default_m = None if own_m is None else DEFAULT_CHORD_ERROR_M
    return [
        Setting(
            key,
            format_length(m),
            {key: default_m if m == DEFAULT_CHORD_ERROR_M else m},
        )
        for m in with_own([*_CHORDS_M, DEFAULT_CHORD_ERROR_M], own_m)
    ]


def _find_parts(scene: Scene, where: str) -> Sequence[Tool | EnvironmentObject]:
    return [scene.tool] if where == "tool" else scene.environment


def _find_own(scene: Scene, where: str, name: str) -> Any:
    """Returns what all parts have; None where they differ."""
    own = {getattr(part, name) for part in _find_parts(scene, where)}
    return own.pop() if len(own) == 1 else None


def _count_triangles(
    part: Tool | EnvironmentObject, chord_error_m: float | None = None
) -> int:
    """Returns how many triangles a part has before it is reduced."""
    if not is_model_file(part.mesh):
        return len(load_mesh(part.mesh, scale=part.scale).triangles)
    error_m = chord_error_m or part.chord_error_m or DEFAULT_CHORD_ERROR_M
    mesh = load_model_mesh(
        part.mesh, scale=part.scale, chord_error_m=error_m / part.scale
    )
    return len(mesh.triangles)


def _is_round(part: Tool | EnvironmentObject) -> bool:
    """Whether a part has shapes that a finer polytope follows better."""
    fine, coarse = (_count_triangles(part, _CHORDS_M[i]) for i in (0, -1))
    return fine > coarse
