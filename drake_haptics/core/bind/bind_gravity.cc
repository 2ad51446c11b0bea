#include "base/autodiff.h"
#include "bind/bind.h"
#include "bind/bind_eigen.h"
#include "law/tool_gravity.h"

namespace nb = nanobind;

namespace drake_haptics {

void BindGravity(nb::module_& m) {
  m.def("tool_weight", &ToolWeight<double>, nb::arg("q_WT"), nb::arg("p_TTcm"),
        nb::arg("weight_W"),
        "Weight of the tool, a force at its center of mass.\n\n"
        "Args:\n"
        "    q_WT: (7,) pose [qw qx qy qz x y z].\n"
        "    p_TTcm: (3,) center of mass in the tool's frame, m.\n"
        "    weight_W: (3,) mass times gravity, N.\n\n"
        "Returns:\n"
        "    (6,) wrench on the tool at To in W, [N·m; N].");
  m.def(
      "tool_weight",
      [](const AutoDiffVector& q_WT, const Vec3& p_TTcm, const Vec3& weight_W) {
        return ToAutoDiffVector(
            ToolWeight(ToScalars<7>(q_WT, "q_WT"), p_TTcm, weight_W),
            q_WT.num_derivatives());
      },
      nb::arg("q_WT"), nb::arg("p_TTcm"), nb::arg("weight_W"),
      "The same with derivatives.");
}

}  // namespace drake_haptics
