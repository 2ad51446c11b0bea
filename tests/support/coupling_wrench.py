"""The virtual coupling's wrenches by poses, velocities and gains, each for itself."""

from __future__ import annotations

import numpy as np

from drake_haptics._core import CouplingGains, joined_coupling_wrench


def coupling_wrench(
    q_WH: np.ndarray,
    V_WH: np.ndarray,
    q_HT: np.ndarray,
    q_WT: np.ndarray,
    V_WT: np.ndarray,
    gains: CouplingGains,
) -> np.ndarray:
    """Returns (84,): the wrench model on the tool at To (78), then the reaction (6)."""
    numbers = [
        gains.stiffness_N_per_m,
        gains.damping_Ns_per_m,
        gains.rotational_stiffness_Nm_per_rad,
        gains.rotational_damping_Nms_per_rad,
        gains.max_force_N,
        gains.max_torque_Nm,
    ]
    joined = np.concatenate([q_WH, V_WH, q_WT, V_WT, numbers])
    return joined_coupling_wrench(joined, np.asarray(q_HT))
