"""A clock that the test moves itself, so that no busy computer moves it."""


class FakeClock:
    """A clock that only reading it, sleeping and `now_s` move.

    Args:
        reading_s: What each reading takes, s.
        oversleep_s: How much longer each sleep is than what was asked for, s.
    """

    def __init__(self, *, reading_s=0.0, oversleep_s=0.0):
        self.now_s = 5.0
        self.reading_s = reading_s
        self.oversleep_s = oversleep_s

    def __call__(self):
        """Returns the time, s, in place of `time.perf_counter`."""
        self.now_s += self.reading_s
        return self.now_s

    def sleep(self, seconds):
        """Moves the clock, a little too far."""
        assert seconds > 0.0
        self.now_s += seconds + self.oversleep_s
