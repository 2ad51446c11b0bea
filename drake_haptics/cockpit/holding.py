"""Who holds the handle of a run, and how it changes hands."""

from __future__ import annotations

from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform

from drake_haptics.cockpit.taken_device import TakenDevice, take_device
from drake_haptics.device.backend import DeviceBackend, DeviceError, GateState
from drake_haptics.device.meshcat_device import MeshcatDevice
from drake_haptics.loop.device_placement import find_device_site, wait_for_reading
from drake_haptics.loop.open_device import open_device
from drake_haptics.scene.schema import Scene
from drake_haptics.web.handle import PageHandle

HAND, MOUSE, SLIDERS, DEVICE = "hand", "mouse", "sliders", "device"
_LABELS = {HAND: "Simulated hand", MOUSE: "Mouse", SLIDERS: "Sliders, gamepad"}
# Addresses of what this page can do by itself.
_OF_PAGE = {"mouse:": MOUSE, "meshcat:": SLIDERS}


class Holding:
    """The handle in somebody's hand: the scene's, the mouse's, a device's.

    Attributes:
        name: `HAND`, `MOUSE`, `SLIDERS` or `DEVICE`.
        backend: What is held; None in the scene's own simulated hand.
        site: Where the scene has its device.
    """

    def __init__(
        self, scene: Scene, meshcat: Meshcat, address: str | None, *, has_hand: bool
    ):
        """Takes what an address names, or the scene's simulated device.

        Args:
            scene: Says where its device stands.
            meshcat: Has a page.
            address: As `open_device`; None for the simulated one.
            has_hand: Whether there is a simulated one.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: As `open_device`.
        """
        self._scene = scene
        self._meshcat = meshcat
        self._address = address
        self.site = find_device_site(scene)
        self._names = dict(_LABELS)
        if not has_hand:
            del self._names[HAND]
        if address is not None and address not in _OF_PAGE:
            self._names[DEVICE] = address
        self.name = HAND
        self.backend: DeviceBackend | None = None
        if address is not None:
            self.take(_OF_PAGE.get(address, DEVICE))

    @property
    def names(self) -> dict[str, str]:
        """Who can hold it, and what people read of them."""
        return self._names

    @property
    def pointer(self) -> PageHandle | None:
        """What the pointer on the page moves, if it holds the handle."""
        return self.backend if isinstance(self.backend, PageHandle) else None

    @property
    def taken(self) -> TakenDevice | None:
        """The device in a hand, if one holds the handle."""
        return self.backend if isinstance(self.backend, TakenDevice) else None

    @property
    def is_felt(self) -> bool:
        """Whether a device is held that shows force."""
        if self.taken is None:
            return False
        reading = self.taken.read()
        return reading is not None and reading.gate == GateState.ACTIVE

    def take(self, name: str, X_WH: RigidTransform | None = None) -> None:
        """Gives the handle to somebody; whoever had it lets go at zero force.

        Args:
            name: One of `names`.
            X_WH: Where the mouse and the sliders take it; where the scene's hand
                starts if not given.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: As `open_device`. It is
                held as before then.
        """
        if name not in self.names:
            raise DeviceError(f"There is nobody called {name!r} to hold the handle.")
        if name == SLIDERS and self.name == SLIDERS:
            # There can be one set of them.
            self.close()
        backend = self._open(name, X_WH)
        self.close()
        self.name, self.backend = name, backend

    def close(self) -> None:
        """Lets go, at zero force; may be called again."""
        if self.backend is not None:
            self.backend.close()

    def _open(self, name: str, X_WH: RigidTransform | None) -> DeviceBackend | None:
        """Returns what is to be held."""
        site = self.site
        X_BH = site.X_BH if X_WH is None else site.X_WB.InvertAndCompose(X_WH)
        if name == MOUSE:
            return PageHandle(
                X_WB=site.X_WB, X_BH=X_BH, workspace_radius_m=site.workspace_radius_m
            )
        if name == SLIDERS:
            return MeshcatDevice(
                self._meshcat,
                X_WB=site.X_WB,
                X_BH=X_BH,
                workspace_radius_m=site.workspace_radius_m,
            )
        if name == DEVICE and self._address is not None:
            return self._open_device(self._address)
        return None

    def _open_device(self, address: str) -> DeviceBackend:
        """Returns a device that has been heard of, and whose force sets in gently."""
        device = open_device(address, self._scene, self._meshcat)
        try:
            wait_for_reading(device)
        except BaseException:
            device.close()
            raise
        return take_device(device, self._scene)
