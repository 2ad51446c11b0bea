"""Pieces are sent whole, each facet in its folder, a little at a time."""

import numpy as np

from drake_haptics.common.colors import VIRTUAL_FACET, piece_color
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.decomposition.pieces import each_facet
from drake_haptics.geometry.mesh.mesh import load_mesh
from drake_haptics.scene.library import find_scene
from drake_haptics.systems.output.meshcat_shapes import DrawnPieces

ALPHA = 0.4


class Sheets:
    """Takes the place of Meshcat and keeps what is sent."""

    def __init__(self):
        self.meshes, self.opacity = {}, {}

    def SetTriangleColorMesh(self, path, vertices, faces, colors):
        """Keeps corners of triangles, in their order, and colors."""
        self.meshes[path] = (vertices[:, faces.T.ravel()].T, colors.T)

    def SetProperty(self, path, name, value):
        """Keeps how opaque a sheet is."""
        assert name == "opacity" and path in self.meshes
        self.opacity[path] = value

    def folder(self, name):
        """Sheets below a folder, in order."""
        return [f"/a/{name}/{i}" for i in range(len(self.meshes)) if
                f"/a/{name}/{i}" in self.meshes]  # fmt: skip


def send_cup():
    """The pieces of the cup, what was sent of them, and sheets sent by each step."""
    path = find_scene("cup_spoon").parent.parent / "meshes" / "cup.obj"
    pieces = decompose(load_mesh(path)).pieces
    sheets = Sheets()
    steps = [
        len(sheets.meshes) for _ in DrawnPieces(sheets, "/a", pieces, ALPHA).send()
    ]
    return pieces, sheets, steps


def test_every_facet_is_sent_once_in_the_color_of_its_piece():
    pieces, sheets, _ = send_cup()
    for name, is_original in (("pieces", True), ("virtual", False)):
        wanted = [
            (corners, piece_color(index) if is_original else VIRTUAL_FACET)
            for index, original, corners in each_facet(pieces)
            if original == is_original
        ]
        sent = [sheets.meshes[path] for path in sheets.folder(name)]
        np.testing.assert_array_equal(
            np.concatenate([corners for corners, _ in sent]),
            np.concatenate([corners for corners, _ in wanted]),
        )
        np.testing.assert_array_equal(
            np.concatenate([colors for _, colors in sent]),
            np.concatenate([[c[:3]] * len(corners) for corners, c in wanted]),
        )


def test_what_is_seen_through_is_so_in_every_sheet():
    _, sheets, _ = send_cup()
    assert {sheets.opacity[path] for path in sheets.folder("pieces")} == {ALPHA}
    assert {sheets.opacity[path] for path in sheets.folder("virtual")} == {
        VIRTUAL_FACET[3]
    }


def test_a_step_sends_one_sheet_at_most():
    pieces, sheets, steps = send_cup()
    assert max(np.diff([0, *steps])) == 1
    assert len(steps) > sum(1 for _ in each_facet(pieces))
    assert len(sheets.folder("pieces")) > 1
