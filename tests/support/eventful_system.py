"""A system with the events that a test names."""

from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector_, LeafSystem_, ValueProducer
from pydrake.systems.scalar_conversion import TemplateSystem
from wall_loop import PERIOD


@TemplateSystem.define("Eventful_", T_list=(float, AutoDiffXd))
def Eventful_(T):
    class Impl(LeafSystem_[T]):
        """A memory of one number, halved every period, and the events named."""

        def _construct(self, *events, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.events = events
            self.published = []
            self.DeclareDiscreteState([0.0])
            self.DeclareNumericParameter(BasicVector_[T]([0.5]))
            self.DeclareAbstractParameter(Value("any"))
            self.DeclareCacheEntry(
                "cache", ValueProducer(lambda: Value(0), ValueProducer.NoopCalc)
            )
            self.DeclareStateOutputPort("x", self.DeclareDiscreteState([0.0]))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._halve)
            add = {
                "offset": lambda: self.DeclarePeriodicDiscreteUpdateEvent(
                    PERIOD, 0.5 * PERIOD, self._halve
                ),
                "second period": lambda: self.DeclarePeriodicDiscreteUpdateEvent(
                    2 * PERIOD, 0.0, self._halve
                ),
                "step": lambda: self.DeclarePerStepDiscreteUpdateEvent(self._halve),
                "unrestricted": lambda: self.DeclarePeriodicUnrestrictedUpdateEvent(
                    3.0, 0.0, self._keep
                ),
                "unrestricted offset": lambda: (
                    self.DeclarePeriodicUnrestrictedUpdateEvent(
                        3.0, 0.5 * PERIOD, self._keep
                    )
                ),
                "unrestricted step": lambda: self.DeclarePerStepUnrestrictedUpdateEvent(
                    self._keep
                ),
                "abstract state": lambda: self.DeclareAbstractState(Value("any")),
                "publish": lambda: self.DeclarePeriodicPublishEvent(
                    0.7 * PERIOD, 0.0, self._publish
                ),
                "publish step": lambda: self.DeclarePerStepPublishEvent(self._publish),
                "initialize": lambda: self.DeclareInitializationDiscreteUpdateEvent(
                    self._halve
                ),
            }
            for event in events:
                add[event]()

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, *other.events, converter=converter)

        def _halve(self, context, discrete_state):
            rate = context.get_numeric_parameter(0)[0]
            x = context.get_discrete_state(0)[0]
            discrete_state.get_mutable_vector(0).SetAtIndex(0, x * rate)

        def _keep(self, context, state):
            pass

        def _publish(self, context):
            self.published.append(context.get_time())

    return Impl


Eventful = Eventful_[None]
