"""Combines settings step by step, from the scene as it is to the fastest."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, Row
from drake_haptics.evaluation.accuracy.setting import Setting, is_effect
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import check_values

# Rate, device and hand do not make a tick cheaper, and passivity is for safety.
_NEVER = ("device.", "coupling.", "hand.", "effects.passivity")
# Savings below this share of the scene's tick are within the scatter of runs.
_LEAST_SAVING = 0.02


@dataclass(frozen=True)
class Combination:
    """Rows of several knobs, in the order of their choice.

    The 99th percentile of the tick is estimated as the scene's minus the rows' savings.
    """

    rows: tuple[Row, ...]
    p99_us: float

    @property
    def setting(self) -> Setting:
        """All rows as one setting."""
        label = ", ".join(f"{r.setting.knob} {r.setting.label}" for r in self.rows)
        return Setting("several", label, merge_changes(self.rows))


def list_combinations(study: AccuracyStudy, scene: Scene) -> list[Combination]:
    """Returns combinations of a study's settings, each faster than the one before.

    The first is the scene as it is. Each further one turns the knob whose saving costs
    the least force error, root mean square, per microsecond of the tick's 99th
    percentile: the greedy solution of a knapsack problem with a choice from each knob.
    Effects that the scene names go last, after all settings of accuracy.

    Settings of device, coupling, hand and passivity control are never used, nor are
    those that diverge, that make the scene's coupling unstable, or whose force error
    exceeds what the device can show.

    Raises:
        ValueError: The study has no figures of the unchanged scene.
    """
    start = next((r for r in study.rows if r.is_scene and r.cost and r.errors), None)
    if start is None:
        raise ValueError(f"the study of {study.scene} did not measure the scene itself")
    rows = list(_find_allowed(study.rows, scene))
    chain = [Combination((), _p99(start))]
    for effects in (False, True):
        group = [row for row in rows if is_effect(row.setting) == effects]
        while move := _find_cheapest_move(chain[-1].rows, group, start, scene):
            turned = _turn(chain[-1].rows, move)
            saved_us = sum(_p99(start) - _p99(row) for row in turned)
            chain.append(Combination(turned, _p99(start) - saved_us))
    return chain


def merge_changes(rows: Iterable[Row]) -> dict[str, Any]:
    """Returns the changes of all rows together."""
    return {k: v for row in rows for k, v in row.setting.changes.items()}


def _find_allowed(rows: Iterable[Row], scene: Scene) -> Iterator[Row]:
    """Yields the rows that may be used."""
    max_force_N = find_device_site(scene).max_force_N
    for row in rows:
        if row.cost is None or row.errors is None or row.is_scene:
            continue
        stable = row.errors.stable_stiffness_N_per_m
        if (
            any(_is_never(key, value) for key, value in row.setting.changes.items())
            or not math.isfinite(row.errors.energy_created_J)
            or row.errors.force_max_N > max_force_N
            or (stable is not None and stable < scene.coupling.stiffness_N_per_m)
        ):
            continue
        yield row


def _is_never(key: str, value: Any) -> bool:
    adds_effect = key.startswith("effects.") and value is not None
    return adds_effect or key.startswith(_NEVER)


def _find_cheapest_move(
    chosen: tuple[Row, ...], rows: Iterable[Row], start: Row, scene: Scene
) -> Row | None:
    """Returns the row that saves time for the least error beyond the chosen rows."""
    now = {row.setting.knob: row for row in chosen}
    best, best_price = None, (math.inf, 0.0)
    for row in rows:
        before = now.get(row.setting.knob, start)
        saving_us = _p99(before) - _p99(row)
        if saving_us < _LEAST_SAVING * _p99(start):
            continue
        loss_N = max(_error(row) - _error(before), 0.0)
        # Of two rows that cost nothing, the one that saves more wins.
        price = (loss_N / saving_us, -saving_us)
        if price < best_price and _fits(_turn(chosen, row), scene):
            best, best_price = row, price
    return best


def _turn(chosen: tuple[Row, ...], row: Row) -> tuple[Row, ...]:
    """Returns the chosen rows with one knob turned to a row."""
    others = tuple(r for r in chosen if r.setting.knob != row.setting.knob)
    return (*others, row)


def _fits(rows: tuple[Row, ...], scene: Scene) -> bool:
    """Returns whether rows do not conflict and make a valid scene."""
    changes = merge_changes(rows)
    if any(changes[k] != v for row in rows for k, v in row.setting.changes.items()):
        return False
    try:
        check_values(Setting("several", "", changes).apply(scene))
    except HapticsError:
        return False
    return True


def _p99(row: Row) -> float:
    assert row.cost is not None
    return row.cost.tick.p99_us


def _error(row: Row) -> float:
    assert row.errors is not None
    return row.errors.force_rms_N
