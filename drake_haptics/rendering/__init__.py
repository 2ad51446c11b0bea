"""Haptic rendering in your own plant."""
