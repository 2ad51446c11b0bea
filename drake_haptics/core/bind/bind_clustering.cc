#include "bind/bind.h"
#include "bind/bind_columns.h"
#include "law/clustering.h"
#include "law/contact_thinning.h"
#include "law/shared_stiffness.h"

namespace nb = nanobind;

namespace drake_haptics {

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
  set.def_ro("is_bounded", &ClusterSet::is_bounded,
             "Whether the search for the compressions reached its bound on "
             "steps: they push, but are not quite those of least energy.");
  DefFrozenCopy(&set);
  m.def(
      "thin_contacts",
      [](const ContactSet& contacts, double cell) {
        ContactSet thinned{{}, contacts.query_seconds};
        ThinContacts(contacts.contacts, cell, &thinned.contacts);
        return thinned;
      },
      nb::arg("contacts"), nb::arg("cell"),
      "Leaves out contacts near a deeper one of the same object: nearer than "
      "`cell` (m), and with a normal that differs by less than 45°. The deeper "
      "one takes over their extents; 0 leaves nothing out.\n\n"
      "Raises:\n"
      "    ValueError: cell < 0.");
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
      "to 5). Members have the weight `tolerance` − distance.\n\n"
      "Raises:\n"
      "    ValueError: delta <= 0 or tolerance < 0.");
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

}  // namespace drake_haptics
