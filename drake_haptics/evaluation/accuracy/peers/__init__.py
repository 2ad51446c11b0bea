"""Calculates contact wrenches by other libraries on a study's motion.

`run_peers` (in `run.py`) returns a row for each.
"""
