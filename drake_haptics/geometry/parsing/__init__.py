"""Converts shapes of Drake to meshes and convex pieces."""
