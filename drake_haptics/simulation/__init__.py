"""Runs a loop, measures it, and changes it while it runs."""
