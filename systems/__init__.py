"""The LeafSystems of the haptic loop, one per file."""
