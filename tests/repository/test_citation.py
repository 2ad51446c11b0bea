"""CITATION.cff, the README's citation and the package's metadata agree."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
README = (ROOT / "README.md").read_text(encoding="utf-8")
SECTION = " ".join(README.split("## Citation\n")[1].split("\n## ")[0].split())


def test_the_software_is_that_of_the_metadata():
    metadata = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    for key in ("version", "license"):
        [value] = re.findall(rf'(?m)^{key} = "(.+)"$', metadata)
        assert CITATION[key] == value
    assert f"{CITATION['license']}." in README.split("## License\n")[1]


def test_the_readme_cites_the_same_paper_and_names_the_file():
    [paper] = CITATION["references"]
    *names, last = [author["family-names"] for author in paper["authors"]]
    journal = paper["journal"].partition(":")[0]
    where = f"{journal} {paper['volume']}({paper['issue']}), {paper['year']}"
    assert f"{', '.join(names)}, and {last}, *{paper['title']}* ({where})" in SECTION
    assert "(CITATION.cff)" in SECTION
