"""A device whose handle is a mass that slides along z."""

from pydrake.systems.framework import LeafSystem

from drake_haptics.systems.device.haptic_device import HapticDevice

PERIOD = 1e-3
MASS, DAMPING = 0.1, 0.5


class Slider(LeafSystem):
    """A mass with viscous damping that moves along z: the simplest backend."""

    def __init__(self):
        super().__init__()
        self.set_name("slider")
        self._F = self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self.DeclareContinuousState(1, 1, 0)
        from_state = {self.all_state_ticket()}
        self.DeclareVectorOutputPort("X_WH", 7, self._calc_pose, from_state)
        self.DeclareVectorOutputPort("V_WH", 6, self._calc_velocity, from_state)

    def _state(self, context):
        return context.get_continuous_state_vector().CopyToVector()

    def _calc_pose(self, context, output):
        output.SetFromVector([1, 0, 0, 0, 0, 0, self._state(context)[0]])

    def _calc_velocity(self, context, output):
        output.SetFromVector([0, 0, 0, 0, 0, self._state(context)[1]])

    def DoCalcTimeDerivatives(self, context, derivatives):
        """Overrides Drake's."""
        v = self._state(context)[1]
        f = self._F.Eval(context)[5]
        derivatives.get_mutable_vector().SetFromVector([v, (f - DAMPING * v) / MASS])


def make_device():
    return HapticDevice(Slider(), period_s=PERIOD, max_force_N=8.5, max_torque_Nm=0.188)
