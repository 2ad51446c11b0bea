"""Helps to write scenes: makes a first one, checks it, and suggests speedups."""
