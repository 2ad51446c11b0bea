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
      "and wrenches. What of it is for programs of your own has its name in "
      "drake_haptics; the rest is the engine behind it.";
  // Drake keeps the Python systems of a Diagram alive until the interpreter is
  // gone, and with them what they hold of ours: no leak, but reported as one.
  // Whoever looks for leaks of ours asks for reports.
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
  drake_haptics::BindGravity(m);
  drake_haptics::BindPassivity(m);
  drake_haptics::BindHand(m);
  drake_haptics::BindEnergy(m);
  drake_haptics::BindClock(m);
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
      "functions. It is a built-in function: pybind11 takes one for none of "
      "Python, keeps in mind that the class overrides nothing, and asks no "
      "more.");
}
