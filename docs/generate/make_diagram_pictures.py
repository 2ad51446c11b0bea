"""Draws the loop of two scenes: `python docs/generate/make_diagram_pictures.py`.

Drake tells Graphviz what to draw. Only the looks are changed here, so that a whole loop
can be read on a page. tests/docs/test_diagrams.py holds the pictures to the code.
"""

import re
from pathlib import Path

import pygraphviz

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

_DOCS = Path(__file__).parents[1]
# File by scene: one without effects, one with all.
PICTURES = {"cup_spoon": "loop_cup_spoon.svg", "rubbed_sphere": "loop_all_effects.svg"}

_MOTION, _CONTACT, _WRENCH = "#2b6cb0", "#2f855a", "#c05621"
_LOOKS = (
    "rankdir=LR nodesep=0.45 ranksep=0.5"
    ' node [fontname="Helvetica" fontsize=13] edge [arrowsize=0.7]'
)
_NODE = re.compile(r"^(s\d+) \[shape=none.*?<BR/>\nname=(\w+)(.*?)^>\];", re.M | re.S)
_PORT = re.compile(r'PORT="([uy]\d+)"[^>]*>([^<]+)</TD>')
_OUTPUTS = re.compile(r"^subgraph cluster\w+out \{.*?^\}\n", re.M | re.S)
_TO_OUTPUTS = re.compile(r"^s\d+:\w+:e -> \w+out:.*\n", re.M)
_EDGE = re.compile(r"^(s\d+):(y\d+):e -> (s\d+):(u\d+):w$", re.M)


def make_graph(scene: str) -> str:
    """Returns Drake's picture of the loop of a scene, in Graphviz's language.

    The diagram's own outputs, one for all that there is to see, are left out.
    """
    diagram = BuildHapticDiagram(load_scene(find_scene(scene))).diagram
    graph: str = diagram.GetGraphvizString(max_depth=1)
    return _TO_OUTPUTS.sub("", _OUTPUTS.sub("", graph))


def set_looks(graph: str) -> str:
    """Returns a graph of Drake's with short names, colors, and in two rows.

    Edges are blue for motions, green for contacts and orange for wrenches. Those of
    the tool do not count for the order from left to right: its motion goes to all
    others, and the forces come back.
    """
    systems = {node[1]: node[2] for node in _NODE.finditer(graph)}
    ports = {node[1]: dict(_PORT.findall(node[3])) for node in _NODE.finditer(graph)}

    def color(edge: re.Match[str]) -> str:
        source, sink = systems[edge[1]], systems[edge[3]]
        output, input_ = ports[edge[1]][edge[2]], ports[edge[3]][edge[4]]
        color = _WRENCH
        if output.startswith(("X_", "V_")):
            color = _MOTION
        elif output in ("contacts", "clusters"):
            color = _CONTACT
        is_back = "haptic_tool" in (source, sink) and source != "virtual_coupling"
        order = " constraint=false" if is_back else ""
        name = f"{source}.{output}-{sink}.{input_}"
        return f'{edge[0]} [id="{name}" color="{color}"{order}]'

    graph = _EDGE.sub(color, graph)
    graph = re.sub(r"<B>[\w.]+\.(\w+)</B>", r"<B>\1</B>", graph)
    # The frame around all.
    graph = re.sub(r"subgraph cluster\d+diagram \{\ncolor=black", "{", graph)
    graph = re.sub(r"label=<<TABLE.*?<B>Diagram</B>.*?>>;", "", graph, flags=re.S)
    return graph.replace("rankdir=LR", _LOOKS, 1)


def main() -> None:
    """Draws both."""
    for scene, file in PICTURES.items():
        graph = pygraphviz.AGraph(string=set_looks(make_graph(scene)))
        graph.draw(_DOCS / file, format="svg", prog="dot")
        print(_DOCS / file)


if __name__ == "__main__":
    main()
