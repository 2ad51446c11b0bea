"""The systems from poses to contacts, and from contacts to forces."""
