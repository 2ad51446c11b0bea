"""Errors whose message is meant for the user, as opposed to defects of the program."""


class HapticsError(ValueError):
    """Base of all errors whose message is meant for the person at the keyboard.

    The command line prints the message alone and exits with status 1; every
    other exception keeps its traceback, because it is a defect of the program.
    """


class MeshError(HapticsError):
    """A mesh that cannot be used; says what is wrong and what to do."""


class SceneError(HapticsError):
    """A scene that cannot be used. The message names the key."""


class DecompositionFileError(HapticsError):
    """A stored decomposition that is damaged, foreign or of another version."""
