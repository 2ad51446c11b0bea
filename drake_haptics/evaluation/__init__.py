"""Measures this package: accuracy, speed, and the paper's figures."""
