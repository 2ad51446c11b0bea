"""Devices behind one interface: network, Meshcat, Haply, LCM."""
