"""Measures accuracy and speed of this package, and repeats the paper's evaluation."""
