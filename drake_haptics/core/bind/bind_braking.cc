#include <stdexcept>

#include "bind/bind.h"
#include "bind/bind_autodiff_set.h"
#include "bind/bind_objects.h"
#include "law/braking.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

Eigen::VectorXd Brake(const ContactSet& contacts, const Vec3& p_WTo,
                      const Vec6& V_WT, const ObjectFrames& objects,
                      const BrakingGains& gains) {
  return ToVector(ComputeBraking<double>(contacts.contacts, {p_WTo, V_WT},
                                         objects.frames, gains));
}

AutoDiffVector DifferentiateBraking(const AutoDiffContactSet& contacts,
                                    const AutoDiffVector& p_WTo,
                                    const AutoDiffVector& V_WT,
                                    const AutoDiffVector& p_WO,
                                    const AutoDiffVector& V_WO,
                                    const BrakingGains& gains) {
  const Eigen::Index count = p_WO.size() / 3;
  if (p_WO.size() != 3 * count || V_WO.size() != 6 * count) {
    throw std::invalid_argument(
        "p_WO and V_WO must have 3 and 6 numbers for each object");
  }
  return ToAutoDiffVector(
      ToVector(ComputeBraking<AutoDiff>(
          contacts.set.contacts,
          {ToScalars<3>(p_WTo, "p_WTo"), ToScalars<6>(V_WT, "V_WT")},
          FramesOf(p_WO, V_WO), gains)),
      contacts.num_derivatives);
}

}  // namespace

void BindBraking(nb::module_& m) {
  nb::class_<BrakingGains>(m, "BrakingGains",
                           "Viscous braking before surfaces touch.")
      .def(
          "__init__",
          [](BrakingGains* self, double damping, double distance) {
            const BrakingGains gains{damping, distance};
            RequirePossible(gains);
            new (self) BrakingGains(gains);
          },
          nb::arg("damping_Ns_per_m"), nb::arg("distance_m"),
          "Args:\n"
          "    damping_Ns_per_m: damping b half-way to the surface, N·s/m.\n"
          "    distance_m: distance D at which braking begins, m.\n\n"
          "Raises:\n"
          "    ValueError: b < 0, D <= 0, or one of them is not finite.");
  m.def("pre_contact_braking", &Brake, nb::arg("contacts"), nb::arg("p_WTo"),
        nb::arg("V_WT"), nb::arg("objects"), nb::arg("gains"),
        "Brakes the approach of surfaces that do not touch yet (McNeely, "
        "Puterbaugh and Troy 1999): at each contact with 0 < d < D a force b s "
        "w v along its normal, with the speed of approach v, w = 4 (d/D)(1 − "
        "d/D) and its share s among contacts with like normals (braking.h). It "
        "never pulls.\n\n"
        "Args:\n"
        "    p_WTo: (3,) origin of the tool, m.\n"
        "    V_WT: (6,) spatial velocity of the tool [rad/s; m/s].\n"
        "    objects: frames of the objects.\n\n"
        "Returns:\n"
        "    (78 + 6 m,) wrench model on the tool at To in W: [F (6); K (36), "
        "zero; B (36, by rows)], rotational first; then the wrench on each "
        "object at its origin in W, N·m and N.\n\n"
        "Raises:\n"
        "    IndexError: a contact names an object that is not given.");
  m.def("pre_contact_braking", &DifferentiateBraking, nb::arg("contacts"),
        nb::arg("p_WTo"), nb::arg("V_WT"), nb::arg("p_WO"), nb::arg("V_WO"),
        nb::arg("gains"),
        "The same with derivatives; p_WO (3 m,) and V_WO (6 m,) have one "
        "object after another.");
}

}  // namespace drake_haptics
