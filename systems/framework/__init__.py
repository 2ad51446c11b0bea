"""Building blocks of systems: derivatives, and ports for parts of vectors."""
