#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "bind.h"
#include "bind_columns.h"
#include "bind_eigen.h"
#include "clustering.h"
#include "contact_thinning.h"
#include "penalty_force.h"
#include "shared_stiffness.h"
#include "wrench_model.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

template <typename Rows, typename Item>
Rows ToRowMatrix(const std::vector<Item>& items) {
  Rows rows(items.size(), Rows::ColsAtCompileTime);
  for (std::size_t i = 0; i < items.size(); ++i) {
    rows.row(i) = items[i].transpose();
  }
  return rows;
}

void BindClustering(nb::module_& m) {
  nb::class_<ClusterSet> set(
      m, "ClusterSet",
      "Representative contacts of one tick, as read-only columns over k "
      "clusters. Immutable; copies are the object itself.");
  set.def("__len__", [](const ClusterSet& s) { return s.clusters.size(); });
  set.def("__repr__", [](const ClusterSet& s) {
    return nb::str("ClusterSet({} of {})")
        .format(Counted(s.clusters.size(), "cluster"),
                Counted(s.label.size(), "contact"));
  });
  constexpr auto kItems = &ClusterSet::clusters;
  DefColumn<kItems, &Cluster::distance>(
      &set, "distance", "(k,) smallest distance of the members (Eq. 5), m.");
  DefColumn<kItems, &Cluster::nhat_BA_W>(
      &set, "nhat_BA_W", "(k, 3) weighted mean directions (Eq. 3), unit.");
  DefColumn<kItems, &Cluster::p_WC>(
      &set, "p_WC", "(k, 3) weighted mean positions (Eq. 4), m.");
  DefColumn<kItems, &Cluster::compression>(
      &set, "compression",
      "(k,) m; the elastic force of a cluster is the stiffness times this.");
  DefColumn<kItems, &Cluster::damping_share>(
      &set, "damping_share",
      "(k,) the damping force is the damping times the speed of approach times "
      "this.");
  DefColumn<kItems, &Cluster::object>(&set, "object_index",
                                      "(k,) object of each cluster.");
  DefColumn<kItems, &Cluster::num_contacts>(&set, "num_contacts",
                                            "(k,) members.");
  DefNumbers<&ClusterSet::label>(
      &set, "label", "(n,) cluster of each contact; -1 beyond the tolerance.");
  set.def_prop_ro(
      "coupling",
      [](const ClusterSet& s) -> Eigen::MatrixXd {
        const auto count = static_cast<Eigen::Index>(s.clusters.size());
        return Eigen::MatrixXd::NullaryExpr(
            count, count,
            [&](Eigen::Index i, Eigen::Index j) { return s.coupling(i, j); });
      },
      "(k, k) derivative of `compression` by the depths tolerance − distance; "
      "symmetric, positive semidefinite.");
  DefFrozenCopy(&set);
  m.def(
      "thin_contacts",
      [](const ContactSet& contacts, double cell) {
        ContactSet thinned{{}, contacts.query_seconds};
        ThinContacts(contacts.contacts, cell, &thinned.contacts);
        return thinned;
      },
      nb::arg("contacts"), nb::arg("cell"),
      "Leaves out contacts that a deeper one of the same object, nearer than "
      "`cell` (m) and with a normal that differs by less than 45°, stands for. "
      "It takes over their extents; 0 leaves nothing out.\n\n"
      "Raises:\n    ValueError: cell < 0.");
  m.def(
      "cluster_contacts",
      [](const ContactSet& contacts, double delta, double tolerance) {
        ClusterSet clusters;
        ClusterContacts(contacts.contacts, delta, tolerance, &clusters);
        return clusters;
      },
      nb::arg("contacts"), nb::arg("delta"), nb::arg("tolerance"),
      "Groups contacts nearer than `tolerance` (m) with an octree of leaf size "
      "`delta` (m) and represents each group by one contact (paper, 4.2, Eq. 1 "
      "to 5). Members weigh `tolerance` − distance.\n\n"
      "Raises:\n    ValueError: delta <= 0 or tolerance < 0.");
  m.def(
      "share_stiffness",
      [](const ContactSet& contacts, double tolerance) {
        ClusterSet clusters;
        ShareStiffness(contacts.contacts, tolerance, &clusters);
        return clusters;
      },
      nb::arg("contacts"), nb::arg("tolerance"),
      "Makes each contact nearer than `tolerance` (m) a cluster of its own, "
      "and lets those along one direction share stiffness, as if they pressed "
      "into a common elastic skin: the force is a continuous function of the "
      "contacts (shared_stiffness.h).\n\n"
      "Raises:\n    ValueError: tolerance < 0.");
}

void BindPenaltyForce(nb::module_& m) {
  nb::class_<PenaltyWrench> wrench(
      m, "PenaltyWrench",
      "The wrenches of all clusters. Immutable; copies are the object itself.");
  wrench.def("__repr__", [](const PenaltyWrench& w) {
    return nb::str("PenaltyWrench({:.4g} N and {:.4g} N·m on the tool)")
        .format(w.tool.F.tail<3>().norm(), w.tool.F.head<3>().norm());
  });
  wrench.def_prop_ro(
      "wrench_model", [](const PenaltyWrench& w) { return ToVector(w.tool); },
      "(78,) wrench on the tool at To in W with its linear model: [F (6); K "
      "(36, by rows); B (36, by rows)], rotational first.");
  wrench.def_prop_ro(
      "F_Tool_W", [](const PenaltyWrench& w) { return w.tool.F; },
      "(6,) wrench on the tool at To, [N·m; N].");
  wrench.def_prop_ro(
      "F_objects_W",
      [](const PenaltyWrench& w) { return ToRowMatrix<Rows6>(w.F_objects_W); },
      "(m, 6) wrench on each object at its origin, [N·m; N].");
  wrench.def_prop_ro(
      "f_cluster_W",
      [](const PenaltyWrench& w) { return ToRowMatrix<Rows3>(w.f_cluster_W); },
      "(k, 3) force of each cluster on the tool, N.");
  DefFrozenCopy(&wrench);
  m.def(
      "penalty_force",
      [](const ClusterSet& clusters, const Vec3& p_WTo, const Vec6& V_WTool,
         const Rows3& p_WO, const Rows6& V_WO, const Eigen::VectorXd& stiffness,
         const Eigen::VectorXd& damping) {
        if (p_WO.rows() != V_WO.rows() || p_WO.rows() != stiffness.size() ||
            p_WO.rows() != damping.size()) {
          throw std::invalid_argument(
              "p_WO, V_WO, stiffness and damping must have one row for each "
              "object");
        }
        std::vector<MovingFrame> objects;
        std::vector<ContactMaterial> materials;
        for (Eigen::Index i = 0; i < p_WO.rows(); ++i) {
          objects.push_back({p_WO.row(i), V_WO.row(i)});
          materials.push_back({stiffness[i], damping[i]});
        }
        return ComputePenaltyWrench(clusters, {p_WTo, V_WTool}, objects,
                                    materials);
      },
      nb::arg("clusters"), nb::arg("p_WTo"), nb::arg("V_WTool"),
      nb::arg("p_WO"), nb::arg("V_WO"), nb::arg("stiffness"),
      nb::arg("damping"),
      "Penalty wrenches of the clusters (paper, Eq. 6 to 10): k times the "
      "compression along the normal, plus damping while approaching; never a "
      "pull.\n\n"
      "Args:\n"
      "    p_WTo: (3,) tool's origin, m.\n"
      "    V_WTool: (6,) its spatial velocity [rad/s; m/s].\n"
      "    p_WO: (m, 3) objects' origins, m.\n"
      "    V_WO: (m, 6) their spatial velocities.\n"
      "    stiffness: (m,) k of each object, N/m.\n"
      "    damping: (m,) k_v of each object, N·s/m.\n\n"
      "Raises:\n"
      "    ValueError: a gain is negative or not finite, or rows do not "
      "match.\n"
      "    IndexError: a cluster names an object that has no row.");
}

}  // namespace

void BindForce(nb::module_& m) {
  BindClustering(m);
  BindPenaltyForce(m);
}

}  // namespace drake_haptics
