"""The systems of the device port, whatever is behind it."""
