"""However often a run is built, only what runs is kept."""

import gc
import weakref
from types import SimpleNamespace

from box_scenes import over_a_plate
from cockpit_rig import ABOVE, PRESSING, CockpitRig

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.simulation.transfer_state import release_diagram
from drake_haptics.visualization.meshcat import start_meshcat

TOGGLES = 4


def test_what_ran_before_is_freed(tmp_path, monkeypatch):
    scene = over_a_plate(tmp_path, [ABOVE, PRESSING])
    script = {
        260 * (k + 1): [{"do": "effect", "name": "friction", "on": k % 2 == 0}]
        for k in range(TOGGLES)
    }
    known = []

    def watch(haptic, root):
        if not known or known[-1][0]() is not haptic.diagram:
            loop = haptic.loop
            parts = (haptic.diagram, loop.device, loop.contact_query)
            known.append([weakref.ref(part) for part in parts])
        del rig.haptics[:-1]

    rig = CockpitRig(scene, start_meshcat(), monkeypatch, script, watch=watch)
    rig.run(0.26 * (TOGGLES + 1))
    assert len(known) == TOGGLES + 1
    gc.collect()
    *before, last = known
    assert all(part() is not None for part in last)
    for diagram, device, query in before:
        assert diagram() is device() is None
        # pydrake may keep the bare system, but nothing that it had.
        assert query() is None or not vars(query())
    assert vars(last[2]())


def test_pydrake_frees_a_diagram_whose_systems_have_no_attributes(tmp_path):
    """`release_diagram` rests on this: a change of pydrake fails here first."""
    haptic = BuildHapticDiagram(over_a_plate(tmp_path, [ABOVE]))
    diagram = weakref.ref(haptic.diagram)
    release_diagram(haptic)
    del haptic
    gc.collect()
    assert diagram() is None


def test_a_system_without_attributes_is_left_as_it_is():
    class Bare:
        """A system of bindings that give it none."""

        __slots__ = ()

    release_diagram(SimpleNamespace(diagram=Bare()))
