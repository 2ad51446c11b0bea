"""Systems that convert LCM messages to vectors and back."""
