"""Pairs of shapes that issue trackers of other libraries report as answered wrongly.

Sizes and poses are the threads' own numbers; where a thread leaves a digit out, its
library's regression test has it. A cylinder is a prism of 48 or 64 sides, so
that its truth is that of a polytope; a rotation of few digits is made orthonormal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hard_cases.bodies import disc
from scipy.spatial.transform import Rotation

FCL = "https://github.com/flexible-collision-library/fcl/issues/"
DRAKE = "https://github.com/RobotLocomotion/drake/issues/"
COAL = "https://github.com/coal-library/coal/issues/"
MUJOCO = "https://github.com/google-deepmind/mujoco/issues/"
MUJOCO_WARP = "https://github.com/google-deepmind/mujoco_warp/issues/"


@dataclass(frozen=True, eq=False)
class ReportedPair:
    """A pair that a thread reports.

    Attributes:
        name: What it is.
        link: The thread.
        reported: What the thread says the library did.
        A: (n, 3) vertices of the one body, m.
        B: (m, 3) vertices of the other, m.
        X_WA: (4, 4) pose of A.
        X_WB: (4, 4) pose of B.
        known_m: Signed distance by the thread or by a closed form, m, if there is one.
        known_to_m: How exactly `known_m` is known, m.
    """

    name: str
    link: str
    reported: str
    A: np.ndarray
    B: np.ndarray
    X_WA: np.ndarray
    X_WB: np.ndarray
    known_m: float | None = None
    known_to_m: float = 1e-12


def box(x: float, y: float, z: float) -> np.ndarray:
    """Corners (8, 3) of a box of whole extents x, y, z, m."""
    signs = [[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    return np.array(signs, float) * [x / 2, y / 2, z / 2]


def prism(corners: np.ndarray) -> np.ndarray:
    """Corners of a prism from z = −0.5 to 0.5 m over polygon corners (n, 2), m."""
    base = np.column_stack([corners, np.full(len(corners), 0.5)])
    return np.concatenate([base, base * [1, 1, -1]])


def at(*p: float, R: str = "", wxyz: object = None) -> np.ndarray:
    """A pose (4, 4) from a position, m, and nine numbers or a quaternion, if any."""
    X = np.eye(4)
    X[:3, 3] = p
    if wxyz is not None:
        w, x, y, z = wxyz
        X[:3, :3] = Rotation.from_quat([x, y, z, w]).as_matrix()
    if R:
        given = np.array(R.split(), float).reshape(3, 3)
        u, _, v = np.linalg.svd(given)
        # Digits that are right stay as they are.
        X[:3, :3] = given if abs(given - u @ v).max() < 1e-14 else u @ v
    return X


_TILT_30 = """
0.9619397662556435 0.1540127991573736 0.2257253725032892
-0.19134171618254486 0.9693649495128391 0.1540127991573736
-0.19509032201612822 -0.19134171618254486 0.9619397662556435
"""
_TILT_60 = """
0.9409606321741776 0.292968400372895 0.16959541586174812
-0.2356983684129988 0.9266152359584843 -0.29296840037289507
-0.2429801799032639 0.23569836841299885 0.9409606321741776
"""
_QUARTER = """
6.123233995736766e-17 -1 0
1 6.123233995736766e-17 0
0 0 1
"""
_HEPTAGON = np.array(
    """1 0  0.62349 -0.781831  -0.222521 -0.974928  -0.900969 -0.433884
    -0.900969 0.433884  -0.222521 0.974928  0.62349 0.781831""".split(),
    float,
).reshape(7, 2)
_HEXAGON = np.array(
    "0.5 -0.866025  -0.5 -0.866025  1 0  -0.5 0.866025  0.5 0.866025  -1 0".split(),
    float,
).reshape(6, 2)
# Such prisms stand along x.
_Z_TO_X = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])

REPORTED_PAIRS = [
    ReportedPair(
        "tilted boxes face to face, 0.5 m",
        FCL + "493",
        "raises: origin outside of the polytope",
        box(0.5, 0.5, 0.5),
        box(0.5, 0.5, 0.5),
        at(2.077006399578687, 0.4846824747564195, 1.1543291419087276, R=_TILT_30),
        at(2, 0, 1.25, R=_TILT_30),
    ),
    ReportedPair(
        "tilted boxes an epsilon apart, 0.25 m",
        FCL + "495",
        "raises: GJK says touching, EPA apart",
        box(0.25, 0.25, 0.25),
        box(0.25, 0.25, 0.25),
        at(0.07324210009322382, 0.23165380898962123, 1.3089245921032497, R=_TILT_60),
        at(0, 0, 1.25, R=_TILT_60),
    ),
    ReportedPair(
        "small box in the middle of a tall board",
        FCL + "390",
        "raises: origin outside of the polytope",
        box(0.03, 0.12, 0.1),
        box(0.025, 0.35, 1.845),
        at(
            *(0.6349997962735081, -0.4850000221563644, 1.0778146458339641),
            R="""
-3.062793785257868e-08 -0.9999999999999989 -2.8893865161583314e-08
0.999999999999998 -3.0627939739957804e-08 6.472992691852751e-08
-6.472992772296385e-08 -2.889386302944875e-08 0.9999999999999971
""",
        ),
        at(0.8, -0.4575, 1.0225, R=_QUARTER),
    ),
    ReportedPair(
        "tilted box through a thin plate",
        FCL + "395",
        "raises: zero-area triangle",
        box(0.46, 0.48, 0.01),
        box(0.049521, 0.146, 0.0725),
        at(-0.721, -0.772, 0.81),
        at(
            *(-0.4267713300299948, -0.7659685124774679, 0.8074673140009105),
            R="""
0.10758262492983037 -0.6624881850015213 -0.7413065381787736
0.22682184885125473 -0.7096140407752535 0.6670830248314786
-0.9679761503760854 -0.23991106241273435 0.07392465377049165
""",
        ),
    ),
    ReportedPair(
        "two upright boards that nearly touch",
        FCL + "399",
        "calls the penetration search for boxes apart, and raises",
        box(0.2376803755760193, 0.15702305734157562, 0.25),
        box(0.01, 0.7816570997238159, 0.25),
        at(
            *(0.2952640652656555, -0.013230856508016586, 0),
            R="""
-0.09943238735307627 0.9950443207944397 0
-0.9950443207944397 -0.09943238735307627 0
0 0 1
""",
        ),
        at(
            *(0.22759585694545215, 0.14974093549228112, 0),
            R="""
0.9950659844209923 0.09921535490175673 0
-0.09921535490175673 0.9950659844209923 0
0 0 1
""",
        ),
    ),
    ReportedPair(
        "bar inside a block, axes parallel",
        FCL + "415",
        "raises: new vertex colinear with an edge",
        box(0.02, 0.33, 0.02),
        box(0.452, 0.27, 0.42),
        at(0.05399999999999994, -0.772, 0.405),
        at(0.121, -0.6296050575043268, 0.3),
        # Up, out of the top: 0.3 + 0.21 − 0.405 + 0.01.
        known_m=-0.115,
    ),
    ReportedPair(
        "leaf lying on a board of 3 m",
        FCL + "398",
        "calls the penetration search for boxes that touch, and raises",
        box(0.614, 3, 0.037),
        box(0.494, 0.552, 0.01),
        at(-0.675, 0, 0.9115),
        at(-0.692, 0, 0.935),
        known_m=0.0,
    ),
    ReportedPair(
        "unit boxes apart along y",
        FCL + "508",
        "3.16228 instead of 3",
        box(1, 1, 1),
        box(1, 1, 1),
        at(0, 4, 0),
        at(0, 0, 0),
        known_m=3.0,
    ),
    ReportedPair(
        "turned box under a platform",
        FCL + "293",
        "nearest points are NaN",
        box(2.75, 6, 0.05),
        box(0.424, 0.15, 0.1686),
        at(1.625, 0, 0.5),
        at(0.192074, -0.27787, 0.273546, wxyz=[0.672811, 0.340674, 0.155066, 0.638138]),
    ),
    ReportedPair(
        "cylinder upright beside a board",
        FCL + "319",
        "raises: this should not happen",
        box(0.05, 0.39, 1.47),
        disc(48, 0.18, 0.09),
        at(0.8, -0.385, 0.735, wxyz=[0.707107, 0, 0, 0.707107]),
        at(0.4, -0.4, 0.93, wxyz=[0.991445, 0, 0, -0.130526]),
    ),
    ReportedPair(
        "stacked boxes of a wall",
        DRAKE + "21673#issuecomment-2373031038",
        "raises: origin outside of the polytope",
        box(0.05, 0.55, 0.3),
        box(0.25, 0.2, 0.15),
        at(
            *(0.7500000000000006, -2.4083553715553103e-15, 0.15),
            R="""
0.0007963267107332644 -0.9999996829318354 0
0.9999996829318354 0.0007963267107332644 0
0 0 1
""",
        ),
        at(
            *(0.75, 0, 0.15),
            R="""
6.123233995736766e-17 0 1
-1 6.123233995736766e-17 6.123233995736766e-17
-6.123233995736766e-17 -1 0
""",
        ),
    ),
    ReportedPair(
        "heptagonal prism at a thin wedge",
        DRAKE + "21673#issuecomment-2689035046",
        "raises: origin outside of the polytope",
        prism(_HEPTAGON) @ _Z_TO_X.T,
        prism(
            np.array(
                [[14.835101, 13.06041], [13.785037, 12.890524], [14.767995, 13.150248]]
            )
        ),
        at(
            *(13.670417904867957, 13.169816779836705, 0),
            R="""
-2.0479437360480805e-09 -0.7692371274798412 -0.6389634118684439
-2.465484451060101e-09 0.6389634118684439 -0.7692371274798412
1 0 -3.2051032938795743e-09
""",
        ),
        at(0, 0, 0),
    ),
    ReportedPair(
        "hexagonal prism at a triangular one",
        DRAKE + "21673#issuecomment-2688753008",
        "raises: origin outside of the polytope",
        prism(_HEXAGON) @ _Z_TO_X.T,
        prism(
            np.array([[4.149402, 8.493709], [5.188451, 7.476263], [3.931647, 7.374503]])
        ),
        at(
            *(4.286483694131304, 7.386957687225368, 0),
            R="""
-3.01404872427901e-09 0.3400965845998409 -0.9403905109812217
1.0900446835381433e-09 0.9403905109812217 0.3400965845998409
1 0 -3.2051032938795743e-09
""",
        ),
        at(0, 0, 0),
    ),
    ReportedPair(
        "cubes that overlap at a corner, asked of Bullet",
        DRAKE + "1668",
        "Bullet's points are 0.33 and 0.55 beside the corners; FCL gives 20 contacts",
        box(20, 20, 20),
        box(10, 10, 10),
        at(0, 0, 0),
        at(14, 14, 14),
        known_m=-1.0,
    ),
    ReportedPair(
        "boxes of a palletizer",
        COAL + "604",
        "distance totally wrong at gjk_tolerance 1e-6",
        box(0.363, 0.277, 0.363),
        box(0.363, 0.363, 0.277),
        at(
            *(1.503354966, -0.8531707835, 0.7700092418),
            R="""
0.9999195703 0.01021849413 0.007512347878
-0.01021878248 0.9999477869 -3.329855922e-17
-0.007511955635 -7.676704888e-05 0.9999717819
""",
        ),
        at(
            *(1.48838308, -1.102020834, 0.4497073799),
            R="""
0.9998670967 -0.01297708324 0.009868343982
0.01297771517 0.9999157859 5.255670031e-17
-0.009867512928 0.0001280685574 0.9999513067
""",
        ),
    ),
    ReportedPair(
        "cubes whose faces overlap by 0.1 mm",
        COAL + "144",
        "one contact, at a corner of the common face",
        box(2, 2, 2),
        box(2, 2, 2),
        at(0, 0, 0),
        at(1.9999, 0, 0),
        known_m=-1e-4,
    ),
    ReportedPair(
        "peg across a smaller cube",
        MUJOCO + "2356",
        "MJX: the peg jitters",
        box(0.05, 0.05, 0.05),
        box(0.096, 0.02, 0.02),
        at(0, 0, 0.025),
        at(0, 0, 0.06),
        known_m=0.0,
    ),
    ReportedPair(
        "boxes a microradian from parallel",
        MUJOCO + "2471",
        "contact comes and goes",
        box(0.014, 0.014, 0.02),
        box(0.014, 0.014, 0.02),
        at(0, 0, 0, wxyz=[1, 0, 1e-6, 0]) @ at(0, 0, 0.05),
        at(0, 0.02, 0.06),
        known_m=0.006,
        known_to_m=1e-7,
    ),
    ReportedPair(
        "six-vertex hulls, one turned by half",
        MUJOCO_WARP + "1527",
        "a small positive distance for meshes that overlap",
        *2
        * [
            np.array(
                [
                    [-0.0611590669, -0.13801524, -0.158372656],
                    [0.0620514415, 0.135089189, -0.159879193],
                    [-0.105518319, -0.100999095, -0.188289702],
                    [-0.107238553, -0.102976903, 0.1569262],
                    [-0.0851279497, -0.122304708, 0.156887323],
                    [-0.0590926372, -0.104567274, -0.242715642],
                ]
            )
        ],
        *(
            at(x, 0, 0, wxyz=[0.5425650813, 0.0029009761, 0.0001424328, 0.8400087479])
            for x in (-0.141666584, 0.141666584)
        ),
    ),
    ReportedPair(
        "box resting on a plate of 200 m",
        MUJOCO_WARP + "1430",
        "sinks into large boxes, then misses them; here 1 mm deep",
        box(0.2, 0.2, 0.2),
        box(200, 200, 0.5),
        at(0, 0, 0.6 - 1e-3),
        at(0, 0, 0.25),
        known_m=-1e-3,
    ),
    ReportedPair(
        "cubes side by side that touch",
        "https://github.com/dimforge/parry/issues/315",
        "both points in the middles of the cubes, normal along y",
        box(1, 1, 1),
        box(1, 1, 1),
        at(0.5, 0.5, 0.5),
        at(1.5, 0.5, 0.5),
        known_m=0.0,
    ),
    ReportedPair(
        "cubes that overlap by 0.1 along z",
        "https://github.com/danfis/libccd/issues/25",
        "GJK: no overlap, direction NaN",
        box(2, 2, 2),
        box(2, 2, 2),
        at(0, 0, 0),
        at(0, 0, 1.9),
        known_m=-0.1,
    ),
    ReportedPair(
        "cylinder across a triangle of 320 m",
        "https://github.com/newton-physics/newton/issues/3773",
        "58.8 m deep instead of 6.17 cm",
        disc(64, 0.02, 0.07),
        np.array([[0, 0, 0], [100.0, 320, 0], [0, 320, 0]]),
        at(
            *(28.87991333, 260.53430176, 0.00036136055),
            wxyz=[0.77515626, -0.16498479, 0.36682746, -0.48718625],
        ),
        at(0, 0, 0),
        known_m=-0.0617,
        known_to_m=1e-4,
    ),
    ReportedPair(
        "plank of 1 m across a small bar, turned by 60°",
        "https://github.com/BerkeleyAutomation/python-fcl/issues/28",
        "nearest points farther apart than the distance",
        box(20, 5, 1000),
        box(5, 5, 1000),
        at(-2, 0, 0, wxyz=[np.cos(np.pi / 6), 0, 0, np.sin(np.pi / 6)]),
        at(-5, 10, 0),
    ),
]
