"""What is wrong with a scene's coupling while people change it."""

from __future__ import annotations

import warnings

from drake_haptics.bounds.coupling import (
    BrokenBound,
    find_broken_bounds,
    find_exceeded_ratings,
)
from drake_haptics.bounds.held_handle import (
    calc_force_delay,
    calc_loosely_held,
    calc_scene_handle,
    find_real_bounds,
)
from drake_haptics.common.errors import SceneError
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import SceneWarning


class CouplingAdvice:
    """What a run warns of, without a new arm for each value that is tried."""

    def __init__(self, scene: Scene):
        """Makes the arms.

        A scene whose hand cannot hold the handle, as the path is out of its reach, can
        still run on a real device: that is a warning.

        Args:
            scene: Its device and hand hold for all that are checked.

        Raises:
            SceneError: There is no such preset, or its model is no arm.
        """
        self._period_s = 1.0 / scene.device.rate_hz
        self._delay_s = calc_force_delay(scene)
        self._preset = load_device_preset(scene.device.preset)
        self._loosely_held = calc_loosely_held(scene, self._preset)
        self._held = None
        if not self._preset.has_model:
            return
        try:
            device = make_simulated_device(scene, make_hand_path(scene.hand.path))
        except SceneError as error:
            words = f"the simulated hand cannot hold the handle: {error}"
            warnings.warn(words, SceneWarning, stacklevel=2)
        else:
            self._held = calc_scene_handle(scene, device)

    @property
    def has_hand(self) -> bool:
        """Whether the scene's device can be simulated, in its hand."""
        return self._held is not None

    def check(self, scene: Scene, *, is_real: bool) -> list[BrokenBound]:
        """Returns each bound that a scene's coupling breaks.

        Args:
            scene: Its coupling is checked.
            is_real: Whether a real device shows its force. It is checked as
                `check_real_coupling` does, by its ratings and in the loosest grip; the
                simulated one as `check_scene_coupling`, in the scene's. Where there is
                no simulated hand, these are the ratings.
        """
        if is_real:
            return find_real_bounds(scene, self._preset, self._loosely_held)
        if self._held is None:
            return find_exceeded_ratings(scene.coupling, self._preset)
        return find_broken_bounds(
            scene.coupling, self._held, self._period_s, self._delay_s
        )
