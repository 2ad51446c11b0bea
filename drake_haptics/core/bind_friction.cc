#include <nanobind/eigen/dense.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <string>

#include "bind.h"
#include "bind_array.h"
#include "bind_columns.h"
#include "friction.h"
#include "penalty_force.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Numbers =
    nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

void RequireSize(const Numbers& array, int size, const char* name) {
  if (static_cast<int>(array.shape(0)) != size) {
    throw std::invalid_argument(std::string(name) + " must have " +
                                std::to_string(size) + " numbers, has " +
                                std::to_string(array.shape(0)));
  }
}

FrictionStep CheckedStep(const StickSlipModel& model, const Numbers& state,
                         const ClusterSet& clusters,
                         const PenaltyWrench& contact_wrench,
                         const PoseVector& q_WTool, const Numbers& q_WO) {
  RequireSize(state, model.state_size(), "state");
  RequireSize(q_WO, 7 * model.num_moving(), "q_WO");
  if (clusters.clusters.size() != contact_wrench.f_cluster_W.size()) {
    throw std::invalid_argument(
        "contact_wrench must have one force for each cluster");
  }
  std::vector<double> normal_forces;
  normal_forces.reserve(clusters.clusters.size());
  for (std::size_t c = 0; c < clusters.clusters.size(); ++c) {
    if (clusters.clusters[c].object >= model.num_objects()) {
      throw std::invalid_argument(
          "a cluster names an object that has no coefficient");
    }
    normal_forces.push_back(contact_wrench.f_cluster_W[c].norm());
  }
  return model.Step(state.data(), clusters.clusters, normal_forces, q_WTool,
                    q_WO.data());
}

void BindFrictionStep(nb::module_& m) {
  nb::class_<FrictionStep> step(
      m, "FrictionStep",
      "Friction of all clusters at one tick. Immutable; copies are the object "
      "itself.");
  step.def_prop_ro(
      "wrench_model", [](const FrictionStep& s) { return ToVector(s.tool); },
      "(78,) wrench on the tool at To in W with its linear model: [F (6); K "
      "(36, by rows); B (36, by rows)], rotational first; B is zero.");
  step.def_prop_ro(
      "f_cluster_W",
      [](const FrictionStep& s) { return ToArray3(s.f_cluster_W); },
      "(k, 3) force of each cluster on the tool, at its point, N.");
  step.def_prop_ro(
      "sliding",
      [](const FrictionStep& s) {
        return Eigen::Map<const Eigen::Array<char, -1, 1>>(s.sliding.data(),
                                                           s.sliding.size())
            .cast<bool>()
            .eval();
      },
      "(k,) whether each cluster slides.");
  step.def_ro("stored_J", &FrictionStep::stored,
              "Elastic energy of the contacts, ½ k z² of each, J.");
  DefNumbers<&FrictionStep::next_state>(
      &step, "next_state", "(n,) what the next tick's step starts from.");
  DefFrozenCopy(&step);
}

void BindStickSlipModel(nb::module_& m) {
  nb::class_<StickSlipModel>(
      m, "StickSlipModel",
      "Stick-slip friction after Hayward and Armstrong (2000) of a tool on "
      "objects, at the representative contacts of clusters. Immutable: its "
      "state, (n,), goes in and comes out. It is [X_WTool (7); X_WO (7) of "
      "each object that moves; 32 slots of object, p_WC (3), nhat_BA_W (3), z "
      "(3), load, grip], the poses and the contacts of the last tick. A slot "
      "without a load is empty.")
      .def(
          "__init__",
          [](StickSlipModel* self, const std::vector<double>& coefficient,
             const std::vector<bool>& moves, double static_ratio,
             double break_away_m, double reach_m) {
            new (self) StickSlipModel(coefficient, moves,
                                      {static_ratio, break_away_m, reach_m});
          },
          nb::arg("coefficient"), nb::arg("moves"), nb::arg("static_ratio"),
          nb::arg("break_away_m"), nb::arg("reach_m"),
          "Args:\n"
          "    coefficient: (m,) coefficient of sliding friction of each "
          "object; one at 0 has none.\n"
          "    moves: (m,) whether each object moves.\n"
          "    static_ratio: static over sliding coefficient.\n"
          "    break_away_m: displacement after which a contact breaks away.\n"
          "    reach_m: distance over which contacts hand on their adhesion.\n"
          "\n"
          "Raises:\n"
          "    ValueError: a coefficient is negative, the ratio below 1, or a "
          "length not above 0.")
      .def_prop_ro("state_size", &StickSlipModel::state_size, "n.")
      .def("step", &CheckedStep, nb::arg("state"), nb::arg("clusters"),
           nb::arg("contact_wrench"), nb::arg("q_WTool"), nb::arg("q_WO"),
           "Friction now, and the state for the next tick.\n\n"
           "Args:\n"
           "    state: (n,) from the last tick; zeros before the first.\n"
           "    clusters: of now.\n"
           "    contact_wrench: their normal forces are the norms of its "
           "`f_cluster_W`.\n"
           "    q_WTool: (7,) pose of the tool.\n"
           "    q_WO: (7 j,) poses of the j objects that move, one after the "
           "other.\n\n"
           "Raises:\n"
           "    ValueError: a size does not match, or a cluster names an "
           "object that has no coefficient.");
}

}  // namespace

void BindFriction(nb::module_& m) {
  BindFrictionStep(m);
  BindStickSlipModel(m);
}

}  // namespace drake_haptics
