#include <stdexcept>
#include <string>

#include "bind/bind.h"
#include "bind/bind_autodiff_set.h"
#include "bind/bind_objects.h"
#include "law/contact_thinning.h"
#include "law/shared_stiffness.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

void BindClusters(nb::module_& m) {
  nb::class_<AutoDiffClusterSet> set(
      m, "AutoDiffClusterSet",
      "A `ClusterSet` with derivatives by D variables. Its columns are "
      "`AutoDiffVector`, those of vectors flattened by rows. Immutable; copies "
      "are the object itself.");
  set.def("__len__",
          [](const AutoDiffClusterSet& s) { return s.set.clusters.size(); });
  constexpr auto kItems = &ClusterSetOf<AutoDiff>::clusters;
  using Item = ClusterOf<AutoDiff>;
  DefGradientColumn<kItems, &Item::distance>(&set, "distance", "(k,) m.");
  DefGradientColumn<kItems, &Item::nhat_BA_W>(&set, "nhat_BA_W",
                                              "(3 k,) unit normals.");
  DefGradientColumn<kItems, &Item::p_WC>(&set, "p_WC", "(3 k,) m.");
  DefGradientColumn<kItems, &Item::compression>(&set, "compression", "(k,) m.");
  DefGradientColumn<kItems, &Item::damping_share>(&set, "damping_share",
                                                  "(k,).");
  DefGradient(
      &set, "coupling",
      [](const ClusterSetOf<AutoDiff>& s) {
        const auto count = static_cast<Eigen::Index>(s.clusters.size());
        VectorOf<AutoDiff> H(count * count);
        for (Eigen::Index k = 0; k < H.size(); ++k) {
          H[k] = s.coupling(k / count, k % count);
        }
        return H;
      },
      "(k k,) derivative of `compression` by the depths.");
  DefDifferentiated(&set, "The `ClusterSet`.");
  m.def(
      "thin_contacts",
      [](const AutoDiffContactSet& contacts, double cell) {
        AutoDiffContactSet thinned{{}, contacts.num_derivatives};
        ThinContacts(contacts.set.contacts, cell, &thinned.set.contacts);
        return thinned;
      },
      nb::arg("contacts"), nb::arg("cell"),
      "The same with derivatives; the contacts that stay are fixed.");
  m.def(
      "cluster_contacts",
      [](const AutoDiffContactSet& contacts, double delta, double tolerance) {
        AutoDiffClusterSet clusters{{}, contacts.num_derivatives};
        ClusterContacts(contacts.set.contacts, delta, tolerance, &clusters.set);
        ClusterSet values;
        ClusterContacts(ValuesOf(contacts.set).contacts, delta, tolerance,
                        &values);
        SetValues(values, &clusters);
        return clusters;
      },
      nb::arg("contacts"), nb::arg("delta"), nb::arg("tolerance"),
      "The same with derivatives; the groups of contacts are fixed.");
  m.def(
      "share_stiffness",
      [](const AutoDiffContactSet& contacts, double tolerance) {
        AutoDiffClusterSet clusters{{}, contacts.num_derivatives};
        ShareStiffness(contacts.set.contacts, tolerance, &clusters.set);
        ClusterSet values;
        ShareStiffness(ValuesOf(contacts.set).contacts, tolerance, &values);
        SetValues(values, &clusters);
        return clusters;
      },
      nb::arg("contacts"), nb::arg("tolerance"),
      "The same with derivatives; the contacts that push are fixed.");
}

void RequireVector(const AutoDiffVector& vector, Eigen::Index size,
                   Eigen::Index num_derivatives, const char* name) {
  if (vector.size() != size) {
    throw std::invalid_argument(std::string(name) + " must have " +
                                std::to_string(size) + " entries, has " +
                                std::to_string(vector.size()));
  }
  if (vector.num_derivatives() != num_derivatives) {
    throw std::invalid_argument(
        std::string(name) + " must have derivatives by the " +
        std::to_string(num_derivatives) + " variables of the clusters, has " +
        std::to_string(vector.num_derivatives()));
  }
}

AutoDiffPenaltyWrench Compute(const AutoDiffClusterSet& clusters,
                              const AutoDiffVector& p_WTo,
                              const AutoDiffVector& V_WT,
                              const AutoDiffVector& p_WO,
                              const AutoDiffVector& V_WO,
                              const Eigen::VectorXd& stiffness,
                              const Eigen::VectorXd& damping) {
  const ContactMaterials materials(stiffness, damping);
  const Eigen::Index count = stiffness.size(), D = clusters.num_derivatives;
  RequireVector(p_WTo, 3, D, "p_WTo");
  RequireVector(V_WT, 6, D, "V_WT");
  RequireVector(p_WO, 3 * count, D, "p_WO");
  RequireVector(V_WO, 6 * count, D, "V_WO");
  const auto tool = FrameOf(p_WTo, V_WT, 0);
  const auto objects = FramesOf(p_WO, V_WO);
  std::vector<MovingFrame> values;
  for (const auto& object : objects) values.push_back(ValuesOf(object));
  AutoDiffPenaltyWrench wrench{
      ComputePenaltyWrench(clusters.set, tool, objects, materials.materials),
      D};
  SetValues(ComputePenaltyWrench(ValuesOf(clusters.set), ValuesOf(tool), values,
                                 materials.materials),
            &wrench);
  return wrench;
}

void BindWrench(nb::module_& m) {
  nb::class_<AutoDiffPenaltyWrench> wrench(
      m, "AutoDiffPenaltyWrench",
      "A `PenaltyWrench` with derivatives by D variables; its wrenches and "
      "forces are flattened by rows. Immutable; copies are the object itself.");
  DefGradient(
      &wrench, "wrench_model", [](const auto& w) { return ToVector(w.tool); },
      "(78,) wrench on the tool at To with its linear model.");
  DefGradient(
      &wrench, "F_To_W", [](const auto& w) { return w.tool.F; },
      "(6,) wrench on the tool at To, [N·m; N].");
  DefGradient(
      &wrench, "F_objects_W",
      [](const auto& w) { return Flat<6>(w.SumByObject()); },
      "(6 m,) wrench on each object at its origin, [N·m; N].");
  DefGradient(
      &wrench, "f_cluster_W",
      [](const auto& w) { return Flat<3>(w.f_cluster_W); },
      "(3 k,) force of each cluster on the tool, N.");
  DefDifferentiated(&wrench, "The `PenaltyWrench`.");
  m.def(
      "penalty_force", &Compute, nb::arg("clusters"), nb::arg("p_WTo"),
      nb::arg("V_WT"), nb::arg("p_WO"), nb::arg("V_WO"), nb::arg("stiffness"),
      nb::arg("damping"),
      "The same with derivatives; p_WO (3 m,) and V_WO (6 m,) have one object "
      "after another.");
}

}  // namespace

void BindAutoDiffForce(nb::module_& m) {
  BindClusters(m);
  BindWrench(m);
}

}  // namespace drake_haptics
