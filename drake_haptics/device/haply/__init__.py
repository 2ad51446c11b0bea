"""Haply's Inverse3 behind the interface of a device."""
