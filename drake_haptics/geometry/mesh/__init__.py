"""Reads, checks, repairs and measures triangle meshes, without Drake."""
