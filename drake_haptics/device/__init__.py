"""Devices behind one interface: over UDP or LCM, Haply's, and Meshcat's controls."""
