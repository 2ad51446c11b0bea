"""Gains and poses for tests of a coupling."""

from pydrake.math import RigidTransform, RollPitchYaw

K, B, KR, BR = 800.0, 2.0, 1.5, 0.004
X_HT = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [0.02, -0.01, 0.05])
X_WH = RigidTransform(RollPitchYaw(-0.4, 0.5, 0.6), [0.1, 0.2, 0.3])
