"""Brings the live values of a scene to others without a step of force."""

from __future__ import annotations

from collections.abc import Sequence

from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.live_key import LiveKey, live_keys

GLIDE_S = 0.2
"""From one value to another, s: what a device's gate takes to let a force in."""


class LiveGlide:
    """Live values on their way.

    A gain that rises by a factor makes a force that is held rise by as much: written
    at once it kicks whoever holds the device. Here a force changes by no more than a
    few hundredths of itself in a tick.

    Attributes:
        is_moving: Whether a value is on its way.
    """

    def __init__(self, period_s: float):
        """Begins without values.

        Args:
            period_s: The tick, s.
        """
        self._steps = max(1, round(GLIDE_S / period_s))
        self._keys: Sequence[LiveKey] = ()
        self._start: dict[str, float] = {}
        self._goal: dict[str, float] = {}
        self._now: dict[str, float] = {}
        self._step = self._steps
        self.is_moving = False

    def aim(self, scene: Scene) -> None:
        """Sets out for the values of a scene, from where the values are.

        What had no value yet has the scene's at once.

        Args:
            scene: Where to.
        """
        self._keys = live_keys(scene)
        self._goal = {item.key: item.read(scene) for item in self._keys}
        self._start = {**self._goal, **self._now}
        self._now = {key: self._start[key] for key in self._goal}
        self._step = 0
        self.is_moving = self._now != self._goal

    def advance(self) -> None:
        """Goes on by a tick."""
        self._step += 1
        share = self._step / self._steps
        if share >= 1.0:
            self._now, self.is_moving = dict(self._goal), False
            return
        self._now = {
            item.key: _blend(item, self._start[item.key], self._goal[item.key], share)
            for item in self._keys
        }

    def apply(self, scene: Scene) -> Scene:
        """Returns a scene with the values as they are now."""
        for item in self._keys:
            scene = item.change(scene, self._now[item.key])
        return scene


def _blend(item: LiveKey, start: float, goal: float, share: float) -> float:
    """Returns the value so far on the way: of gains in equal ratios.

    A force is in proportion to a gain, but grows by so much for each meter.
    """
    if start == goal:
        return goal
    if item.unit == "m" or min(start, goal) <= 0.0:
        return start + share * (goal - start)
    return start * (goal / start) ** share
