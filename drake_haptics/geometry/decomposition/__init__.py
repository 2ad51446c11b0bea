"""Cuts meshes into convex pieces, merges, stores and shows them, without Drake."""
