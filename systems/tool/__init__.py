"""The systems of the tool, and of the coupling that ties it to the handle."""
