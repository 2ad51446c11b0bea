"""The public names of the geometry, each with the module that defines it."""

from .contacts import Contact as Contact
from .contacts import ContactSet as ContactSet
from .contacts import ContactStatus as ContactStatus
from .contacts import ContactTracker as ContactTracker
from .contacts import ContactTrajectory as ContactTrajectory
from .contacts import ConvexPair as ConvexPair
from .contacts import ConvexPolytope as ConvexPolytope
from .contacts import Feature as Feature
from .contacts import FeatureKind as FeatureKind
from .contacts import PairTrajectory as PairTrajectory
from .contacts import RigidToolDynamics as RigidToolDynamics
from .contacts import SceneTracker as SceneTracker
from .decomposition.decompose import Decomposition as Decomposition
from .decomposition.decompose import decompose as decompose
from .decomposition.report import DecompositionReport as DecompositionReport
from .decomposition.viewer import DecompositionViewer as DecompositionViewer
from .mesh.decimation import decimate as decimate
from .mesh.mesh import Component as Component
from .mesh.mesh import Mesh as Mesh
from .mesh.mesh import calc_mass_properties as calc_mass_properties
from .mesh.mesh import load_mesh as load_mesh
from .mesh.mesh import make_tool_dynamics as make_tool_dynamics
from .mesh.placement import center as center
from .mesh.report import Finding as Finding
from .mesh.report import MeshReport as MeshReport
from .mesh.report import Severity as Severity
