"""
The compiled core of drake_haptics: geometry, contact query, clustering and wrenches. The parts for your own programs have names in drake_haptics; the rest is the engine behind them.
"""

from collections.abc import Callable, Iterator, Sequence
import enum
from typing import Annotated, Literal, overload

import numpy
import numpy.typing
from numpy.typing import NDArray

import drake_haptics.common.pose_like
import drake_haptics.geometry.decomposition.decompose


class AutoDiffVector:
    """
    Numbers with their derivatives by D variables that all arguments of a call have in common. Immutable.
    """

    def __init__(self, value: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], gradient: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='F')]) -> None:
        """
        Args:
            value: (n,) values.
            gradient: (n, D) derivatives.

        Raises:
            ValueError: the sizes do not match.
        """

    def __len__(self) -> int: ...

    @property
    def value(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
        """(n,)."""

    @property
    def gradient(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='F')]:
        """(n, D)."""

class ConvexPolytope:
    """
    Convex hull of points, with the adjacency that the contact query walks on, in the frame of its body. A flat one (dimension 2) has two facets: 0 is its front, 1 its back with the opposite normal. Immutable.
    """

    def __init__(self, vertices: numpy.typing.ArrayLike) -> None:
        """
        Builds the hull of (n, 3) points, m. Coplanar triangles become one facet; points that are not extreme are dropped; sets that are flat, straight or a single point are valid.

        Raises:
            ValueError: there are no points, or one is not finite, or 1e50 m and beyond.
        """

    @property
    def dimension(self) -> int:
        """0 point, 1 segment, 2 flat polygon, 3 solid."""

    @property
    def vertices(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """(n, 3) extreme points, m, in the order of the input."""

    @property
    def facets(self) -> list[list[int]]:
        """Vertex loops, counter-clockwise seen from outside."""

    @property
    def facet_normals(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """(m, 3) unit outward normals."""

    @property
    def facet_offsets(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
        """(m,) plane offsets, m: normal · x = offset."""

    @property
    def facet_original(self) -> Annotated[NDArray[numpy.bool_], dict(shape=(None,), order='C')]:
        """
        (m,) whether a facet lies on the surface that the polytope is a piece of.
        """

    @property
    def edges(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C')]:
        """(k, 2) end vertices."""

    @property
    def edge_facets(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C')]:
        """(k, 2) facets left and right of each edge; -1 on a segment."""

    @property
    def edge_original(self) -> Annotated[NDArray[numpy.bool_], dict(shape=(None,), order='C')]:
        """(k,) whether an edge lies on an edge of the surface."""

    @property
    def edge_wings(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C')]:
        """
        (k, 6) two unit directions in the surface beside each edge, away from it; zero where the surface ends.
        """

    def ring(self, vertex: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """(r, 3) unit directions of the surface's edges at a vertex."""

    @property
    def centroid(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """(3,) mean of the vertices, m."""

    @property
    def radius(self) -> float:
        """Radius of the ball about the centroid, m."""

    def __reduce__(self) -> tuple: ...

    def __repr__(self) -> str: ...

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class ConvexPieces:
    """A mesh and the convex pieces that stand for its surface. Immutable."""

    @property
    def vertices(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """(n, 3) vertices of the mesh, m, in the object's frame."""

    @property
    def triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C')]:
        """(m, 3) vertex indices, counter-clockwise seen from outside."""

    @property
    def pieces(self) -> list[ConvexPolytope]:
        """The polytopes that queries run on."""

    @property
    def piece_of_triangle(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C')]:
        """
        (m,) piece of each triangle; -1 where pieces were not made from triangles.
        """

    def __repr__(self) -> str: ...

def decompose_surface(vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], solid: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], progress: Callable[[float], bool] | None = None) -> ConvexPieces:
    """
    Convex surface decomposition (paper, section 5.3.1). A solid that differs from its hull by noise alone is one piece; pieces extend beyond the solid by no more than 1e-6 of the mesh's size.

    Args:
        vertices: (n, 3) positions, m.
        triangles: (m, 3) vertex indices, int32, counter-clockwise seen from outside.
        solid: (m,) uint8, whether a triangle bounds a solid; pieces of other triangles are flat.
        progress: function of the share done, in [0, 1], that returns whether to go on.

    Raises:
        ValueError: bad indices or values.
        RuntimeError: `progress` returned False.
    """

def assemble_surface_pieces(vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], piece_of_triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> ConvexPieces:
    """
    The result of decompose_surface from its labels, without the search.

    Args:
        vertices: (n, 3) positions, m.
        triangles: (m, 3) vertex indices, int32.
        piece_of_triangle: (m,) int32, piece of each triangle, from 0 without gaps.

    Raises:
        ValueError: bad indices, values or labels.
    """

def adopt_convex_pieces(vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], pieces: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]], tolerance: float) -> ConvexPieces:
    """
    Decomposition into pieces that were made elsewhere. Facets on the mesh are original, all others virtual.

    Args:
        vertices: (n, 3) positions, m.
        triangles: (m, 3) vertex indices, int32.
        pieces: list of (k, 3) points, m, whose hulls are the pieces.
        tolerance: distance from the mesh, m, up to which a facet lies on it; infinite if the pieces take its place, so that all facets are original.

    Raises:
        ValueError: bad indices or values.
    """

class MergedPieces:
    """Groups of a decomposition's pieces, each of which becomes one piece."""

    @property
    def group_of_piece(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C')]:
        """(k,) group of each piece, from 0 without gaps."""

    @property
    def departure(self) -> float:
        """Bound on how far any group's hull departs from the mesh, m."""

def merge_pieces(vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], solid: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], piece_of_triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], error: float, progress: Callable[[float], bool] | None = None) -> MergedPieces:
    """
    Joins neighboring pieces of an exact decomposition, the cheapest first, while hulls depart from the mesh by no more than an error.

    Args:
        vertices: (n, 3) positions, m.
        triangles: (m, 3) vertex indices, int32.
        solid: (m,) uint8, whether a triangle bounds a solid.
        piece_of_triangle: (m,) int32, pieces of the exact decomposition.
        error: largest departure, m, zero or more.
        progress: function of the share done, in [0, 1], that returns whether to go on.

    Raises:
        ValueError: bad indices or values.
        RuntimeError: `progress` returned False.
    """

def assemble_merged_pieces(vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], solid: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], piece_of_triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], group_of_piece: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], error: float) -> ConvexPieces:
    """
    Decomposition with the groups that merge_pieces found.

    Args:
        vertices, triangles, solid, piece_of_triangle, error: arguments of merge_pieces.
        group_of_piece: (k,) int32, groups that merge_pieces returned.

    Raises:
        ValueError: bad indices, values or labels.
    """

def surface_distance(vertices_A: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles_A: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], vertices_B: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles_B: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> float:
    """
    Upper bound on the distance, m, of any point of either surface from the other. It exceeds the largest distance by no more than 5%, or 1e-4 of the size.

    Args:
        vertices_A, vertices_B: (n, 3) positions, m.
        triangles_A, triangles_B: (m, 3) vertex indices, int32.

    Raises:
        ValueError: bad indices or values.
    """

class FeatureKind(enum.IntEnum):
    """
    Kind of a feature of a `ConvexPolytope`: the list that its index counts in.
    """

    VERTEX = 0
    """a row of `vertices`"""

    EDGE = 1
    """a row of `edges`"""

    FACET = 2
    """an item of `facets`"""

class Feature:
    """
    A vertex, edge or facet of a `ConvexPolytope`. Equal if kind and index are. Immutable.
    """

    def __init__(self, kind: FeatureKind, index: int) -> None:
        """
        Raises:
            ValueError: the index is negative or too large.
        """

    @property
    def kind(self) -> FeatureKind:
        """List that the index counts in."""

    @property
    def index(self) -> int:
        """Place in `vertices`, `edges` or `facets`, from 0."""

    def __eq__(self, other: object) -> bool: ...

    def __hash__(self) -> int: ...

    def __repr__(self) -> str: ...

class ContactStatus(enum.IntEnum):
    """How the contact of a pair of polytopes was found."""

    NEAR = 0
    """apart; closest features"""

    PENETRATING = 1
    """overlapping; penetration depth"""

    HELD = 2
    """passed behind the surface that it had pressed on; trackers only"""

    BOUNDED = 3
    """a search reached its bound; best answer found"""

class Contact:
    """
    One contact of two convex polytopes A and B, in the world frame W, in the words and signs of Drake's `SignedDistancePair`. Immutable, and made by queries only: tolerance and gains are those of a `drake_haptics.ContactParameters`.
    """

    @property
    def distance(self) -> float:
        """
        Signed distance, m; > 0 apart, < 0 penetrating (then −distance is the depth).
        """

    @property
    def nhat_BA_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), writable=False)]:
        """(3,) unit normal out of B into A."""

    @property
    def p_WCa(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), writable=False)]:
        """(3,) witness point on A, m: p_WCa − p_WCb = distance · nhat_BA_W."""

    @property
    def p_WCb(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), writable=False)]:
        """(3,) witness point on B, m."""

    @property
    def p_WC(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), writable=False)]:
        """(3,) mean of both (paper, Eq. 1), m."""

    @property
    def extent(self) -> float:
        """Measure of the overlap, m²; see `ContactSet.extent`."""

    @property
    def flushness(self) -> float:
        """Share of the contact, 0 to 1, in flush faces or edges."""

    @property
    def feature_A(self) -> Feature | None:
        """`Feature` of A in contact; None where another library found it."""

    @property
    def feature_B(self) -> Feature | None:
        """`Feature` of B in contact; None where another library found it."""

    @property
    def status(self) -> ContactStatus:
        """`ContactStatus`."""

    @property
    def object_index(self) -> int:
        """Index of the object B; 0 from a pair."""

    @property
    def piece_A(self) -> int:
        """Index of the tool's piece A; 0 from a pair."""

    @property
    def piece_B(self) -> int:
        """Index of the object's piece B; 0 from a pair."""

    def __repr__(self) -> str: ...

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class ContactSet:
    """
    The contacts of one query, one for each pair of pieces within the tolerance, ordered by object, piece of A, piece of B: read-only columns over n contacts, and a sequence of `Contact`. Immutable; copies are the object itself, so that it crosses Drake's abstract ports.
    """

    def __len__(self) -> int: ...

    def __getitem__(self, i: int) -> Contact: ...

    def __iter__(self) -> Iterator[Contact]: ...

    @property
    def least_distance(self) -> float:
        """Smallest distance of the contacts, m; infinite without any."""

    def __repr__(self) -> str: ...

    @property
    def query_seconds(self) -> float:
        """Time that the query took inside the core, s."""

    @property
    def distance(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) signed distance, m; > 0 apart, < 0 penetrating (then −distance is the depth).
        """

    @property
    def nhat_BA_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) unit normal out of B into A, in the world."""

    @property
    def p_WCa(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) witness point on A, in the world, m."""

    @property
    def p_WCb(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) witness point on B, in the world, m."""

    @property
    def p_WC(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) mean of both (paper, Eq. 1), in the world, m."""

    @property
    def extent(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) measure of the overlap, m²: for flush faces their area under the pressure of a thin layer, for a flush edge its length times the layer, at a point the layer squared. Parts of a divided face add up.
        """

    @property
    def flushness(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) share of the contact, 0 to 1, that lies in flush faces or edges."""

    @property
    def feature_A(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """
        (n, 2) int32, feature of A in contact: [FeatureKind, index], -1 where another library found the contact.
        """

    @property
    def feature_B(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """
        (n, 2) int32, feature of B in contact: [FeatureKind, index], -1 where another library found the contact.
        """

    @property
    def status(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, ContactStatus."""

    @property
    def object_index(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, index of the object B."""

    @property
    def piece_A(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, piece of A (the tool) that `feature_A` belongs to."""

    @property
    def piece_B(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, piece of B (the object)."""

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class PairTrajectory:
    """
    The contact of a `ConvexPair` at each of n poses: read-only columns, and a sequence of `Contact`. Immutable.
    """

    def __len__(self) -> int: ...

    def __getitem__(self, k: int) -> Contact: ...

    def __iter__(self) -> Iterator[Contact]: ...

    def __repr__(self) -> str: ...

    @property
    def distance(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) signed distance, m; > 0 apart, < 0 penetrating (then −distance is the depth).
        """

    @property
    def nhat_BA_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) unit normal out of B into A, in the world."""

    @property
    def p_WCa(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) witness point on A, in the world, m."""

    @property
    def p_WCb(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) witness point on B, in the world, m."""

    @property
    def p_WC(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) mean of both (paper, Eq. 1), in the world, m."""

    @property
    def extent(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) measure of the overlap, m²: for flush faces their area under the pressure of a thin layer, for a flush edge its length times the layer, at a point the layer squared. Parts of a divided face add up.
        """

    @property
    def flushness(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) share of the contact, 0 to 1, that lies in flush faces or edges."""

    @property
    def feature_A(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """
        (n, 2) int32, feature of A in contact: [FeatureKind, index], -1 where another library found the contact.
        """

    @property
    def feature_B(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """
        (n, 2) int32, feature of B in contact: [FeatureKind, index], -1 where another library found the contact.
        """

    @property
    def status(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, ContactStatus."""

    @property
    def seconds(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) time that each query took inside the core, s, including the reading of the clock (some 0.03 µs).
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class ConvexPair:
    """
    Signed distance of two convex polytopes A and B, each query starting from the last one's answer. Apart it is the distance of the closest features. In overlap it is minus the penetration depth: `tracked` walks from the last answer to a local minimum of the depth (paper, 5.2), and so does not pop through a thin plate; `global` is the global minimum, exact and proven.

    A pose is a (4, 4) rigid matrix, a `RigidTransform`, or a (7,) vector [qw qx qy qz x y z]; lengths in m. A ValueError leaves the pair as it was. Threads that share a pair take turns.
    """

    def __init__(self, A: ConvexPolytope, B: ConvexPolytope, depth: Literal['tracked', 'global'] = 'tracked') -> None:
        """
        Pairs two `ConvexPolytope`.

        Raises:
            ValueError: not polytopes, or no such depth.
        """

    @property
    def A(self) -> ConvexPolytope: ...

    @property
    def B(self) -> ConvexPolytope: ...

    @property
    def depth(self) -> str:
        """'tracked' or 'global'."""

    def query(self, X_WA: drake_haptics.common.pose_like.PoseLike, X_WB: drake_haptics.common.pose_like.PoseLike) -> Contact:
        """
        `Contact` of the pair at the poses X_WA and X_WB.

        Raises:
            ValueError: a pose is not finite or not rigid.
        """

    def query_trajectory(self, X_WA: drake_haptics.common.pose_like.PoseLike, X_WB: drake_haptics.common.pose_like.PoseLike) -> PairTrajectory:
        """
        Contacts of n queries in turn, in one call without the GIL.

        Args:
            X_WA: (n, 4, 4) or (n, 7) poses of A in turn, or one pose if A rests.
            X_WB: poses of B, likewise.

        Raises:
            ValueError: a pose is not finite or not rigid, or numbers of poses differ; then no query is made.
        """

    def reset(self) -> None:
        """Forgets what earlier queries found."""

    def __deepcopy__(self, arg: object, /) -> ConvexPair: ...

    def __copy__(self) -> ConvexPair: ...

    def __repr__(self) -> str: ...

def clock_interval() -> float:
    """
    Seconds between two readings of the clock that times queries, with nothing between them. Each timed query includes it.
    """

class ContactTrajectory:
    """
    The contacts of a tracker at each of k poses: read-only columns over all n contacts, pose after pose, and a sequence of `ContactSet`. Immutable.
    """

    def __len__(self) -> int: ...

    def __getitem__(self, k: int) -> ContactSet:
        """The contacts at pose k."""

    def __iter__(self) -> Iterator[ContactSet]: ...

    def __repr__(self) -> str: ...

    @property
    def distance(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) signed distance, m; > 0 apart, < 0 penetrating (then −distance is the depth).
        """

    @property
    def nhat_BA_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) unit normal out of B into A, in the world."""

    @property
    def p_WCa(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) witness point on A, in the world, m."""

    @property
    def p_WCb(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) witness point on B, in the world, m."""

    @property
    def p_WC(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) mean of both (paper, Eq. 1), in the world, m."""

    @property
    def extent(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (n,) measure of the overlap, m²: for flush faces their area under the pressure of a thin layer, for a flush edge its length times the layer, at a point the layer squared. Parts of a divided face add up.
        """

    @property
    def flushness(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) share of the contact, 0 to 1, that lies in flush faces or edges."""

    @property
    def feature_A(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """
        (n, 2) int32, feature of A in contact: [FeatureKind, index], -1 where another library found the contact.
        """

    @property
    def feature_B(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """
        (n, 2) int32, feature of B in contact: [FeatureKind, index], -1 where another library found the contact.
        """

    @property
    def status(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, ContactStatus."""

    @property
    def object_index(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, index of the object B."""

    @property
    def piece_A(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, piece of A (the tool) that `feature_A` belongs to."""

    @property
    def piece_B(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) int32, piece of B (the object)."""

    @property
    def start(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """
        (k + 1,) int64: the contacts at pose i are the rows start[i] to start[i + 1] of the columns.
        """

    @property
    def seconds(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(k,) time that each query took inside the core, s."""

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class ContactTracker:
    """
    All contacts of two decomposed bodies A and B, each query starting from the last one's answer (paper, sections 3 and 5.3): one for each pair of convex pieces nearer than the tolerance. Seams between pieces are not felt, and a piece that was pressed in stays in contact until it comes out the way it went in.

    A pose is a (4, 4) rigid matrix, a `RigidTransform`, or a (7,) vector [qw qx qy qz x y z]; lengths in m. A ValueError leaves the tracker as it was. Threads that share a tracker take turns.
    """

    def __init__(self, A: drake_haptics.geometry.decomposition.decompose.Decomposition | ConvexPieces, B: drake_haptics.geometry.decomposition.decompose.Decomposition | ConvexPieces, tolerance: float, depth: Literal['tracked', 'global'] = 'tracked', max_walk_steps: int = 1024) -> None:
        """
        Tracks the contacts of A and B up to `tolerance` (m).

        Args:
            depth: Depth of two pieces in overlap: `tracked` walks from the last answer, and so does not pop through a thin plate; `global` is the smallest depth over all features of both surfaces, and costs more. Both hold a piece that has passed behind a surface until it comes back.
            max_walk_steps: Bound on the steps of a walk from feature to feature (paper, 5.2.3), at least 1. Where it ends a walk, the status is `BOUNDED`, and the depth may be too large, never too small.

        Raises:
            ValueError: not decompositions, the tolerance is negative or not finite, no such depth, or max_walk_steps below 1.
        """

    def query(self, X_WA: drake_haptics.common.pose_like.PoseLike, X_WB: drake_haptics.common.pose_like.PoseLike) -> ContactSet:
        """
        `ContactSet` of the bodies at the poses X_WA and X_WB.

        Raises:
            ValueError: a pose is not finite or not rigid.
        """

    def query_trajectory(self, X_WA: drake_haptics.common.pose_like.PoseLike, X_WB: drake_haptics.common.pose_like.PoseLike) -> ContactTrajectory:
        """
        Contacts of k queries in turn, in one call without the GIL.

        Args:
            X_WA: (k, 4, 4) or (k, 7) poses of A in turn, or one pose if A rests.
            X_WB: poses of B, likewise.

        Raises:
            ValueError: a pose is not finite or not rigid, or numbers of poses differ; then no query is made.
        """

    def __repr__(self) -> str: ...

    @property
    def tolerance(self) -> float:
        """
        Distance up to which there are contacts, m. It may be changed between two queries; the tracker goes on from its last answer.

        Raises:
            ValueError: negative or not finite.
        """

    @tolerance.setter
    def tolerance(self, tolerance: object | None) -> None: ...

    @property
    def depth(self) -> str:
        """'tracked' or 'global'."""

    @property
    def max_walk_steps(self) -> int:
        """Bound on the steps of a walk from feature to feature."""

    def reset(self) -> None:
        """Forgets what earlier queries found."""

    def __deepcopy__(self, arg: object, /) -> ContactTracker: ...

    def __copy__(self) -> ContactTracker: ...

class SceneTracker:
    """
    All contacts of a moving tool with many objects at once: a `ContactTracker` in which A is the tool and B each object. Objects are posed one by one and stay there, so that those at rest cost nothing.
    """

    def __init__(self, tool: drake_haptics.geometry.decomposition.decompose.Decomposition | ConvexPieces, objects: Sequence[drake_haptics.geometry.decomposition.decompose.Decomposition | ConvexPieces], tolerance: float, depth: Literal['tracked', 'global'] = 'tracked', max_walk_steps: int = 1024) -> None:
        """
        Tracks the contacts of `tool` with `objects`, all at the identity pose, up to `tolerance` (m).

        Args:
            depth: Depth of two pieces in overlap: `tracked` walks from the last answer, and so does not pop through a thin plate; `global` is the smallest depth over all features of both surfaces, and costs more. Both hold a piece that has passed behind a surface until it comes back.
            max_walk_steps: Bound on the steps of a walk from feature to feature (paper, 5.2.3), at least 1. Where it ends a walk, the status is `BOUNDED`, and the depth may be too large, never too small.

        Raises:
            ValueError: not decompositions, no objects, the tolerance is negative or not finite, no such depth, or max_walk_steps below 1.
        """

    @property
    def num_objects(self) -> int: ...

    def set_object_pose(self, i: int, X_WO: drake_haptics.common.pose_like.PoseLike) -> None:
        """
        Poses object i.

        Raises:
            ValueError: not a pose; the object stays where it is.
            IndexError: no such object.
        """

    def query(self, X_WT: drake_haptics.common.pose_like.PoseLike, tolerance: float | None = None) -> ContactSet:
        """
        `ContactSet` of the tool at the pose X_WT. A `tolerance` (m) smaller than the tracker's limits the query to contacts up to that, for less work; each query may have its own.

        Raises:
            ValueError: the pose is not finite or not rigid, or the tolerance not within 0 and the tracker's.
        """

    def query_trajectory(self, X_WT: drake_haptics.common.pose_like.PoseLike) -> ContactTrajectory:
        """
        Contacts of k queries in turn, in one call without the GIL; the objects rest.

        Args:
            X_WT: (k, 4, 4) or (k, 7) poses of the tool in turn.

        Raises:
            ValueError: a pose is not finite or not rigid; then no query is made.
        """

    def __repr__(self) -> str: ...

    @property
    def tolerance(self) -> float:
        """
        Distance up to which there are contacts, m. It may be changed between two queries; the tracker goes on from its last answer.

        Raises:
            ValueError: negative or not finite.
        """

    @tolerance.setter
    def tolerance(self, tolerance: object | None) -> None: ...

    @property
    def depth(self) -> str:
        """'tracked' or 'global'."""

    @property
    def max_walk_steps(self) -> int:
        """Bound on the steps of a walk from feature to feature."""

    def reset(self) -> None:
        """Forgets what earlier queries found."""

    def __deepcopy__(self, arg: object, /) -> SceneTracker: ...

    def __copy__(self) -> SceneTracker: ...

class ContactExtrapolation:
    """
    Carries contacts along with the bodies, for fixed features (contact_extrapolation.h). Immutable.
    """

    def __init__(self, tool: ConvexPieces, objects: Sequence[ConvexPieces], X_WO: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')] | None]) -> None:
        """
        Carries contacts of the query's `tool` and `objects`.

        Args:
            X_WO: (7,) pose [qw qx qy qz x y z] of each object that never moves, None for the others.

        Raises:
            ValueError: not a pose, or not an entry for each object.
        """

    @overload
    def advance(self, contacts: ContactSet, found: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], now: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]) -> ContactSet:
        """
        Returns the contacts at the bodies' current poses.

        Args:
            contacts: `ContactSet` of a query, not shaded.
            found: (7 + 7 m,) poses of that query, of the tool, then of the m objects that move.
            now: (7 + 7 m,) current poses of the same bodies.

        Raises:
            ValueError: a pose is not valid, there is not one for each body, or a contact names no features, see `contact_set`.
            IndexError: a contact names an object, piece or feature that does not exist.
        """

    @overload
    def advance(self, contacts: AutoDiffContactSet, found: AutoDiffVector, now: AutoDiffVector) -> AutoDiffContactSet:
        """The same with derivatives."""

class ClusterSet:
    """
    Representative contacts of one tick, as read-only columns over k clusters. Immutable; copies are the object itself.
    """

    def __len__(self) -> int: ...

    def __repr__(self) -> str: ...

    @property
    def distance(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(k,) smallest distance of the members (Eq. 5), m."""

    @property
    def nhat_BA_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(k, 3) weighted mean directions (Eq. 3), unit."""

    @property
    def p_WC(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(k, 3) weighted mean positions (Eq. 4), m."""

    @property
    def compression(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(k,) m; the elastic force of a cluster is the stiffness times this."""

    @property
    def damping_share(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (k,) the damping force is the damping times the speed of approach times this.
        """

    @property
    def object_index(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(k,) object of each cluster."""

    @property
    def num_contacts(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(k,) members."""

    @property
    def label(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(n,) cluster of each contact; -1 beyond the tolerance."""

    @property
    def coupling(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='F')]:
        """
        (k, k) derivative of `compression` by the depths tolerance − distance; symmetric, positive semidefinite.
        """

    @property
    def is_bounded(self) -> bool:
        """
        Whether the search for the compressions reached its bound on steps: they push, but are not quite those of least energy.
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

@overload
def thin_contacts(contacts: ContactSet, cell: float) -> ContactSet:
    """
    Leaves out contacts near a deeper one of the same object: nearer than `cell` (m), and with a normal that differs by less than 45°. The deeper one takes over their extents; 0 leaves nothing out.

    Raises:
        ValueError: cell < 0.
    """

@overload
def thin_contacts(contacts: AutoDiffContactSet, cell: float) -> AutoDiffContactSet:
    """The same with derivatives; the contacts that stay are fixed."""

@overload
def cluster_contacts(contacts: ContactSet, delta: float, tolerance: float) -> ClusterSet:
    """
    Groups contacts nearer than `tolerance` (m) with an octree of leaf size `delta` (m) and represents each group by one contact (paper, 4.2, Eq. 1 to 5). Members have the weight `tolerance` − distance.

    Raises:
        ValueError: delta <= 0 or tolerance < 0.
    """

@overload
def cluster_contacts(contacts: AutoDiffContactSet, delta: float, tolerance: float) -> AutoDiffClusterSet:
    """The same with derivatives; the groups of contacts are fixed."""

@overload
def share_stiffness(contacts: ContactSet, tolerance: float) -> ClusterSet:
    """
    Makes each contact nearer than `tolerance` (m) a cluster of its own, and lets those along one direction share stiffness, as if they pressed into a common elastic skin: the force is a continuous function of the contacts (shared_stiffness.h).

    Raises:
        ValueError: tolerance < 0.
    """

@overload
def share_stiffness(contacts: AutoDiffContactSet, tolerance: float) -> AutoDiffClusterSet:
    """The same with derivatives; the contacts that push are fixed."""

class ObjectFrames:
    """
    Origins and spatial velocities of all objects of a scene, as the core reads them. Immutable.
    """

    def __init__(self, p_WO: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')], V_WO: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C')]) -> None:
        """
        Args:
            p_WO: (m, 3) objects' origins, m.
            V_WO: (m, 6) their spatial velocities [rad/s; m/s].

        Raises:
            ValueError: rows do not match.
        """

    def __len__(self) -> int: ...

    @property
    def p_WO(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(m, 3) origins, m."""

    @property
    def V_WO(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C')]:
        """(m, 6) spatial velocities [rad/s; m/s]."""

    def moved(self, index: Sequence[int], X_WO: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]], V_WO: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]]) -> ObjectFrames:
        """
        Returns a copy in which some objects have moved.

        Args:
            index: indices of these objects.
            X_WO: pose (7,) [qw qx qy qz x y z] of each, m.
            V_WO: spatial velocity (6,) of each, [rad/s; m/s].

        Raises:
            ValueError: there is not a pose and a velocity for each index.
            IndexError: there is no such object.
        """

class ContactMaterials:
    """
    Contact stiffness and damping of all objects of a scene, as the core reads them. Immutable.
    """

    def __init__(self, stiffness: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], damping: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]) -> None:
        """
        Args:
            stiffness: (m,) k of each object, N/m.
            damping: (m,) k_v of each object, N·s/m.

        Raises:
            ValueError: a gain is negative or not finite, or rows do not match.
        """

    def __len__(self) -> int: ...

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class PenaltyWrench:
    """The wrenches of all clusters. Immutable; copies are the object itself."""

    def __repr__(self) -> str: ...

    @property
    def wrench_model(self) -> Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]:
        """
        (78,) wrench on the tool at To in W with its linear model: [F (6); K (36, by rows); B (36, by rows)], rotational first.
        """

    @property
    def F_To_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) wrench on the tool at To, [N·m; N]."""

    @property
    def F_objects_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C')]:
        """(m, 6) wrench on each object at its origin, [N·m; N]."""

    @property
    def f_cluster_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """(k, 3) force of each cluster on the tool, N."""

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

def penalty_wrench_model(clusters: ClusterSet, X_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], objects: ObjectFrames, materials: ContactMaterials) -> Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]:
    """
    The `wrench_model` (78,) of `penalty_force` with the same arguments, for a tick that needs nothing else.
    """

@overload
def penalty_force(clusters: ClusterSet, X_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], objects: ObjectFrames, materials: ContactMaterials) -> PenaltyWrench:
    """
    Penalty wrenches of the clusters (paper, Eq. 6 to 10): k times the compression along the normal, plus damping while approaching; never a pull. Its time depends on the number of clusters, not of objects.

    Args:
        X_WT: (7,) pose of the tool [qw qx qy qz x y z], m.
        V_WT: (6,) spatial velocity of the tool [rad/s; m/s].
        objects: frames of the objects.
        materials: materials of the objects.

    Raises:
        ValueError: there is not a material for each object.
        IndexError: a cluster names an object that is not given.
    """

@overload
def penalty_force(clusters: ClusterSet, p_WTo: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], p_WO: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')], V_WO: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C')], stiffness: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], damping: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]) -> PenaltyWrench:
    """
    The same for a single call, from the arguments of `ObjectFrames` and `ContactMaterials`; p_WTo (3,) is the tool's origin, m.

    Raises:
        ValueError: a gain is negative or not finite, or rows do not match.
        IndexError: a cluster names an object that has no row.
    """

@overload
def penalty_force(clusters: AutoDiffClusterSet, p_WTo: AutoDiffVector, V_WT: AutoDiffVector, p_WO: AutoDiffVector, V_WO: AutoDiffVector, stiffness: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], damping: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]) -> AutoDiffPenaltyWrench:
    """
    The same with derivatives; p_WO (3 m,) and V_WO (6 m,) have one object after another.
    """

class CouplingGains:
    """
    Gains of the virtual coupling's spring and damper, and the largest norms of the force and torque of both together. Immutable; equal if all numbers are.
    """

    def __init__(self, stiffness_N_per_m: float, damping_Ns_per_m: float, rotational_stiffness_Nm_per_rad: float, rotational_damping_Nms_per_rad: float, max_force_N: float = float('inf'), max_torque_Nm: float = float('inf')) -> None: ...

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

    @property
    def stiffness_N_per_m(self) -> float: ...

    @property
    def damping_Ns_per_m(self) -> float: ...

    @property
    def rotational_stiffness_Nm_per_rad(self) -> float: ...

    @property
    def rotational_damping_Nms_per_rad(self) -> float: ...

    @property
    def max_force_N(self) -> float: ...

    @property
    def max_torque_Nm(self) -> float: ...

    def __eq__(self, arg: object, /) -> bool: ...

    def __hash__(self) -> int: ...

    def __repr__(self) -> str: ...

@overload
def joined_coupling_wrench(joined: Annotated[NDArray[numpy.float64], dict(shape=(39), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(84), order='C')]:
    """
    Wrenches of the virtual coupling between handle H and tool, from one vector as a multiplexer joins it: each array that is passed takes as long as the law.

    Args:
        joined: (39,) [q_WH; V_WH; q_WT; V_WT; gains; q_HT], the gains (6) in the order of `CouplingGains`, q_HT the pose of the tool in the handle at rest; poses [qw qx qy qz x y z], spatial velocities [rad/s; m/s].

    Returns:
        (84,): wrench model on the tool at To (78), then the reaction on the handle at Ho in W (6).

    Raises:
        ValueError: a gain is out of range.
    """

@overload
def joined_coupling_wrench(joined: AutoDiffVector) -> AutoDiffVector:
    """The same with derivatives by all but the gains and q_HT."""

def limit_wrench(F: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], max_torque_Nm: float, max_force_N: float) -> Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]:
    """
    Shortens torque and force of a wrench (6,), [N·m; N], each to its limit, along its own direction.

    Returns:
        (7,): the limited wrench and a number: 0 if it is unchanged, 1 if it was limited, 2 if it was not finite and is zero.

    Raises:
        ValueError: a limit is negative or not finite.
    """

def limit_coupling(joined: Annotated[NDArray[numpy.float64], dict(shape=(39), order='C')], max_torque_Nm: float, max_force_N: float) -> Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]:
    """
    The same for the reaction on the handle of `joined_coupling_wrench`.

    Raises:
        ValueError: a limit is negative or not finite, or a gain is out of range.
    """

class RigidToolDynamics:
    """A free rigid tool, advanced implicitly."""

    def __init__(self, mass_kg: float, p_TTcm: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], I_TTcm_T: Annotated[NDArray[numpy.float64], dict(shape=(3, 3), order='F')]) -> None:
        """
        Tool of `mass_kg`, center of mass (3,) m and rotational inertia about it (3, 3) kg·m², both in the tool's frame.

        Raises:
            ValueError: a value is not finite, the mass not above 0, or the inertia not symmetric and positive definite.
        """

    @property
    def mass_kg(self) -> float:
        """Mass, kg."""

    @property
    def p_TTcm(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Center of mass (3,) in the tool's frame, m."""

    @overload
    def step(self, state: Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')], wrench_models: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]], h: float) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """
        Advances the state (13,) = [pose (7); spatial velocity (6)] by one linearized backward Euler step of h seconds under the sum of wrench models (78,).
        """

    @overload
    def step(self, state: Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')], wrench_model: Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')], h: float) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """The same under one wrench model (78,)."""

    @overload
    def step(self, state: AutoDiffVector, wrench_model: AutoDiffVector, h: float) -> AutoDiffVector:
        """The same with derivatives."""

@overload
def tool_weight(q_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], p_TTcm: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], weight_W: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
    """
    Weight of the tool, a force at its center of mass.

    Args:
        q_WT: (7,) pose [qw qx qy qz x y z].
        p_TTcm: (3,) center of mass in the tool's frame, m.
        weight_W: (3,) mass times gravity, N.

    Returns:
        (6,) wrench on the tool at To in W, [N·m; N].
    """

@overload
def tool_weight(q_WT: AutoDiffVector, p_TTcm: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], weight_W: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> AutoDiffVector:
    """The same with derivatives."""

class ConstraintStepResult:
    """Result of one tick of a `ConstraintStepper`. Immutable."""

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

    @property
    def q_WT(self) -> Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]:
        """(7,) pose [qw qx qy qz x y z] of the tool at the tick's end."""

    @property
    def V_WT(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) spatial velocity [rad/s; m/s] of the tool at the tick's end."""

    @property
    def F_Ho_W_commanded(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """
        (6,) [torque; force] of the coupling on the handle at Ho in W, at the tick's beginning, as from `joined_coupling_wrench`.
        """

    @property
    def contacts(self) -> ContactSet:
        """
        `ContactSet` of the rows that push, ordered by object and pieces. A flush pair has several.
        """

    @property
    def friction(self) -> FrictionStep:
        """`FrictionStep` of `contacts`, which take the place of clusters."""

    @property
    def F_Oo_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C')]:
        """
        (num_objects, 6) [torque; force] of contact on each object at the origin of its frame, in W, friction included.
        """

    @property
    def hessian(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')]:
        """
        (6, 6) slope of the step's forces by the tool's motion, [N·m; N] by [rad; m]: A = M/h² + B/h + K + Σ k a aᵀ over rows that push, and the slope of friction. A change dF of the wrench on the tool changes its motion by A⁻¹ dF and V_WT by A⁻¹ dF / h.
        """

    @property
    def contact_stiffness(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')]:
        """(6, 6) the rows' part of `hessian`, Σ k a aᵀ."""

    @property
    def num_rows(self) -> int:
        """Number of rows within reach, including those that do not push."""

    @property
    def num_substeps(self) -> int:
        """Number of parts of a divided fast motion, at least 1."""

    @property
    def num_iterations(self) -> int:
        """
        Number of iterations of Newton's method, over all solutions of the tick.
        """

    @property
    def is_bounded(self) -> bool:
        """
        Whether a bound on iterations or parts ended the tick, so that the tool moved less than it should.
        """

    @property
    def least_distance_m(self) -> float:
        """
        Smallest distance of the tool to an object at the tick's beginning, m; infinite where none is within reach.
        """

    @property
    def is_apart(self) -> bool:
        """
        Whether no pieces touch or overlap at the tick's beginning. Otherwise the tool is led out at a bounded speed.
        """

    def __repr__(self) -> str: ...

    @property
    def lambda_N(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) force along the normal of each contact, N."""

class ConstraintStepper:
    """
    Contact as a constraint: in each tick, a rigid tool on a virtual coupling stays a skin away from all objects.

    The motion ξ = [θ; t] of To in a tick is the minimum of

        ½ ξᵀ H ξ − rᵀ ξ + Σ φ_i(b_i − a_iᵀ ξ),  H = M/h² + B/h + K,
        r = M V/h + B V + F − b_M,  a_i = [r_i × n_i; n_i],

    with the inertia M and its velocity terms b_M, the model F, K, B of the coupling and applied wrench, and a row for each pair of convex pieces within reach and for each corner where they are flush: the distance d_i along n_i does not fall below the skin, φ_i(x) = ½ k max(0, x)² with k = 1e9 N/m and b_i = min(δ, d_i) − d_i. A row that has lost skin leads back at 20 mm/s with at most 200 N; pieces that overlap are led out at that speed with at most 3 N in total. No contact makes energy: a_iᵀ ξ <= 0 wherever a row that holds pushes. Without rows it is `RigidToolDynamics.step` with the coupling alone. A fast motion is divided, so that nothing is passed through.

    As in SAP (Castro et al., "An Unconstrained Convex Formulation of Compliant Contact", 2023), contact is a convex problem of one implicit step. Threads that share a stepper take turns.
    """

    def __init__(self, tool: drake_haptics.geometry.decomposition.decompose.Decomposition | ConvexPieces, objects: Sequence[drake_haptics.geometry.decomposition.decompose.Decomposition | ConvexPieces], skin_m: numpy.typing.ArrayLike, dynamics: RigidToolDynamics, gains: CouplingGains, q_HT: numpy.typing.ArrayLike, period_s: float, coefficient: numpy.typing.ArrayLike = (), break_away_m: float = 1e-4) -> None:
        """
        Puts all objects at rest at the identity pose.

        Args:
            tool: Pieces of the tool.
            objects: Pieces of each object.
            skin_m: (num_objects,) distance δ that the tool keeps from each object, m. A tool that must fit somewhere needs more clearance than that.
            dynamics: Inertia of the tool.
            gains: Spring and damper of the coupling, and their limits.
            q_HT: (7,) pose of the tool in the handle.
            period_s: Duration h of a tick, s.
            coefficient: (num_objects,) coefficient of friction μ with each object. Defaults to none.
            break_away_m: Displacement of the tool before it slides, m. Defaults to 0.1 mm.

        Raises:
            ValueError: not decompositions, not one skin or coefficient for each object, or a number is out of range.
        """

    @property
    def num_anchors(self) -> int:
        """Number of values of the friction anchors: 8 for each object, or 0."""

    @property
    def num_objects(self) -> int:
        """Number of objects."""

    def set_gains(self, gains: CouplingGains) -> None:
        """Changes the gains of the coupling, from the next tick on."""

    def set_object_pose(self, i: int, X_WO: drake_haptics.common.pose_like.PoseLike, V_WO: numpy.typing.ArrayLike = ...) -> None:
        """
        Poses object i at the next tick's beginning.

        Args:
            i: Index of the object.
            X_WO: Pose of the object, as a tracker takes it.
            V_WO: (6,) spatial velocity [rad/s; m/s] of its frame in the tick. Defaults to rest.

        Raises:
            ValueError: not a pose, or not finite; the object stays where it is.
            IndexError: no such object.
        """

    def step(self, q_WT: numpy.typing.ArrayLike, V_WT: numpy.typing.ArrayLike, q_WH: numpy.typing.ArrayLike, V_WH: numpy.typing.ArrayLike, F_applied_To_W: numpy.typing.ArrayLike = ..., anchors: numpy.typing.ArrayLike = ()) -> ConstraintStepResult:
        """
        Advances the tool by a tick.

        Args:
            q_WT, V_WT: (7,) pose [qw qx qy qz x y z] and (6,) spatial velocity [rad/s; m/s] of the tool.
            q_WH, V_WH: Pose and spatial velocity of the handle, likewise.
            F_applied_To_W: (6,) sum of all other wrenches on the tool, [torque; force] at To in W, its weight among them. Defaults to zero.
            anchors: (num_anchors,) `friction.next_state` of the last tick. Defaults to the anchors of a tool that has touched nothing.

        Raises:
            ValueError: a value is not finite, or the number of anchors differs; the stepper stays as it was.
        """

    def differentiate(self, state: AutoDiffVector, q_WH: AutoDiffVector, V_WH: AutoDiffVector, F_applied_To_W: AutoDiffVector, X_WO: Sequence[AutoDiffVector], V_WO: Sequence[AutoDiffVector]) -> AutoDiffVector:
        """
        Advances the tool by a tick with derivatives (step_gradient.h).

        Args:
            state: (13,) pose and spatial velocity of the tool.
            q_WH, V_WH: (7,) and (6,) pose and spatial velocity of the handle.
            F_applied_To_W: (6,) sum of all other wrenches on the tool.
            X_WO, V_WO: (7,) pose and (6,) spatial velocity of each object.

        Returns:
            (19 + 6 num_objects,): the state at the tick's end, the wrench of contact on the tool at its origin at the tick's beginning, and the wrench on each object at its origin, in W.

        Raises:
            ValueError: a value is not finite, or numbers of objects or of variables differ.
        """

    def reset(self) -> None:
        """Forgets what earlier ticks found; the objects stay."""

    def __deepcopy__(self, arg: object, /) -> ConstraintStepper: ...

    def __copy__(self) -> ConstraintStepper: ...

    def __repr__(self) -> str: ...

class AutoDiffContactSet:
    """
    A `ContactSet` with derivatives by D variables. Its columns are `AutoDiffVector`, those of vectors flattened by rows. Immutable; copies are the object itself.
    """

    def __len__(self) -> int: ...

    @property
    def distance(self) -> AutoDiffVector:
        """(n,) m."""

    @property
    def nhat_BA_W(self) -> AutoDiffVector:
        """(3 n,) unit normals."""

    @property
    def p_WCa(self) -> AutoDiffVector:
        """(3 n,) witness points on A, m."""

    @property
    def p_WCb(self) -> AutoDiffVector:
        """(3 n,) witness points on B, m."""

    @property
    def p_WC(self) -> AutoDiffVector:
        """(3 n,) means of both, m."""

    @property
    def extent(self) -> AutoDiffVector:
        """(n,) m²."""

    @property
    def flushness(self) -> AutoDiffVector:
        """(n,)."""

    @property
    def value(self) -> ContactSet:
        """The `ContactSet`."""

    @property
    def num_derivatives(self) -> int:
        """Number D of the variables of the derivatives."""

    def with_variables(self, num_derivatives: int) -> AutoDiffContactSet:
        """
        Returns a constant (D = 0) with zero derivatives by that many variables.

        Raises:
            ValueError: it has derivatives already.
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

def differentiate_contacts(contacts: ContactSet, tolerance: float, tool: ConvexPieces, X_WT: AutoDiffVector, objects: Sequence[ConvexPieces], X_WO: Sequence[AutoDiffVector]) -> AutoDiffContactSet:
    """
    Contacts of a query with derivatives, for fixed features (query_gradient.h).

    Args:
        contacts: contacts of the query at these poses, not shaded.
        tolerance: tolerance of the query, m.
        tool, objects: the bodies of the query.
        X_WT: (7,) pose [qw qx qy qz x y z].
        X_WO: a (7,) pose for each object.

    Raises:
        ValueError: a pose is not valid, numbers of objects or of variables differ, or a contact names no features, see `contact_set`.
        IndexError: a contact names an object, a piece or a feature that is not given.
    """

class AutoDiffClusterSet:
    """
    A `ClusterSet` with derivatives by D variables. Its columns are `AutoDiffVector`, those of vectors flattened by rows. Immutable; copies are the object itself.
    """

    def __len__(self) -> int: ...

    @property
    def distance(self) -> AutoDiffVector:
        """(k,) m."""

    @property
    def nhat_BA_W(self) -> AutoDiffVector:
        """(3 k,) unit normals."""

    @property
    def p_WC(self) -> AutoDiffVector:
        """(3 k,) m."""

    @property
    def compression(self) -> AutoDiffVector:
        """(k,) m."""

    @property
    def damping_share(self) -> AutoDiffVector:
        """(k,)."""

    @property
    def coupling(self) -> AutoDiffVector:
        """(k k,) derivative of `compression` by the depths."""

    @property
    def value(self) -> ClusterSet:
        """The `ClusterSet`."""

    @property
    def num_derivatives(self) -> int:
        """Number D of the variables of the derivatives."""

    def with_variables(self, num_derivatives: int) -> AutoDiffClusterSet:
        """
        Returns a constant (D = 0) with zero derivatives by that many variables.

        Raises:
            ValueError: it has derivatives already.
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class AutoDiffPenaltyWrench:
    """
    A `PenaltyWrench` with derivatives by D variables; its wrenches and forces are flattened by rows. Immutable; copies are the object itself.
    """

    @property
    def wrench_model(self) -> AutoDiffVector:
        """(78,) wrench on the tool at To with its linear model."""

    @property
    def F_To_W(self) -> AutoDiffVector:
        """(6,) wrench on the tool at To, [N·m; N]."""

    @property
    def F_objects_W(self) -> AutoDiffVector:
        """(6 m,) wrench on each object at its origin, [N·m; N]."""

    @property
    def f_cluster_W(self) -> AutoDiffVector:
        """(3 k,) force of each cluster on the tool, N."""

    @property
    def value(self) -> PenaltyWrench:
        """The `PenaltyWrench`."""

    @property
    def num_derivatives(self) -> int:
        """Number D of the variables of the derivatives."""

    def with_variables(self, num_derivatives: int) -> AutoDiffPenaltyWrench:
        """
        Returns a constant (D = 0) with zero derivatives by that many variables.

        Raises:
            ValueError: it has derivatives already.
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class SurfaceShading:
    """
    The surface of a decomposed mesh with normals to interpolate over its triangles (Gouraud): at each corner of a triangle the mean normal, weighted by angles, of the triangles around the vertex that are reached across edges which turn by less than the crease angle. Immutable.

    Pieces that were not made from triangles (methods "hull" and "coacd") keep the normals of their facets.
    """

    def __init__(self, decomposition: ConvexPieces, crease_angle: float) -> None:
        """
        Finds the normals once; `crease_angle` is in rad, 0 for the facets' own normals.

        Raises:
            ValueError: crease_angle is not in [0, π].
        """

class ContactShading:
    """
    Force shading of the contacts of a tool with objects (paper, 4.4.1; Morgenbesser and Srinivasan 1996): turns each normal to that of the smooth surfaces that the meshes approximate, by at most 45°. Immutable; copies are the object itself.
    """

    def __init__(self, tool: SurfaceShading, objects: Sequence[SurfaceShading]) -> None:
        """
        Shades contacts of `tool` with `objects`, in the order of the query's objects.

        Raises:
            ValueError: an object is None.
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

    @overload
    def shade(self, contacts: ContactSet, q_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], q_WO: Annotated[NDArray[numpy.float64], dict(shape=(None, 7), order='C')]) -> ContactSet:
        """
        Returns the contacts with shaded normals, otherwise unchanged.

        Args:
            contacts: `ContactSet` of a query at these poses.
            q_WT: (7,) pose of the tool [qw qx qy qz x y z].
            q_WO: (m, 7) poses of the objects.

        Raises:
            ValueError: a pose is not valid, there is not one for each object, or a contact names no features, see `contact_set`.
            IndexError: a contact names an object, piece or feature that does not exist.
        """

    @overload
    def shade(self, contacts: AutoDiffContactSet, q_WT: AutoDiffVector, q_WO: AutoDiffVector) -> AutoDiffContactSet:
        """The same with derivatives; q_WO (7 m,) has one object after another."""

class FrictionStep:
    """
    Friction of all clusters at one tick. Immutable; copies are the object itself.
    """

    @property
    def wrench_model(self) -> Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]:
        """
        (78,) wrench on the tool at To in W with its linear model: [F (6); K (36, by rows); B (36, by rows)], rotational first; B is zero.
        """

    @property
    def f_cluster_W(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """(k, 3) force of each cluster on the tool, at its point, N."""

    @property
    def sliding(self) -> Annotated[NDArray[numpy.bool_], dict(shape=(None,), order='C')]:
        """(k,) whether each cluster slides."""

    @property
    def stored_J(self) -> float:
        """Elastic energy of the contacts, ½ k z² of each, J."""

    @property
    def next_state(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) state from which the next tick starts."""

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class AutoDiffFrictionStep:
    """
    A `FrictionStep` with derivatives by D variables. Immutable; copies are the object itself.
    """

    @property
    def wrench_model(self) -> AutoDiffVector:
        """(78,) wrench on the tool at To with its linear model."""

    @property
    def f_cluster_W(self) -> AutoDiffVector:
        """(3 k,) force of each cluster on the tool, N."""

    @property
    def stored_J(self) -> AutoDiffVector:
        """(1,) elastic energy of the contacts, J."""

    @property
    def next_state(self) -> AutoDiffVector:
        """(n,) state from which the next tick starts."""

    @property
    def value(self) -> FrictionStep:
        """The `FrictionStep`."""

    @property
    def num_derivatives(self) -> int:
        """Number D of the variables of the derivatives."""

    def with_variables(self, num_derivatives: int) -> AutoDiffFrictionStep:
        """
        Returns a constant (D = 0) with zero derivatives by that many variables.

        Raises:
            ValueError: it has derivatives already.
        """

    def __deepcopy__(self, arg: object, /) -> object: ...

    def __copy__(self) -> object: ...

class StickSlipModel:
    """
    Stick-slip friction after Hayward and Armstrong (2000) of a tool on objects, at the representative contacts of clusters. Immutable: the state (n,) is passed in and returned. It is [X_WT (7); X_WO (7) of each object that moves; 32 slots of object, p_WC (3), nhat_BA_W (3), z (3), load, grip], the poses and the contacts of the last tick. A slot without a load is empty.
    """

    def __init__(self, coefficient: Sequence[float], moves: Sequence[bool], static_ratio: float, break_away_m: float, reach_m: float) -> None:
        """
        Args:
            coefficient: (m,) coefficient of sliding friction of each object; 0 for no friction.
            moves: (m,) whether each object moves.
            static_ratio: ratio of the static to the sliding coefficient.
            break_away_m: displacement after which a contact breaks away.
            reach_m: distance over which contacts hand their adhesion on.

        Raises:
            ValueError: a coefficient is negative, the ratio below 1, or a length not above 0.
        """

    @property
    def state_size(self) -> int:
        """n."""

    @overload
    def step(self, state: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], clusters: ClusterSet, contact_wrench: PenaltyWrench, q_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], q_WO: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> FrictionStep:
        """
        Returns the friction of this tick, and with it the state for the next.

        Args:
            state: (n,) state from the last tick; zeros before the first.
            clusters: clusters of this tick.
            contact_wrench: wrench of the clusters; the norms of its `f_cluster_W` are the normal forces.
            q_WT: (7,) pose of the tool.
            q_WO: (7 j,) poses of the j objects that move, one after the other.

        Raises:
            ValueError: a size does not match, or a cluster names an object that has no coefficient.
        """

    @overload
    def step(self, state: AutoDiffVector, clusters: AutoDiffClusterSet, contact_wrench: AutoDiffPenaltyWrench, q_WT: AutoDiffVector, q_WO: AutoDiffVector) -> AutoDiffFrictionStep:
        """
        The same with derivatives; which contacts stick or slide, and their neighbors, are fixed.
        """

class BrakingGains:
    """Viscous braking before surfaces touch."""

    def __init__(self, damping_Ns_per_m: float, distance_m: float) -> None:
        """
        Args:
            damping_Ns_per_m: damping b half-way to the surface, N·s/m.
            distance_m: distance D at which braking begins, m.

        Raises:
            ValueError: b < 0, D <= 0, or one of them is not finite.
        """

@overload
def pre_contact_braking(contacts: ContactSet, p_WTo: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], objects: ObjectFrames, gains: BrakingGains) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
    """
    Brakes the approach of surfaces that do not touch yet (McNeely, Puterbaugh and Troy 1999): at each contact with 0 < d < D a force b s w v along its normal, with the speed of approach v, w = 4 (d/D)(1 − d/D) and its share s among contacts with like normals (braking.h). It never pulls.

    Args:
        p_WTo: (3,) origin of the tool, m.
        V_WT: (6,) spatial velocity of the tool [rad/s; m/s].
        objects: frames of the objects.

    Returns:
        (78 + 6 m,) wrench model on the tool at To in W: [F (6); K (36), zero; B (36, by rows)], rotational first; then the wrench on each object at its origin in W, N·m and N.

    Raises:
        IndexError: a contact names an object that is not given.
    """

@overload
def pre_contact_braking(contacts: AutoDiffContactSet, p_WTo: AutoDiffVector, V_WT: AutoDiffVector, p_WO: AutoDiffVector, V_WO: AutoDiffVector, gains: BrakingGains) -> AutoDiffVector:
    """
    The same with derivatives; p_WO (3 m,) and V_WO (6 m,) have one object after another.
    """

class PassivityBounds:
    """Bounds of the passivity controller."""

    def __init__(self, period_s: float, max_damping_Ns_per_m: float, max_rotational_damping_Nms_per_rad: float, reserve_J: float) -> None:
        """
        Args:
            period_s: duration of a tick, s.
            max_damping_Ns_per_m: largest damping, N·s/m.
            max_rotational_damping_Nms_per_rad: largest rotational damping, N·m·s/rad.
            reserve_J: largest balance that is kept, J.

        Raises:
            ValueError: the period is not above 0, another bound is below 0, or one of them is not finite.
        """

@overload
def passivity_control(state: Annotated[NDArray[numpy.float64], dict(shape=(8), order='C')], F_Ho_W_rendered: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], F_Ho_W_desired: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], q_WH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_WH: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], bounds: PassivityBounds) -> Annotated[NDArray[numpy.float64], dict(shape=(14), order='C')]:
    """
    Passivity observer and controller (Hannaford and Ryu 2002) of one tick.

    Args:
        state: (8,) balance of the last tick, J, and the handle's pose then.
        F_Ho_W_rendered: (6,) wrench on the handle at Ho in W that was held since then, [N·m; N].
        F_Ho_W_desired: (6,) wrench that is desired now.
        q_WH: (7,) pose now, [qw qx qy qz x y z].
        V_WH: (6,) spatial velocity now, [rad/s; m/s].

    Returns:
        (14,) wrench to show (6), F_Ho_W_desired itself where the balance is not below 0; then the next state (8), the balance and pose now.
    """

@overload
def passivity_control(state: AutoDiffVector, F_Ho_W_rendered: AutoDiffVector, F_Ho_W_desired: AutoDiffVector, q_WH: AutoDiffVector, V_WH: AutoDiffVector, bounds: PassivityBounds) -> AutoDiffVector:
    """The same with derivatives."""

class FrameChange:
    """
    Changes poses and velocities from a frame B to a frame A in which B rests, and wrenches from A to B.
    """

    def __init__(self, X_AB: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]) -> None:
        """
        Pose (7,) of B in A, [qw qx qy qz x y z], m.

        Raises:
            ValueError: it is not a pose.
        """

    def change_motion(self, X_BH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_BH: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """
        Pose and spatial velocity of H in A, (13,), from those in B: (7,), m, and (6,), [rad/s; m/s].
        """

    def change_reading(self, X_BH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_BH: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], F_Ho_B: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], sequence: float, time_s: float, buttons: float, gate: float, fault: float) -> Annotated[NDArray[numpy.float64], dict(shape=(37), order='C')]:
        """
        The motion of H in A (13,), followed by all numbers of a `DeviceReading` (24,).

        Raises:
            FloatingPointError: the motion is not finite.
            ValueError: the quaternion is not of length 1, to 1e-3.
        """

    def change_wrench_back(self, F_A: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """Wrench (6,) in B from that in A, [N·m; N]."""

    def change_slopes_back(self, slopes_A: Annotated[NDArray[numpy.float64], dict(shape=(72), order='C')]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='C')]]:
        """Stiffness and damping (6, 6) in B from those in A, (72,) by rows."""

class PosePath:
    """A pose over time, a cubic per segment. Immutable."""

    def __init__(self, starts_s: Sequence[float], cubics: Annotated[NDArray[numpy.float64], dict(shape=(None, 4, 7), order='C', device='cpu', writable=False)], period_s: float) -> None:
        """
        Path of m segments.

        Args:
            starts_s: (m,) starts of the segments, rising from 0 s. The last one never ends.
            cubics: (m, 4, 7) coefficients by power of the time since the start, of [qw qx qy qz x y z]; the quaternion may have any length.
            period_s: time until the path repeats, s; infinite if never.

        Raises:
            ValueError: sizes do not match or there is no period.
        """

    def evaluate(self, time_s: float) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]]:
        """
        Returns the pose (7,) and the spatial velocity (6,) at its origin, [rad/s; m/s].
        """

class ArmDynamics:
    """
    A chain of six revolute joints and a hand that pulls its handle H along a path. States are (12,): angles, rad, and speeds, rad/s. All methods raise FloatingPointError where a state is not finite.
    """

    def __init__(self, J_WH: Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')], q_WH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], path: PosePath, q_PH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], gains: CouplingGains) -> None:
        """
        Args:
            J_WH: (6, 6) spatial velocity of H per joint speed, all angles zero.
            q_WH: (7,) pose of H, all angles zero.
            path: pose X_WP over time.
            q_PH: (7,) pose in P at which the hand wants the handle.
            gains: gains of the hand's spring and damper.
        """

    @overload
    def calc_handle_state(self, state: Annotated[NDArray[numpy.float64], dict(shape=(12), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """Pose X_WH and spatial velocity V_WH, (13,) = [pose (7); rad/s; m/s]."""

    @overload
    def calc_handle_state(self, state: AutoDiffVector) -> AutoDiffVector:
        """The same with derivatives."""

    @overload
    def calc_joint_torques(self, time_s: float, state: Annotated[NDArray[numpy.float64], dict(shape=(12), order='C')], F_Ho_W_rendered: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """
        Joint torques (6,), N·m, of the hand and of a wrench (6,) on the handle at its origin in the world, [N·m; N].
        """

    @overload
    def calc_joint_torques(self, time_s: AutoDiffVector, state: AutoDiffVector, F_Ho_W_rendered: AutoDiffVector) -> AutoDiffVector:
        """The same with derivatives; `time_s` is (1,)."""

class EnergyAccount:
    """
    Energy account of one part of a haptic loop, J. Energy that went in and neither came out nor is stored is lost; a passive part never regains lost energy.
    """

    @property
    def in_J(self) -> float:
        """Energy that went into the part, through all its ports."""

    @property
    def out_J(self) -> float:
        """Energy that came out."""

    @property
    def stored_J(self) -> float:
        """Energy that the part stores."""

    @property
    def lost_J(self) -> float:
        """in − out − (stored − stored at the start)."""

    @property
    def damped_J(self) -> float:
        """Part of `lost_J` that dampers took."""

    @property
    def created_J(self) -> float:
        """
        Energy that the part made: the largest fall of `lost_J` from any earlier value.
        """

    @property
    def bound_J(self) -> float:
        """
        Energy that the sampling of its force explains over the same stretch of time.
        """

    @property
    def beyond_J(self) -> float:
        """
        Largest energy made over a stretch of time, less the energy that sampling explains there.
        """

class EnergyLedger:
    """
    Books, tick by tick, the energy that goes through each part of a haptic loop: hand, display, coupling, tool and each source of wrench on the tool (energy_ledger.h). Mutable.
    """

    def __init__(self, dynamics: RigidToolDynamics, gains: CouplingGains, q_HT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], period_s: float, sources: Sequence[str]) -> None:
        """
        Args:
            dynamics: inertia of the tool.
            gains: gains of the coupling.
            q_HT: (7,) pose of the tool in the handle at which its spring rests.
            period_s: duration of a tick, s.
            sources: names of the other sources of wrench on the tool.

        Raises:
            ValueError: the tick is not above 0 s, or a name occurs twice or is that of another account.
        """

    def begin_again(self, gains: CouplingGains) -> None:
        """
        Goes on after a change of gains, of the coupling or of a source. The tick up to the next `add` is left out of the accounts, and so is the energy that the change puts into springs or takes out.

        Args:
            gains: gains of the coupling from now on.
        """

    def add(self, tool_state: Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')], q_WH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], F_Ho_W_rendered: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], coupling: Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')], wrench_models: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]], stored_J: Sequence[float]) -> None:
        """
        Books the tick between the last call and this one; the first call only sets the stored energies. All values are of one instant, after a step of the tool and before the next. A tick with an energy that is not finite is left out.

        Args:
            tool_state: (13,) = [pose (7), m; spatial velocity (6), rad/s and m/s].
            q_WH: (7,) pose of the handle.
            F_Ho_W_rendered: (6,) wrench that was held on the handle up to now, at Ho in W, N·m and N.
            coupling: (78,) wrench model of the coupling on the tool.
            wrench_models: (78,) wrench model of each source.
            stored_J: elastic or potential energy of each source.

        Raises:
            ValueError: a source has no reading.
        """

    @property
    def accounts(self) -> dict[str, EnergyAccount]:
        """
        `EnergyAccount` of each part by its name, as it stands now: `device`, the whole loop as the hand feels it at its port; `display`, `coupling`, `tool`, and each source.
        """

def contact_energy(clusters: ClusterSet, stiffness: Sequence[float], tolerance: float) -> float:
    """
    Energy that contacts store, J: half of each elastic force times its depth below the tolerance.

    Args:
        clusters: `ClusterSet`.
        stiffness: stiffness of each object, N/m.
        tolerance: distance below which contacts push, m.

    Raises:
        IndexError: a cluster names an object without a stiffness.
    """

def weight_energy(q_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], p_TTcm: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], weight_W: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
    """
    Potential energy of the tool's weight, J, zero with its center of mass at the world's origin.

    Args:
        q_WT: (7,) pose of the tool.
        p_TTcm: (3,) center of mass in the tool's frame, m.
        weight_W: (3,) mass times gravity, N.
    """

class DeviceStatePacket:
    """
    Packet that a driver sends (docs/device-protocol.md): the handle H in the frame B of the device's base, SI.
    """

    @property
    def session(self) -> int:
        """Session of the host that is served, or 0."""

    @property
    def sequence(self) -> int:
        """Number of the packet; rises by one, and wraps."""

    @property
    def time_ns(self) -> int:
        """Time of the sample by the driver's clock, ns."""

    @property
    def X_BH(self) -> Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]:
        """(7,) pose [qw qx qy qz x y z], m."""

    @property
    def V_BH(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) spatial velocity [ω; v], rad/s and m/s."""

    @property
    def F_Ho_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) wrench shown [τ; f] at Ho, N·m and N."""

    @property
    def boot(self) -> int:
        """Number that is random in each run of the driver."""

    @property
    def command_sequence(self) -> int:
        """Number of the newest command that was accepted."""

    @property
    def buttons(self) -> int:
        """Bit i: button i is held."""

    @property
    def rejected(self) -> int:
        """Number of packets refused so far."""

    @property
    def max_force_N(self) -> float:
        """Largest force, N."""

    @property
    def max_torque_Nm(self) -> float:
        """Largest torque, N·m."""

    @property
    def gate(self) -> int:
        """State, a number of `backend.GateState`."""

    @property
    def fault(self) -> int:
        """Fault, a number of `backend.Fault`."""

class DeviceCommandPacket:
    """Packet that a host sends (docs/device-protocol.md), SI."""

    @property
    def session(self) -> int:
        """Number that is random in each run of the host."""

    @property
    def sequence(self) -> int:
        """Number of the packet; rises by one, and wraps."""

    @property
    def time_ns(self) -> int:
        """Time of sending by the host's clock, ns."""

    @property
    def F_Ho_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) wrench to show [τ; f] at Ho in B, N·m and N."""

    @property
    def state_sequence(self) -> int:
        """Number of the state that this answers."""

    @property
    def ttl_us(self) -> int:
        """Time to live, µs."""

    @property
    def enable(self) -> bool:
        """Whether to show force."""

def pack_state(*, sequence: int, time_ns: int, X_BH: object, V_BH: object, F_Ho_B: object, boot: int, session: int, command_sequence: int, buttons: int, rejected: int, max_force_N: float, max_torque_Nm: float, gate: int, fault: int) -> bytes:
    """
    The 208 bytes of a state packet; the arguments are the attributes of `DeviceStatePacket`.

    Raises:
        ValueError: a number does not fit, or a shape is wrong.
    """

def unpack_state(packet: bytes) -> DeviceStatePacket:
    """
    Reads a state packet. Its real numbers may be NaN or infinite.

    Raises:
        ValueError: it is damaged or not a state packet; the message names the check that failed.
    """

def pack_command(*, session: int, sequence: int, time_ns: int, F_Ho_B: object, state_sequence: int, ttl_us: int, enable: bool) -> bytes:
    """
    The 88 bytes of a command packet; the arguments are the attributes of `DeviceCommandPacket`.

    Raises:
        ValueError: a number does not fit, or a shape is wrong.
    """

def unpack_command(packet: bytes) -> DeviceCommandPacket:
    """
    Reads a command packet. Its wrench may be NaN or infinite.

    Raises:
        ValueError: it is damaged or not a command packet; the message names the check that failed.
    """

class DeviceGate:
    """
    Safety gate between commands and a hand, in the driver's process: the state machine of gate.h (docs/device-protocol.md), with time as an argument. Force and torque never exceed the limits, in any state.
    """

    def __init__(self, *, max_force_N: float, max_torque_Nm: float, max_speed_m_per_s: float = 2.0, max_turn_rate_rad_per_s: float = 30.0, ramp_in_s: float = 0.2, ramp_out_s: float = 0.02, max_ttl_s: float = 0.1) -> None:
        """
        Args:
            max_force_N: Largest norm of the force, N; 0 for none.
            max_torque_Nm: Largest norm of the torque, N·m; 0 for none.
            max_speed_m_per_s: Largest speed of the handle, m/s; a faster one is a fault while active.
            max_turn_rate_rad_per_s: Largest turn rate, rad/s, likewise.
            ramp_in_s: Time from no force to full force, 0.001 to 10 s.
            ramp_out_s: Time from full force to none, 0.001 to 1 s.
            max_ttl_s: Longest time to live of a command, 1e-6 to 1 s.

        Raises:
            ValueError: a limit is not finite or out of its bounds.
        """

    def receive(self, now_ns: int, data: bytes) -> str:
        """
        Takes a packet with any content.

        Args:
            now_ns: Time of the driver's monotonic clock, ns.
            data: The datagram.

        Returns:
            'accepted', or the reason for refusal: a key of `counts`.

        Raises:
            ValueError: now_ns is not a 64-bit time.
        """

    def step(self, now_ns: int, X_BH: object, V_BH: object) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """
        Advances the time; called once per tick, after the packets.

        Args:
            now_ns: Time of the driver's monotonic clock, ns.
            X_BH: (7,) pose of the handle [qw qx qy qz x y z], m. A value that is not finite is a fault.
            V_BH: (6,) spatial velocity of the handle [ω; v], rad/s and m/s; likewise.

        Returns:
            (6,) the wrench to show [τ; f] at Ho in B, N·m and N.

        Raises:
            ValueError: X_BH or V_BH has a wrong shape, or now_ns is not a 64-bit time.
        """

    def fail(self) -> None:
        """Reports a fault of the driver's own hardware: zero wrench at once."""

    @property
    def state(self) -> int:
        """State, a number of `backend.GateState`."""

    @property
    def fault(self) -> int:
        """Fault, a number of `backend.Fault`."""

    @property
    def session(self) -> int:
        """Session of the host that is served, or 0."""

    @property
    def command_sequence(self) -> int:
        """Sequence of the newest command that was accepted."""

    @property
    def command_F_Ho_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) the newest wrench to show, within the limits, N·m and N."""

    @property
    def F_Ho_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) the wrench that is shown, N·m and N."""

    @property
    def scale(self) -> float:
        """Share of the newest wrench that is shown, 0 to 1."""

    @property
    def rejected(self) -> int:
        """Number of packets refused so far."""

    @property
    def counts(self) -> dict[str, int]:
        """Number of packets by verdict."""

    def __deepcopy__(self, arg: object, /) -> DeviceGate: ...

class ServoLaw:
    """
    Computes the wrench that a servo shows between the ticks of a slower loop: the last local wrench F − K δ − B (V − V₀), δ = [rotation vector; translation] from X₀ to X, each of force and torque within its limit. A wrench that is not renewed is shown for `hold_s`, then goes to zero within `release_s`; a wrench that is renewed comes back within `engage_s`. Wrenches are [τ; f] at the handle's origin, N·m and N, in one frame with poses [qw qx qy qz x y z], m, and velocities [ω; v], rad/s and m/s.
    """

    def __init__(self, *, max_force_N: float, max_torque_Nm: float, hold_s: float = 0.02, release_s: float = 0.02, engage_s: float = 0.2) -> None:
        """
        Raises:
            ValueError: a time is not finite and above zero.
        """

    def adopt(self, F: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], X: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], K: Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')] | None, B: Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')] | None, time_s: float) -> None:
        """
        Takes a wrench (6,) as of `time_s`, for the pose X₀ (7,) and the velocity V₀ (6,), with its slopes K and B (6, 6). Only the nearest symmetric slope without a negative eigenvalue acts, so that the servo is passive. A value that is not finite ends all force at once.
        """

    def step(self, time_s: float, X: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """
        Returns the wrench (6,) to show at `time_s`; zero where X (7,) or V (6,) is not finite.
        """

    @property
    def scale(self) -> float:
        """Share of the wrench that is shown, 0 to 1."""

    @property
    def num_not_finite(self) -> int:
        """Number of wrenches and states that were not finite."""

    @property
    def num_not_passive(self) -> int:
        """Number of wrenches whose K or B was not passive."""

class HandleState:
    """Last state that a device sent, in its base frame B."""

    @property
    def number(self) -> int:
        """Rises with every state that counts, also when the driver is restarted."""

    @property
    def time_s(self) -> float:
        """Time by the driver's clock, s."""

    @property
    def X_BH(self) -> Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')]:
        """(7,) pose [qw qx qy qz x y z], m."""

    @property
    def V_BH(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) velocity [ω; v], rad/s and m/s."""

    @property
    def F_Ho_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """(6,) wrench that the device showed, [τ; f], N·m and N."""

    @property
    def max_force_N(self) -> float:
        """The device's limit, N."""

    @property
    def max_torque_Nm(self) -> float:
        """The device's limit, N·m."""

    @property
    def buttons(self) -> int:
        """Bit i: button i is held."""

    @property
    def gate(self) -> int:
        """State, a number of `GateState`."""

    @property
    def fault(self) -> int:
        """Fault, a number of `Fault`."""

class UdpServoStatus:
    """Counters and state of a `UdpServo`, counted from the start."""

    @property
    def received(self) -> int:
        """Valid states that came, late and duplicate ones too."""

    @property
    def lost(self) -> int:
        """States that never came, by the gaps."""

    @property
    def late(self) -> int:
        """States that came after a newer one."""

    @property
    def duplicate(self) -> int:
        """States that had come before."""

    @property
    def damaged(self) -> int:
        """Packets that are not a whole state."""

    @property
    def not_finite(self) -> int:
        """States without a finite pose, velocity and wrench."""

    @property
    def restarts(self) -> int:
        """Restarts of the driver."""

    @property
    def silences(self) -> int:
        """
        Silences of the driver that were so long that the servo looked for it again.
        """

    @property
    def refused(self) -> int:
        """Packets that the driver refused, by its own count."""

    @property
    def sent(self) -> int:
        """Commands sent."""

    @property
    def wrenches_not_finite(self) -> int:
        """Wrenches and states that were not finite: force ended."""

    @property
    def wrenches_not_passive(self) -> int:
        """Wrenches whose K or B was not passive, and was projected."""

    @property
    def scale(self) -> float:
        """Share of the wrench that is sent."""

    @property
    def is_running(self) -> bool:
        """Whether the thread runs."""

    @property
    def is_heard(self) -> bool:
        """Whether states are coming."""

    @property
    def is_active(self) -> bool:
        """Whether a wrench may be shown."""

    @property
    def has_realtime_priority(self) -> bool:
        """Whether the system granted the thread real-time priority."""

    @property
    def has_locked_memory(self) -> bool:
        """Whether the system keeps the servo from being paged out."""

class UdpServo:
    """
    A thread that answers every state of a device's driver with the wrench of a `ServoLaw`. It runs without Python; only `close` waits for it. Only one thread of the program may use it.
    """

    def __init__(self, host: str, port: int, *, ttl_s: float = 0.05, max_rate_hz: float = 4000.0, max_force_N: float = float('inf'), max_torque_Nm: float = float('inf'), hold_s: float = 0.02, release_s: float = 0.02, engage_s: float = 0.2) -> None:
        """
        Starts the thread, which looks for the driver at that address.

        Args:
            host: name or address, IPv4 or IPv6.
            port: UDP port.
            ttl_s: time that the device shows a command that is not renewed. A silence of the driver for twice that time, and at least half a second, is a fault.
            max_rate_hz: largest rate of commands.
            max_force_N, max_torque_Nm: largest norms, where the device allows more.
            hold_s, release_s, engage_s: times of the `ServoLaw`.

        Raises:
            ValueError: a time or the rate is not finite and above zero, or a limit is negative or NaN.
            RuntimeError: there is no such host, or no socket is available.
        """

    def read(self) -> HandleState | None:
        """Returns the newest `HandleState`; None before the first."""

    def publish(self, F_Ho_B: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], X_BH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_BH: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')], K_B: Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')] | None = None, B_B: Annotated[NDArray[numpy.float64], dict(shape=(6, 6), order='F')] | None = None) -> None:
        """
        Shows a local wrench from now on, as `ServoLaw.adopt` does; the first one enables the device.
        """

    def recover(self) -> None:
        """
        Recovers from a fault: disabled until the device is idle, then enabled.
        """

    def close(self) -> None:
        """
        Disables the device and ends the thread, in some 30 ms. May be called again.
        """

    def status(self) -> UdpServoStatus:
        """Returns a `UdpServoStatus`."""

    def lateness_s(self) -> tuple[float, float, float]:
        """
        Returns p50, p99 and p99.9 of the lateness of answers, s, relative to the promptest one of the last 10 to 20 s, rounded up by at most a fifth.
        """

    @property
    def local_port(self) -> int:
        """Our own UDP port."""

def handle_slopes(q_WH: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], q_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], coupling_model: Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')], contact_model: Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(72), order='C')]:
    """
    Slopes of the wrench on a handle by the handle's motion, with the tool in equilibrium between coupling and contact (springs in series; Guyan, AIAA Journal 3(2), 1965).

    Args:
        q_WH, q_WT: (7,) poses [qw qx qy qz x y z] of handle and tool.
        coupling_model: (78,) [F; K; B] of the coupling on the tool, at To in W.
        contact_model: (78,) sum of all other wrench models.

    Returns:
        (72,): K then B by rows, at Ho in W; symmetric, without a negative eigenvalue. The wrench is F − K δ − B ΔV.
    """

class ServoTool:
    """
    Solves the tool for a servo: each period is one exact step of contact from the device's newest handle state. It yields the local wrench that a `ServoLaw` extrapolates until the next period. It has no clock. Poses are [qw qx qy qz x y z], m; velocities [ω; v], rad/s and m/s; wrenches [τ; f], N·m and N.
    """

    def __init__(self, stepper: ConstraintStepper, q_WB: numpy.typing.ArrayLike, start: numpy.typing.ArrayLike) -> None:
        """
        Copies a stepper, whose objects rest where they are.

        Args:
            stepper: A `ConstraintStepper` of the servo's period.
            q_WB: (7,) pose of the device's base in the world.
            start: (13,) first pose and velocity of the tool in the world.

        Raises:
            ValueError: Not a pose, or not finite.
        """

    @property
    def period_s(self) -> float:
        """Duration of a period, s."""

    @property
    def state(self) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """(13,) pose and velocity of the tool in the world."""

    @state.setter
    def state(self, arg: Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')], /) -> None: ...

    def set_gains(self, gains: CouplingGains) -> None:
        """Changes the coupling from the next period on."""

    def step(self, q_BH: numpy.typing.ArrayLike, V_BH: numpy.typing.ArrayLike, F_applied_To_W: numpy.typing.ArrayLike = ...) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
        """
        Advances the tool by a period.

        Args:
            q_BH, V_BH: Pose (7,) and velocity (6,) of the handle in the device's base frame.
            F_applied_To_W: (6,) sum of all other wrenches on the tool, its weight among them. Defaults to zero.

        Returns:
            The wrench (6,) on the handle in the base frame at the period's beginning, and its slopes K and B (6, 6), those of coupling and contact in series: the wrench changes by -K δ - B ΔV as the handle moves on.

        Raises:
            ValueError: A value is not finite, or not a pose; the tool stays where it was.
        """

class ContactServoStatus:
    """Counters and state of a `ContactServo`, counted from the start."""

    @property
    def num_solved(self) -> int:
        """Number of periods in which contact was solved."""

    @property
    def num_late(self) -> int:
        """
        Number of periods that were overrun: the servo went on with the linear wrench of the last one.
        """

    @property
    def num_refused(self) -> int:
        """Number of handle states that were not poses."""

    @property
    def is_running(self) -> bool:
        """Whether the thread runs."""

class ContactServo:
    """
    A thread that solves contact for a `UdpServo`, in each period with the device's newest handle state, and publishes the local wrench to it, which nothing else may do then. It runs without Python; only `close` waits for it. Only one thread of the program may use it.
    """

    def __init__(self, servo: UdpServo, tool: ServoTool) -> None:
        """
        Starts the thread, which waits for the first `renew`.

        Args:
            servo: Servo that answers the device.
            tool: Tool, which is copied.
        """

    def renew(self, gains: CouplingGains, F_applied_To_W: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> None:
        """
        Says that the loop goes on, and sets the coupling and the sum (6,) of the other wrenches on the tool at To in W, its weight among them. If this is not called in time, the servo releases the force by its law.
        """

    def set_share(self, share: float) -> None:
        """
        Sets the share of the wrench that is shown, 0 to 1, from the next `renew` on.
        """

    @property
    def tool_state(self) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """(13,) newest pose and velocity of the tool in the world."""

    def status(self) -> ContactServoStatus:
        """Returns a `ContactServoStatus`."""

    def close(self) -> None:
        """Ends the thread, within a period. May be called again."""

def run_tool_loop(tool: ConvexPieces, objects: Sequence[ConvexPieces], q_WO: Annotated[NDArray[numpy.float64], dict(shape=(None, 7), order='C')], tolerance: float, dynamics: RigidToolDynamics, gains: CouplingGains, q_HT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], stiffness: float, damping: float, h: float, handle: Annotated[NDArray[numpy.float64], dict(shape=(None, 13), order='C')], start: Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 13), order='C')], Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]]:
    """
    Computes a haptic loop without effects, tick after tick, without Drake and without the GIL: query, shared stiffness, penalty force, coupling, and the tool's implicit step.

    Args:
        tool, objects: pieces of the tool and of each object; the objects rest.
        q_WO: (m, 7) poses [qw qx qy qz x y z] of the objects.
        tolerance: distance up to which contacts push, m.
        dynamics, gains, q_HT: inertia of the tool, gains of its coupling, and its pose (7,) in the handle.
        stiffness, damping: gains of every contact, N/m and N·s/m.
        h: duration of a tick, s.
        handle: (n, 13) pose (7) and spatial velocity (6) of the handle at each tick.
        start: (13,) pose and spatial velocity of the tool before the first tick.

    Returns:
        The tool's state (n, 13) after each tick; the number of contacts (n,) and the smallest distance (n,), m, at its beginning, the tolerance without contacts; and the time (n,) that the tick took, s.

    Raises:
        ValueError: poses or gains are out of range.
    """

class ContactChain(SceneTracker):
    """
    A `SceneTracker` that also computes the motion of a tool on a coupling under its contacts: query, clusters, penalty force, coupling and the tool's step in one call. It keeps its last results, so that another query of the same pose costs nothing.
    """

    def __init__(self, tracker: SceneTracker) -> None:
        """Goes on from the state of a tracker, which stays as it is."""

    def set_law(self, tolerance: float, delta: float | None, objects: ObjectFrames, materials: ContactMaterials, shading: ContactShading | None = None) -> None:
        """
        Sets the law by which contacts push.

        Args:
            tolerance: distance below which contacts push, m.
            delta: size of the octree's cells, m; None lets contacts share stiffness.
            objects: frames of the objects, which rest.
            materials: materials of the objects.
            shading: `ContactShading` of the normals; None for none.
        """

    def query(self, X_WT: drake_haptics.common.pose_like.PoseLike, tolerance: float | None = None) -> ContactSet:
        """
        As `SceneTracker.query`, but for a pose vector (7,) equal to the last one the last results are returned.
        """

    def step_tool(self, joined: Annotated[NDArray[numpy.float64], dict(shape=(39), order='C')], dynamics: RigidToolDynamics, h: float, others: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]]) -> Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]:
        """
        The tool's next state (13,): `RigidToolDynamics.step` under the coupling, the contacts and other wrench models, in this order.

        Args:
            joined: argument of `joined_coupling_wrench`.
            dynamics: inertia of the tool.
            h: duration of the step, s.
            others: other wrench models (78,).

        Raises:
            ValueError: a pose is not finite, or a gain is out of range.
        """

    def find_force(self, X_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """
        The wrench (6,) [torque; force] of the contacts on the tool at To, N·m and N, at its pose (7,) and spatial velocity (6,).
        """

    def find_coupled_force(self, joined: Annotated[NDArray[numpy.float64], dict(shape=(39), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]:
        """
        The sum of that wrench and the coupling's, for the argument of `joined_coupling_wrench`.
        """

    def find_friction(self, friction: StickSlipModel, state: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], X_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> FrictionStep:
        """
        The friction of the contacts, as `StickSlipModel.step` of their clusters and wrench.

        Args:
            friction: friction with the chain's objects, which rest.
            state: (n,) state from the last tick.
            X_WT: (7,) pose of the tool.
            V_WT: (6,) its spatial velocity.

        Raises:
            ValueError: a size does not match, or an object moves.
        """

    def find_braking(self, gains: BrakingGains, X_WT: Annotated[NDArray[numpy.float64], dict(shape=(7), order='C')], V_WT: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]:
        """
        The wrench model (78,) of `pre_contact_braking` on the tool, whose pose (7,) and spatial velocity (6,) are given.
        """

    @property
    def deepest(self) -> tuple[float, float]:
        """
        Least distance of the contacts that were found last (m, infinite without any), and the distance below which they push, m.
        """

    def summarize(self, state: Annotated[NDArray[numpy.float64], dict(shape=(13), order='C')]) -> tuple[int, int, float, float]:
        """
        Numbers of contacts and of clusters, the least distance (m, infinite without contacts) and the time of the query (s), for the tool in a state (13,).
        """

    def handle_slopes(self, joined: Annotated[NDArray[numpy.float64], dict(shape=(39), order='C')], others: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(78), order='C')]]) -> Annotated[NDArray[numpy.float64], dict(shape=(72), order='C')]:
        """
        `handle_slopes` (72,) of the coupling and of the contacts plus other wrench models, for the arguments of `step_tool`.
        """

    def __deepcopy__(self, arg: object, /) -> ContactChain: ...

    def __copy__(self) -> ContactChain: ...

def contact_set(distance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')], nhat_BA_W: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')], p_WCa: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')], p_WCb: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')], object_index: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C')]) -> ContactSet:
    """
    Contacts that another library found, for the laws of this one. They have no extent and no features: derivatives, force shading and ticks without a query, which need to know how a contact moves, refuse them with a ValueError.

    Args:
        distance: (n,) signed distances, m.
        nhat_BA_W: (n, 3) unit normals out of the object into the tool.
        p_WCa, p_WCb: (n, 3) witness points on the tool and on the object, m.
        object_index: (n,) int32, in ascending order.

    Raises:
        ValueError: the columns do not match or are not ordered, a number is not finite, a normal is not of unit length, or an index is negative.
    """

def make_witness_override() -> Callable[[object], list]:
    """
    Returns the `DoGetWitnessFunctions` of a system without witness functions. It is a built-in function, which pybind11 does not take for an override in Python: it remembers that the class has none, and does not look again.
    """
