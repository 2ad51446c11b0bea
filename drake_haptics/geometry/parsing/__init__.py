"""Shapes that Drake knows, as meshes and convex pieces."""
