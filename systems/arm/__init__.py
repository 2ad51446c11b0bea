"""A simulated arm with its faults, and the simulated hand that holds it."""
