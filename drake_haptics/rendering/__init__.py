"""Haptic rendering in a plant of your own."""
