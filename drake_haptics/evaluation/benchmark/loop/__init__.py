"""Whole ticks of a haptic loop, this package's and those of other simulators."""
