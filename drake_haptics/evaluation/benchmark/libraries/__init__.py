"""Queries convex pairs in other libraries, with one module for each."""
