"""Systems that turn LCM messages into vectors, and back."""
