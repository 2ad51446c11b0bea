"""Defines, finds, reads and checks scenes."""
