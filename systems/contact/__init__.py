"""Systems that find contacts and calculate their forces."""
