"""Limits of stiffness and damping in closed form."""
