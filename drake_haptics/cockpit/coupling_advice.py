"""What is wrong with a scene's coupling while people change it."""

from __future__ import annotations

from drake_haptics.bounds.coupling import (
    BrokenBound,
    find_broken_bounds,
    find_exceeded_ratings,
)
from drake_haptics.bounds.held_handle import calc_force_delay, calc_scene_handle
from drake_haptics.common.errors import SceneError
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import Scene


class CouplingAdvice:
    """`check_scene_coupling`, without a new arm for each value that is tried."""

    def __init__(self, scene: Scene):
        """Makes the arm.

        Args:
            scene: Its device and hand hold for all that are checked.
        """
        self._period_s = 1.0 / scene.device.rate_hz
        self._delay_s = calc_force_delay(scene)
        self._preset = load_device_preset(scene.device.preset)
        try:
            device = make_simulated_device(scene, make_hand_path(scene.hand.path))
        except SceneError:
            # Of a device without a model, or out of whose reach the path is.
            self._held = None
        else:
            self._held = calc_scene_handle(scene, device)

    @property
    def has_hand(self) -> bool:
        """Whether the scene's device can be simulated, in its hand."""
        return self._held is not None

    def check(self, scene: Scene) -> list[BrokenBound]:
        """Returns each bound that a scene's coupling breaks.

        Where there is no arm, these are the ratings of the scene's device.
        """
        if self._held is None:
            return find_exceeded_ratings(scene.coupling, self._preset)
        return find_broken_bounds(
            scene.coupling, self._held, self._period_s, self._delay_s
        )
