#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "base/rotation.h"
#include "bind/bind.h"
#include "bind/bind_columns.h"
#include "bind/bind_eigen.h"
#include "law/wrench_jacobian.h"
#include "pair/contact.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
using Rows7 = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;

// The matrices of all objects below each other: (6 m, 6).
Rows6 Stack(const std::vector<Mat6>& matrices) {
  Rows6 rows(6 * matrices.size(), 6);
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    rows.middleRows<6>(6 * i) = matrices[i];
  }
  return rows;
}

WrenchJacobian Compute(const ContactSet& contacts, const ClusterSet& clusters,
                       double tolerance, const Decomposition& tool,
                       const PoseVector& X_WT, const Vec6& V_WT,
                       const std::vector<const Decomposition*>& objects,
                       const Rows7& X_WO, const Rows6& V_WO,
                       const Eigen::VectorXd& stiffness,
                       const Eigen::VectorXd& damping) {
  const auto count = static_cast<Eigen::Index>(objects.size());
  if (X_WO.rows() != count || V_WO.rows() != count ||
      stiffness.size() != count || damping.size() != count) {
    throw std::invalid_argument(
        "X_WO, V_WO, stiffness and damping must have one row for each object");
  }
  std::vector<MovingShape> shapes;
  std::vector<ContactMaterial> materials;
  for (Eigen::Index i = 0; i < count; ++i) {
    shapes.push_back({objects[i],
                      PoseFromVector(X_WO.row(i).transpose(), "X_WO"),
                      V_WO.row(i).transpose()});
    materials.push_back({stiffness[i], damping[i]});
    RequireMaterial(materials.back());
  }
  return ComputeWrenchJacobian(contacts.contacts, clusters, tolerance,
                               {&tool, PoseFromVector(X_WT, "X_WT"), V_WT},
                               shapes, materials);
}

}  // namespace

void BindJacobian(nb::module_& m) {
  nb::class_<WrenchJacobian> jacobian(
      m, "WrenchJacobian",
      "Derivatives of the contact wrench on the tool at To, [N·m; N], by "
      "displacements [rotation vector (rad); translation (m)] and velocities "
      "[rad/s; m/s] of the bodies about their origins, all in the world. "
      "Immutable.");
  jacobian.def_ro("by_X_WT", &WrenchJacobian::by_X_WT, "(6, 6).")
      .def_ro("by_V_WT", &WrenchJacobian::by_V_WT, "(6, 6).")
      .def_prop_ro(
          "by_X_WO",
          [](const WrenchJacobian& self) { return Stack(self.by_X_WO); },
          "(6 m, 6): (6, 6) for each object, one below the other.")
      .def_prop_ro(
          "by_V_WO",
          [](const WrenchJacobian& self) { return Stack(self.by_V_WO); },
          "(6 m, 6): (6, 6) for each object, one below the other.");
  m.def("wrench_jacobian", &Compute, nb::arg("contacts"), nb::arg("clusters"),
        nb::arg("tolerance"), nb::arg("tool"), nb::arg("X_WT"), nb::arg("V_WT"),
        nb::arg("objects"), nb::arg("X_WO"), nb::arg("V_WO"),
        nb::arg("stiffness"), nb::arg("damping"),
        "Exact derivatives of `penalty_force` through the whole chain from the "
        "poses on: contacts, clusters, forces. Features stay as they are, and "
        "which contacts are together or push (wrench_jacobian.h).\n\n"
        "Args:\n"
        "    contacts: as the query gave them at these poses.\n"
        "    clusters: of them, by `cluster_contacts` or `share_stiffness`.\n"
        "    tolerance: what the clusters were made with, m.\n"
        "    tool, objects: the bodies of the query.\n"
        "    X_WT, X_WO: (7,) and (m, 7) poses [qw qx qy qz x y z].\n"
        "    V_WT, V_WO: (6,) and (m, 6) spatial velocities [rad/s; m/s].\n"
        "    stiffness, damping: (m,) k and k_v of each object, N/m and "
        "N·s/m.\n\n"
        "Raises:\n"
        "    ValueError: a pose is not one, or rows do not match.\n"
        "    IndexError: a contact names an object or a piece that is not "
        "given.");
}

}  // namespace drake_haptics
