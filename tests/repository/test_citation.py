"""CITATION.cff, the page on citing and the package's metadata agree."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
PAGE = (ROOT / "docs" / "citing.md").read_text(encoding="utf-8")


def read_bibtex(kind: str) -> dict[str, str]:
    """The fields of the page's one entry of a kind, each in one line."""
    [entry] = re.findall(rf"(?ms)^@{kind}\{{\w+,\n(.*?)^\}}", PAGE)
    fields = re.findall(r"(?s)(\w+)\s*=\s*\{(.*?)\},\n", entry)
    return {name: " ".join(text.replace("\\", "").split()) for name, text in fields}


def test_the_software_is_that_of_the_metadata():
    metadata = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    for key in ("version", "license"):
        [value] = re.findall(rf'(?m)^{key} = "(.+)"$', metadata)
        assert CITATION[key] == value
        assert read_bibtex("software")[key] == value
    assert read_bibtex("software")["title"] == CITATION["title"]


def test_the_paper_is_that_of_the_page():
    [paper] = CITATION["references"]
    page = read_bibtex("article")
    names = [f"{x['family-names']}, {x['given-names']}" for x in paper["authors"]]
    assert page["author"] == " and ".join(names)
    assert (page["title"], page["journal"]) == (paper["title"], paper["journal"])
    for page_key, key in (("volume", "volume"), ("number", "issue"), ("year", "year")):
        assert page[page_key] == str(paper[key])
