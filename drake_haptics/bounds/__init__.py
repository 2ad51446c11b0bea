"""Calculates limits of stiffness and damping in closed form."""
