"""Helpers for all parts of the package: errors, text, poses, colors, time."""
