"""The contacts of a pen drawn through a torus, without Drake and without a diagram.

    python examples/contact_query_without_drake.py

Two meshes are decomposed and 2,000 poses asked in one call: no Python per pose.
"""

from pathlib import Path

import numpy as np

from drake_haptics import ContactStatus, ContactTracker, decompose, load_mesh

meshes = Path(__file__).parents[1] / "models" / "meshes"
pen = decompose(load_mesh(meshes / "pen.obj"))
torus = decompose(load_mesh(meshes / "torus.obj"))
tracker = ContactTracker(pen, torus, tolerance=0.002)

X_WPen = np.tile(np.eye(4), (2000, 1, 1))
X_WPen[:, 0, 3] = np.linspace(-0.1, 0.1, 2000)
trajectory = tracker.query_trajectory(X_WPen, np.eye(4))

print(f"{len(torus.pieces)} pieces against {len(pen.pieces)}: {trajectory}")
for status in ContactStatus:
    print(f"{status.name:12s} {np.count_nonzero(trajectory.status == status):6d}")
deepest = np.argmin(trajectory.distance)
pose = np.searchsorted(trajectory.start, deepest, side="right") - 1
print(f"deepest: {-1e3 * trajectory.distance[deepest]:.2f} mm, at pose {pose},")
print(f"         along {np.round(trajectory.nhat_BA_W[deepest], 3)}")
microseconds = 1e6 * np.percentile(trajectory.seconds, [50, 99])
print("time:    {:.1f} µs a pose, 99 % below {:.1f} µs".format(*microseconds))
