"""Opens Meshcat, aims its camera, and writes recordings."""
