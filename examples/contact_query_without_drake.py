"""Contacts of meshes without Drake: where a pen drawn across a ring touches it.

    python examples/contact_query_without_drake.py

Two meshes are cut into convex pieces and 2,000 poses asked in one call: no Python per
pose. The hole of the ring is felt: the pen touches on the way in, is free in the
middle, and touches again on the way out, where its radius and those of the ring say.
"""

import numpy as np

from drake_haptics import ContactTracker, decompose, find_mesh, load_mesh

pen = decompose(load_mesh(find_mesh("pen")))
ring = decompose(load_mesh(find_mesh("torus")))
tracker = ContactTracker(pen, ring, tolerance=0.002)

# The pen stands upright and moves along x, through the middle of the ring.
X_WPen = np.tile(np.eye(4), (2000, 1, 1))
X_WPen[:, 0, 3] = np.linspace(-0.08, 0.08, 2000)
X_WPen[:, 2, 3] = -0.05
trajectory = tracker.query_trajectory(X_WPen, np.eye(4))
least_m = np.array([contacts.least_distance for contacts in trajectory])

print(f"{len(ring.pieces)} pieces of the ring against {len(pen.pieces)} of the pen")
print(trajectory)
edges = np.flatnonzero(np.diff(least_m < 0.0))
for first, last in edges.reshape(-1, 2):
    start_mm, end_mm = 1e3 * X_WPen[[first, last], 0, 3]
    print(f"touches from x = {start_mm:.1f} mm to {end_mm:.1f} mm")
print(f"expected {22 - 4.5:.1f} and {46 + 4.5:.1f} mm: radii of hole, ring and pen")
microseconds = 1e6 * np.percentile(trajectory.seconds, [50, 99])
print("time: {:.1f} µs a pose, 99 % below {:.1f} µs".format(*microseconds))
