"""Systems between haptic rendering and the bodies of a plant."""
