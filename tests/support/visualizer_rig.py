"""A visualizer that draws into a page that only keeps its messages."""

# ruff: noqa: D102 - the methods of the fake are documented by Drake.
from types import SimpleNamespace

import numpy as np
from pydrake.common.value import Value
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.output.haptic_picture import HapticPicture
from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer


class FakeMeshcat:
    """Keeps the messages that it gets, like a browser, and when they came."""

    def __init__(self, connections=1):
        self.connections = connections
        self.objects = set()
        self.transforms = {}
        self.properties = {}
        self.recording = False
        self.frames = []

    def SetTriangleMesh(self, path, vertices, faces, rgba):
        assert vertices.shape[0] == 3 and faces.max() < vertices.shape[1]
        self.objects.add(path)

    def SetTriangleColorMesh(self, path, vertices, faces, colors):
        assert vertices.shape == colors.shape and faces.max() < vertices.shape[1]
        self.objects.add(path)

    def Delete(self, path):
        self.objects = {
            p for p in self.objects if p != path and not p.startswith(f"{path}/")
        }

    def SetObject(self, path, shape, rgba):
        self.objects.add(path)

    def SetTransform(self, path, X_ParentPath, time_in_recording=None):
        self.transforms[path] = X_ParentPath
        # As the page does: a pose is position, rotation and a scale of 1.
        self.properties.pop((path, "scale"), None)
        self._record(path, "transform", X_ParentPath, time_in_recording)

    def SetProperty(self, path, name, value, time_in_recording=None):
        self.properties[path, name] = value
        self._record(path, name, value, time_in_recording)

    def _record(self, path, name, value, time):
        if self.recording and time is not None:
            self.frames.append((time, path, name, value))

    def StartRecording(self, frames_per_second):
        self.frames_per_second = frames_per_second
        self.recording = True

    def StopRecording(self):
        self.recording = False

    def GetNumActiveConnections(self):
        return self.connections

    def SetSimulationTime(self, time):
        pass

    def visible(self, folder):
        """Paths of the arrows in a folder that are to be seen."""
        return sorted(
            path
            for (path, name), value in self.properties.items()
            if name == "visible" and value and path.startswith(f"{folder}/")
        )


class Frozen(SimpleNamespace):
    """A value of an abstract port, as the core's are."""

    def __deepcopy__(self, memo):
        return self

    def __len__(self):
        return len(self.distance)


def make_contacts(distance, nhat=(0, 0, 1.0)):
    n = len(distance)
    return Frozen(
        distance=np.array(distance, dtype=float),
        nhat_BA_W=np.tile(nhat, (n, 1)),
        p_WC=np.arange(3.0 * n).reshape(n, 3),
        object_index=np.zeros(n, dtype=np.int32),
        piece_A=np.arange(n, dtype=np.int32),
        piece_B=np.zeros(n, dtype=np.int32),
    )


def make_mesh(size=0.1):
    corners = size * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.int32)
    # A tetrahedron of which one facet is not on the mesh.
    piece = SimpleNamespace(
        vertices=corners,
        facets=faces.tolist(),
        facet_original=[True, True, True, False],
        dimension=3,
    )
    return SimpleNamespace(vertices=corners, triangles=faces, pieces=[piece])


X_HT = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [0.01, 0.02, 0.03])
X_WH = RigidTransform(RollPitchYaw(-0.5, 0.0, 0.7), [0.1, 0.0, 0.2])


MAX_FORCE_N, MAX_TORQUE_NM = 4.0, 0.5


def make_visualizer(meshcat, objects=(), *, tick_s=1 / 1024, **options):
    limits = {"max_force_N": MAX_FORCE_N, "max_torque_Nm": MAX_TORQUE_NM, **options}
    return HapticVisualizer(meshcat, make_mesh(), objects, X_HT, tick_s, **limits)


def make_picture(meshcat):
    """Returns the picture that a visualizer draws with."""
    limits = {"max_force_N": MAX_FORCE_N, "max_torque_Nm": MAX_TORQUE_NM}
    return HapticPicture(
        meshcat, make_mesh(), [], RigidTransform(), **limits, has_friction=False
    )


def make_context(
    visualizer,
    contacts=(),
    forces=None,
    X_WT=X_WH @ X_HT,
    f_H_W=(0, 0, 0),
    tau_H_W=(0, 0, 0),
):
    context = visualizer.CreateDefaultContext()
    values = {
        "X_WH": pose_to_vector(X_WH),
        "X_WT": pose_to_vector(X_WT),
        "F_Ho_W_commanded": np.array([*tau_H_W, *f_H_W], dtype=float),
        "contacts": Value(make_contacts(contacts)),
        "clusters": Value(make_contacts(contacts)),
        "contact_wrench": Value(
            Frozen(
                f_cluster_W=np.array(
                    forces if forces is not None else [(0, 0, 1.0)] * len(contacts)
                ).reshape(-1, 3)
            )
        ),
    }
    for name, value in values.items():
        visualizer.GetInputPort(name).FixValue(context, value)
    return context
