"""An evaluation made by hand, of known figures."""

from functools import cache

import numpy as np

from drake_haptics.evaluation.paper.depth_cost import DepthCost, DepthCosts
from drake_haptics.evaluation.paper.evaluation import Analysis, PaperEvaluation
from drake_haptics.evaluation.paper.fits import fit_line, fit_power
from drake_haptics.evaluation.paper.pen_pass import measure_pen_pass
from drake_haptics.evaluation.paper.profile import Profile
from drake_haptics.evaluation.paper.scaling import ForceScaling, PairScaling
from drake_haptics.evaluation.paper.table1 import ModelFigures


def make_profile(name="spoon in cup", figure="11-(a)", tick_us=100.0, touched=1):
    """A second: disjoint for 600 ticks, then penetrating and twice as slow to query."""
    n = 1000
    inside = np.arange(n) >= 600
    return Profile(
        name=name,
        figure=figure,
        pieces=(55, 75),
        triangles=(336, 195_568),
        objects=897,
        time_s=1e-3 * np.arange(n),
        query_s=np.where(inside, 2e-5, 1e-5),
        force_s=np.full(n, 5e-6),
        tick_s=np.full(n, 1e-6 * tick_us),
        disturbed_s=np.tile([1e-6 * tick_us] * 3 + [5e-3], n),
        contacts=np.full(n, 20),
        clusters=np.full(n, 3),
        touched=np.full(n, touched),
        touched_triangles=3_960,
        distance_m=np.where(inside, -1e-3, 1e-3),
    )


def make_forces(method, exponent):
    """Times that grow with a power of the contacts."""
    n = np.array([1, 4, 16, 64, 256])
    us = 2.0 * n**exponent
    forces = n if method == "shared" else np.ones_like(n)
    return ForceScaling(
        method=method,
        contacts=tuple(n.tolist()),
        forces=tuple(forces.tolist()),
        median_us=tuple(us.tolist()),
        force_growth=fit_power(n, forces),
        time_growth=fit_power(n, us),
    )


def make_analysis(depth_exponent=0.02, depth_us=0.5):
    """Depths that grow with a power, and pairs that cost 0.4 µs each."""
    sizes = np.array([42, 1_000, 10_000])
    us = depth_us * (sizes / 1_000) ** depth_exponent
    rows = [
        DepthCost(int(n), 100, float(t), float(2 * t))
        for n, t in zip(sizes, us, strict=True)
    ]
    pairs = np.array([1, 8, 64])
    return Analysis(
        depths=DepthCosts(tuple(rows), fit_power(sizes, us), None),
        pairs=PairScaling(
            (1, 8, 64), tuple((0.4 * pairs).tolist()), fit_line(pairs, 0.4 * pairs)
        ),
        forces=(make_forces("octree", 0.5), make_forces("shared", 1.5)),
    )


def make_table1():
    """Returns a row that is better, one that is not, and one without figures."""
    return (
        ModelFigures("Torus", 2000, 67, "own shape", 2000, 54, 4, 1981, 913, 0.034),
        ModelFigures("Cup", 500, 190, "cup_500.obj", 500, 197, 104, 854, 354, 0.005),
        ModelFigures("Armadillo", 31240, 9098),
    )


@cache
def make_evaluation():
    """Returns all parts; those that are frozen are made once."""
    return PaperEvaluation(
        machine={
            "processor": "<a processor>",
            "cores": 4,
            "system": "Linux",
            "python": "3.12",
            "drake_haptics": "0",
        },
        table1=make_table1(),
        figure11=(make_profile(), make_profile("wrench in machine room", "11-(c)")),
        figure12=(measure_pen_pass(seconds=0.5),),
        analysis=make_analysis(),
    )
