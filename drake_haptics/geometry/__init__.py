"""Meshes, their convex pieces, and the shapes of Drake's bodies."""
