"""LCM messages of a haptic device, and a device that uses them."""
