"""Six-degree-of-freedom haptic rendering of arbitrary meshes, as Drake systems."""
