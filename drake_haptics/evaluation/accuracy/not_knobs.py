"""What else a scene file says, and why no accuracy is bought or sold with it.

Together with `KNOBS` that is every key of a scene: a test holds the two complete.
"""

from __future__ import annotations

# A key, or a part with all that is in it: why it is no knob.
NOT_KNOBS: dict[str, str] = {
    "description": "is for people",
    "tool.mesh": "is what is held",
    "tool.scale": "is its size",
    "tool.center": "is where its frame is",
    "tool.mass_kg": "is its mass",
    "tool.grasp": "is how it is held",
    "environment.name": "is for people",
    "environment.mesh": "is what is there",
    "environment.scale": "is its size",
    "environment.center": "is where its frame is",
    "environment.pose": "is where it stands",
    "environment.material": "is what it is made of",
    "contact.stiffness_N_per_m": "is how hard things are; every value takes as long",
    "contact.damping_Ns_per_m": "is how things bounce; every value takes as long",
    "coupling": "is how firmly the handle holds the tool; every value takes as long",
    "device.preset": "is the device",
    "device.base": "is where it stands",
    "device.max_force_N": "is what it may show",
    "device.max_torque_Nm": "is what it may show",
    "device.twin": "is what a simulated device has of a real one's faults",
    "hand": "is who holds it, and where it goes",
    "effects.shading.crease_angle_deg": "is which edges are meant to be sharp",
    "effects.friction.coefficient": "is how rough things are",
    "effects.friction.break_away_m": "is how they give way before they slip",
    "effects.braking.damping_Ns_per_m": "is how firmly it brakes",
    "effects.braking.distance_m": "is where it begins to brake",
    "effects.gravity.acceleration_m_per_s2": "is where on earth the scene is",
    "effects.passivity.max_damping_Ns_per_m": "is how firmly energy is taken",
    "effects.passivity.max_rotational_damping_Nms_per_rad": "is the same in rotation",
    "effects.passivity.reserve_J": "is how much energy is the scene's own",
}
