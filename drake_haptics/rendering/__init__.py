"""Adds haptic rendering to your own plant."""
