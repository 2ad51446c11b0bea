"""Devices over LCM: messages to vectors and back."""
