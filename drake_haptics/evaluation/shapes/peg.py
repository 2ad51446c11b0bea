"""A peg with chamfered ends."""

from drake_haptics.evaluation.shapes.surface import Surface, revolve


def make_peg() -> Surface:
    """Returns a peg with chamfered ends along z, its lower end at the origin.

    24 mm in diameter, 120 mm long, 24-sided.
    """
    profile = [
        (0.0, 0.0),
        (0.009, 0.0),
        (0.012, 0.004),
        (0.012, 0.117),
        (0.010, 0.120),
        (0.0, 0.120),
    ]
    return revolve(profile, 24)
