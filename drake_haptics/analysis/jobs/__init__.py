"""Computes a function for many tasks, on one machine or on many."""
