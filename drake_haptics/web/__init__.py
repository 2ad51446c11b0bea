"""Serves the page of a loop to browsers."""
