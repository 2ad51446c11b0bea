"""Devices behind one interface: network, replay, page, mouse, adapters."""
