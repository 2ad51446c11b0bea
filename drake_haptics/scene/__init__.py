"""Scenes: their keys, where they are found, and how they are read and checked."""
