"""The pictures of loops show what Drake says of loops that are built now."""

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from make_diagram_pictures import PICTURES, make_graph

DOCS = Path(__file__).parents[2] / "docs"
SVG = "{http://www.w3.org/2000/svg}"


def read_graph(graph: str) -> tuple[dict[str, set[str]], set[str]]:
    """Reads Drake's text: the words in each system's box, and who is connected."""
    names, words, ports = {}, {}, {}
    for number, box in re.findall(r"^(s\d+) \[(.*?)^>\];", graph, re.M | re.S):
        texts = {text for text in re.split(r"<[^>]*>|\n", box)[1:] if text}
        (name,) = (text for text in texts if text.startswith("name="))
        names[number] = name.removeprefix("name=")
        words[name] = {text.rpartition(".")[2] for text in texts}
        for port, text in re.findall(r'PORT="(\w+)"[^>]*>([^<]*)<', box):
            ports[number, port] = text
    edges = re.findall(r"^(s\d+):(y\d+):e -> (s\d+):(u\d+):w$", graph, re.M)
    return words, {
        f"{names[a]}.{ports[a, p]}-{names[b]}.{ports[b, q]}" for a, p, b, q in edges
    }


def read_picture(file: Path) -> tuple[dict[str, set[str]], set[str]]:
    """Reads the same from a picture."""
    words, edges = {}, set()
    for group in ElementTree.parse(file).iter(f"{SVG}g"):
        if group.get("class") == "node":
            texts = {element.text or "" for element in group.iter(f"{SVG}text")}
            (name,) = (text for text in texts if text.startswith("name="))
            words[name] = texts
        elif group.get("class") == "edge":
            edges.add(group.get("id", ""))
    return words, edges


@pytest.mark.parametrize("scene", PICTURES)
def test_a_picture_shows_the_diagram_that_is_built(scene: str) -> None:
    words, connections = read_graph(make_graph(scene))
    assert len(words) >= 6
    assert len(connections) >= 12
    assert read_picture(DOCS / PICTURES[scene]) == (words, connections)
