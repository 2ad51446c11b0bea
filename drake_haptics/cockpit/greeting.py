"""What a page is told first: what there is to see and to change."""

from __future__ import annotations

import inspect
import textwrap
from typing import Any

from drake_haptics.cockpit.scene_changes import (
    CLUSTERING,
    CLUSTERINGS,
    EFFECTS,
    SceneChanges,
)
from drake_haptics.common.colors import make_legend
from drake_haptics.loop.device_placement import DeviceSite
from drake_haptics.systems.contact.load_shedding import SHED_STAGES
from drake_haptics.systems.output.haptic_picture import PICTURE_VIEWS
from drake_haptics.visualization.meshcat import CAMERAS

_LONGEST_DESCRIPTION = 2000
_CLUSTERING_HELP = (
    "How few contacts are made of many: shared, which is continuous, or octree, the"
    " paper's."
)


def make_greeting(
    changes: SceneChanges,
    *,
    name: str,
    meshcat_url: str,
    handles: dict[str, str],
    site: DeviceSite,
    locked: str,
) -> dict[str, Any]:
    """Returns the message `hello`, ready for JSON.

    Args:
        changes: The scene, as it is and as its file has it.
        name: Of the scene.
        meshcat_url: Address of what the page shows.
        handles: Who can hold the handle, and what people read of them.
        site: Of the scene's device, with its limits.
        locked: Why nothing may be changed; empty if it may.
    """
    scene, file = changes.scene, changes.file
    return {
        "meshcat": meshcat_url,
        "scene": name,
        # What is longer than a datagram would never reach the page.
        "description": textwrap.shorten(
            scene.description, _LONGEST_DESCRIPTION, placeholder=" …"
        ),
        "period_s": 1.0 / scene.device.rate_hz,
        "limits": {"force_N": site.max_force_N, "torque_Nm": site.max_torque_Nm},
        "keys": [
            {
                "key": item.key,
                "label": item.label,
                "unit": item.unit,
                "low": item.low,
                "high": item.high,
                "log": item.is_logarithmic,
                "group": item.group,
                "help": item.help,
                "file": changes.read_file(item),
            }
            for item in changes.list_keys()
        ],
        "choices": [
            {
                "key": CLUSTERING,
                "label": "Clustering",
                "options": list(CLUSTERINGS),
                "help": _CLUSTERING_HELP,
                "file": file.contact.clustering,
            }
        ],
        "effects": [
            {
                "name": effect,
                "label": effect.capitalize(),
                "help": (inspect.getdoc(schema) or "").partition("\n")[0],
                "file": getattr(file.effects, effect) is not None,
            }
            for effect, schema in EFFECTS.items()
        ],
        "handles": [{"name": key, "label": label} for key, label in handles.items()],
        "views": [
            {"name": key, "label": label} for key, label in PICTURE_VIEWS.items()
        ],
        "cameras": list(CAMERAS),
        "legend": make_legend(scene.effects.friction is not None),
        "locked": locked,
        "shed_stages": list(SHED_STAGES),
    }
