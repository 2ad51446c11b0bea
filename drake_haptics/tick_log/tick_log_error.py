"""What is wrong with a log, for the person who has it."""

from drake_haptics.common.errors import UserError


class TickLogError(UserError):
    """A log that cannot be written, read or replayed; says why and what to do."""
