"""Base class of systems with derivatives, and ports for parts of vectors."""
