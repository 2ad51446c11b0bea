"""Systems that draw a loop and record it."""
