"""Which settings are another model of contact, and so no error of one model."""

from __future__ import annotations

from drake_haptics.evaluation.accuracy.setting import Setting

# Beginning of a key: what differs.
_MODELS = {
    "effects.": "what is felt besides contact",
    "contact.clustering": "how contacts that are near count together",
    "contact.cluster_size_m": "how far contacts count as one",
    "contact.depth": "whether depth is the way back or the shortest way out",
    "contact.tolerance_m": "how far from a surface it begins to push",
    "device.rate_hz": "how often the loop ticks, and so what a second of it costs",
}
_EFFECTS = "effects."
# What a device does and how long a tick may take: the loop, and not its contacts.
_LOOP = "device."


def find_model_change(setting: Setting) -> str:
    """Returns what a setting changes of the model, empty if nothing.

    What differs then is what is felt, not how exactly it is computed: the "error" is
    the difference between two models.
    """
    return next(
        (
            words
            for beginning, words in _MODELS.items()
            if any(key.startswith(beginning) for key in setting.changes)
        ),
        "",
    )


def is_comparable(setting: Setting) -> bool:
    """Whether a setting's figure is an error, which another one may beat.

    One of another model is exact in what it does, see `find_model_change`; in another
    loop a tick is another share of a second, or leaves out what it has no time for.
    """
    of_loop = any(key.startswith(_LOOP) for key in setting.changes)
    return not of_loop and not find_model_change(setting)


def is_effect(setting: Setting) -> bool:
    """Whether a setting takes away or changes an effect that a scene names."""
    return any(key.startswith(_EFFECTS) for key in setting.changes)
