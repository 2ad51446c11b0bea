"""A slender pen."""

from drake_haptics.evaluation.shapes.surface import Surface, revolve


def make_pen() -> Surface:
    """Returns a pen along z, its tip at the origin.

    9 mm in diameter, 130 mm long, 12-sided; convex.
    """
    profile = [
        (0.0, 0.0),
        (0.0006, 0.0003),
        (0.0030, 0.012),
        (0.0045, 0.026),
        (0.0045, 0.127),
        (0.0035, 0.130),
        (0.0, 0.130),
    ]
    return revolve(profile, 12)
