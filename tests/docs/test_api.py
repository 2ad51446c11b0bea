"""The pages of the Python API have every public name and every module."""

import json
import re
from pathlib import Path

from module_pages import LEFT_OUT, group_modules, list_modules
from system_pages import find_systems, list_system_modules

import drake_haptics

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
# The documented places to import from.
PLACES = re.compile(r"drake_haptics(\.(analysis|geometry|simulation|systems))?")


def test_every_public_name_is_on_the_page_of_names_or_has_its_own():
    page = (DOCS / "reference" / "api.md").read_text(encoding="utf-8")
    names = re.findall(r"^\.\. auto\w+:: (\w+)$", page, re.MULTILINE)
    systems = [n for m in list_system_modules(DOCS) for n in find_systems(m)]
    assert len(names) == len(set(names))
    assert set(names) == set(drake_haptics.__all__) - set(systems)


def test_users_are_shown_no_import_from_a_private_module():
    shown = [(path, path.read_text("utf-8")) for path in ROOT.glob("examples/*.py")]
    for path in [ROOT / "README.md", *DOCS.glob("*.md"), *DOCS.glob("reference/*.md")]:
        shown.append((path, path.read_text("utf-8")))
    for path in DOCS.glob("tutorials/*.ipynb"):
        cells = json.loads(path.read_text("utf-8"))["cells"]
        shown.append((path, "\n".join("".join(cell["source"]) for cell in cells)))
    imports = [
        (path.name, module)
        for path, text in shown
        for module in re.findall(
            r"^ *(?:from|import) (drake_haptics[.\w]*)", text, re.MULTILINE
        )
    ]
    assert len(imports) > 40
    assert not [each for each in imports if not PLACES.fullmatch(each[1])]


def test_every_module_is_in_a_group():
    groups = group_modules(list_modules())
    assert "scene.schema" in groups["Scenes"]
    assert "systems.arm.hand_path" in groups["Parts of the systems"]
    assert "web.mouse_device" in groups["Devices"]
    assert "simulation.run" in groups["Building and running"]
    # What programs are made of is described by what they print.
    programs = {module.partition(".")[0] for module in groups[LEFT_OUT]}
    assert programs == {"cli", "cockpit", "evaluation", "web"}
    assert all(groups.values())
