"""A log of every tick: recorded while a loop runs, read, replayed, compared."""
