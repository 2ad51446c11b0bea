"""Convex pieces of a mesh: cut, merged, stored, shown. No module here needs Drake."""
