"""Finds contacts between convex pieces by the compiled core, without Drake."""

from drake_haptics._core import Contact as Contact
from drake_haptics._core import ContactSet as ContactSet
from drake_haptics._core import ContactStatus as ContactStatus
from drake_haptics._core import ContactTracker as ContactTracker
from drake_haptics._core import ContactTrajectory as ContactTrajectory
from drake_haptics._core import ConvexPair as ConvexPair
from drake_haptics._core import ConvexPolytope as ConvexPolytope
from drake_haptics._core import Feature as Feature
from drake_haptics._core import FeatureKind as FeatureKind
from drake_haptics._core import PairTrajectory as PairTrajectory
from drake_haptics._core import RigidToolDynamics as RigidToolDynamics
from drake_haptics._core import SceneTracker as SceneTracker
