"""Helps with writing scenes: a first one, questions about it, a faster one."""
