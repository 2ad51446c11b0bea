"""Builds the haptic loop of a scene."""
