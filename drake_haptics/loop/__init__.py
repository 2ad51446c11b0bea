"""The haptic loop of a scene, wired."""
