"""Meshcat's page and camera, and recordings of it."""
