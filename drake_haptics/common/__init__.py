"""Shared by every part of the package: errors, words, poses, colors, time."""
