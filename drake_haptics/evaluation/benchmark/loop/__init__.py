"""Times whole ticks of haptic loops in this package and other simulators."""
