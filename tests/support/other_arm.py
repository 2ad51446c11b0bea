"""A second arm of six revolute joints: other lengths, masses, names and axes."""

from __future__ import annotations

from pathlib import Path

# Child link, axis, where its joint is in the base's frame (m), mass (kg).
_LINKS = [
    ("column", "0 0 1", "0 0 0", 0.4),
    ("boom", "0 1 0", "0 0 0.1", 0.3),
    ("jib", "0 1 0", "0.2 0 0.1", 0.2),
    ("wrist_yaw", "0 0 1", "0.2 0 -0.08", 0.03),
    ("wrist_pitch", "0 1 0", "0.2 0 -0.08", 0.03),
    ("grip", "1 0 0", "0.2 0 -0.08", 0.05),
]
PRESET = """\
description: An arm of my own
source: measured
model: my_arm.sdf
handle_link: grip
workspace_center_m: [0.2, 0.0, -0.08]
workspace_radius_m: 0.1
max_force_N: 5.0
max_torque_Nm: 0.1
motors:
  encoder_step_rad: [1e-4, 1e-4, 1e-4, 2e-4, 2e-4, 2e-4]
"""


def write_model(path: Path) -> None:
    """Writes the arm as SDF."""
    parts = ['<link name="base"/>']
    parent = "base"
    for name, axis, place, mass in _LINKS:
        inertia = "".join(
            f"<{key}>{mass * 1e-3}</{key}>" for key in ("ixx", "iyy", "izz")
        )
        parts.append(
            f'<link name="{name}"><pose>{place} 0 0 0</pose>'
            f"<inertial><mass>{mass}</mass><inertia>{inertia}</inertia></inertial>"
            f'</link><joint name="{name}_joint" type="revolute">'
            f"<parent>{parent}</parent><child>{name}</child>"
            f"<axis><xyz>{axis}</xyz><dynamics><damping>1e-3</damping></dynamics></axis>"
            "</joint>"
        )
        parent = name
    path.write_text(
        f'<sdf version="1.9"><model name="my_arm">{"".join(parts)}</model></sdf>'
    )


def write_preset(folder: Path, text: str = PRESET) -> Path:
    """Writes the arm's model and a preset of it; returns the preset's file."""
    folder.mkdir(parents=True, exist_ok=True)
    write_model(folder / "my_arm.sdf")
    path = folder / "my_arm.yaml"
    path.write_text(text)
    return path
