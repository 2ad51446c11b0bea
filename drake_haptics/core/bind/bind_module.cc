#include <cstdlib>

#include "bind/bind.h"
#include "bind/bind_eigen.h"

void drake_haptics::ImportNumpy() {
  // They live as long as the process.
  const auto numpy = nanobind::module_::import_("numpy");
  numpy_functions = {
      nanobind::object(numpy.attr("asarray")).release().ptr(),
      nanobind::object(numpy.attr("empty")).release().ptr(),
  };
}

namespace {

PyObject* MakeEmptyList(PyObject*, PyObject*) { return PyList_New(0); }

PyMethodDef get_no_witness_functions = {"get_no_witness_functions",
                                        &MakeEmptyList, METH_O, nullptr};

}  // namespace

NB_MODULE(_core, m) {
  m.doc() =
      "The compiled core of drake_haptics: geometry, contact query, clustering "
      "and wrenches. The parts for your own programs have names in "
      "drake_haptics; the rest is the engine behind them.";
  // Drake keeps the Python systems of a Diagram alive until the interpreter is
  // gone, and with them the core's objects that they hold. That is not a leak,
  // but would be reported as one. To look for leaks of the core, set the
  // variable.
  nanobind::set_leak_warnings(std::getenv("DRAKE_HAPTICS_LEAK_WARNINGS") !=
                              nullptr);
  drake_haptics::ImportNumpy();
  drake_haptics::BindAutoDiff(m);
  drake_haptics::BindPolytope(m);
  drake_haptics::BindDecomposition(m);
  drake_haptics::BindContact(m);
  drake_haptics::BindConvexPair(m);
  drake_haptics::BindTracker(m);
  drake_haptics::BindAdvance(m);
  drake_haptics::BindClustering(m);
  drake_haptics::BindPenaltyForce(m);
  drake_haptics::BindTool(m);
  drake_haptics::BindConstraintStep(m);
  drake_haptics::BindAutoDiffContact(m);
  drake_haptics::BindAutoDiffForce(m);
  drake_haptics::BindShading(m);
  drake_haptics::BindFriction(m);
  drake_haptics::BindBraking(m);
  drake_haptics::BindPassivity(m);
  drake_haptics::BindHand(m);
  drake_haptics::BindEnergy(m);
  drake_haptics::BindPackets(m);
  drake_haptics::BindGate(m);
  drake_haptics::BindServo(m);
  drake_haptics::BindContactServo(m);
  drake_haptics::BindToolLoop(m);
  drake_haptics::BindContactChain(m);
  drake_haptics::BindForeignContacts(m);
  m.def(
      "make_witness_override",
      [] {
        return nanobind::steal(
            PyCFunction_New(&get_no_witness_functions, nullptr));
      },
      nanobind::sig("def make_witness_override() -> "
                    "collections.abc.Callable[[object], list]"),
      "Returns the `DoGetWitnessFunctions` of a system without witness "
      "functions. It is a built-in function, which pybind11 does not take for "
      "an override in Python: it remembers that the class has none, and does "
      "not look again.");
}
