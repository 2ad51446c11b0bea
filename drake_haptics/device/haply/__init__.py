"""Haply's Inverse3 as a device."""
