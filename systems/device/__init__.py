"""Systems between the loop and a haptic device, real or simulated."""
