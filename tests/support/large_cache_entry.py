"""An entry of the cache that takes a while to write, for tests of interruption."""

from types import SimpleNamespace

import numpy as np

from drake_haptics.geometry.decomposition.piece_data import PatchLabels

NUM_TRIANGLES = 400_000
MESH = SimpleNamespace(triangles=np.zeros((NUM_TRIANGLES, 3), dtype=np.int32))
PIECES = PatchLabels(np.arange(NUM_TRIANGLES, dtype=np.int32), 1.0)
