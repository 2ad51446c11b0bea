"""Measures times and instructions, and builds adapters of other libraries."""
