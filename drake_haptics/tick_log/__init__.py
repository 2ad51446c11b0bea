"""Records, reads, replays and compares logs of every tick."""
