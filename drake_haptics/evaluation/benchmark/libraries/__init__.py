"""Convex pairs in each library that is measured, one module per library."""
