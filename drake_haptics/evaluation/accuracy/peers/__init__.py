"""Other libraries' ways to a contact wrench, on the motion that settings are held to.

`run_peers` (in `run.py`) returns a row for each.
"""
