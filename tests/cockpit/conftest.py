"""A plate, a page and runs on it, for all tests of the cockpit."""

import pytest
from box_scenes import over_a_plate
from cockpit_rig import ABOVE, PRESSING, CockpitRig

from drake_haptics.visualization.meshcat import start_meshcat


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return over_a_plate(tmp_path_factory.mktemp("scene"), [ABOVE, PRESSING])


@pytest.fixture(scope="module")
def meshcat():
    return start_meshcat()


@pytest.fixture
def make(scene, meshcat, monkeypatch):
    rigs = []

    def make(script, scene=scene, **options):
        rigs.append(CockpitRig(scene, meshcat, monkeypatch, script, **options))
        return rigs[-1]

    yield make
    for rig in rigs:
        rig.holder.close()
