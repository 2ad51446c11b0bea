"""Errors whose message is meant for the user."""


class HapticsError(ValueError):
    """Base class of all errors whose message is meant for the user.

    The command line prints the message and exits with status 1. It treats any other
    exception as a defect of the program.
    """


class MeshError(HapticsError):
    """A mesh cannot be used; the message says what is wrong and what to do."""


class SceneError(HapticsError):
    """A scene cannot be used; the message names the key."""


class DecompositionFileError(HapticsError):
    """A stored decomposition is damaged, of another kind or of another version."""
