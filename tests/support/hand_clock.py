"""A clock that stands until a test moves it."""


class HandClock:
    """Time as the test wants it."""

    def __init__(self):
        self.now_s = 100.0

    def __call__(self):
        """Returns it, s."""
        return self.now_s
