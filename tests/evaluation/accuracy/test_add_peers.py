"""Other libraries answer the motion that the settings of a study answered."""

from dataclasses import replace

import numpy as np
from accuracy_samples import make_peers, make_study

from drake_haptics.evaluation.accuracy.peers import run as module
from drake_haptics.evaluation.accuracy.recorded_motion import record_motion
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene


def test_peers_get_the_motion_and_the_truth_of_the_study(monkeypatch):
    scene = load_scene(find_scene("sphere_pen"))
    reference = Setting("reference", "exact", {"contact.tolerance_m": 3e-3})
    study = replace(make_study(), ticks=40, reference=reference)
    asked = []

    def run_peers(scene, motion, truth, progress):
        asked.append((motion, truth))
        return make_peers()

    monkeypatch.setattr(module, "run_peers", run_peers)
    with_peers = module.add_peers(study, scene)
    assert with_peers == replace(study, peers=make_peers())
    ((motion, truth),) = asked
    np.testing.assert_array_equal(motion.X_WT, record_motion(scene, 0.04).X_WT)
    assert len(motion) == 40 and truth.tolerance_m == 3e-3
