#include <nanobind/stl/vector.h>

#include <span>
#include <stdexcept>
#include <string>

#include "bind/bind.h"
#include "bind/bind_array.h"
#include "bind/bind_autodiff_set.h"
#include "bind/bind_columns.h"
#include "law/friction.h"
#include "law/penalty_force.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Numbers = NumbersArg<double>;

template <typename T>
void RequireSize(std::span<const T> numbers, int size, const char* name) {
  if (std::ssize(numbers) != size) {
    throw std::invalid_argument(std::string(name) + " must have " +
                                std::to_string(size) + " numbers, has " +
                                std::to_string(numbers.size()));
  }
}

template <typename T>
FrictionStepOf<T> CheckedStep(const StickSlipModel& model,
                              std::span<const T> state,
                              const ClusterSetOf<T>& clusters,
                              const PenaltyWrenchOf<T>& contact_wrench,
                              const Eigen::Matrix<T, 7, 1>& q_WT,
                              std::span<const T> q_WO) {
  RequireSize(state, model.state_size(), "state");
  RequireSize(q_WO, 7 * model.num_moving(), "q_WO");
  if (clusters.clusters.size() != contact_wrench.f_cluster_W.size()) {
    throw std::invalid_argument(
        "contact_wrench must have one force for each cluster");
  }
  for (const ClusterOf<T>& cluster : clusters.clusters) {
    if (cluster.object >= model.num_objects()) {
      throw std::invalid_argument(
          "a cluster names an object that has no coefficient");
    }
  }
  return model.Step(state.data(), clusters.clusters,
                    contact_wrench.NormalForces(), q_WT, q_WO.data());
}

FrictionStep StepFriction(const StickSlipModel& model, const Numbers& state,
                          const ClusterSet& clusters,
                          const PenaltyWrench& contact_wrench,
                          const PoseVector& q_WT, const Numbers& q_WO) {
  return CheckedStep<double>(model, {state.data(), state.shape(0)}, clusters,
                             contact_wrench, q_WT,
                             {q_WO.data(), q_WO.shape(0)});
}

std::vector<AutoDiff> ToList(const AutoDiffVector& vector) {
  std::vector<AutoDiff> list;
  for (Eigen::Index i = 0; i < vector.size(); ++i) list.push_back(vector(i));
  return list;
}

std::span<const double> ToSpan(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

AutoDiffFrictionStep DifferentiateStep(
    const StickSlipModel& model, const AutoDiffVector& state,
    const AutoDiffClusterSet& clusters,
    const AutoDiffPenaltyWrench& contact_wrench, const AutoDiffVector& q_WT,
    const AutoDiffVector& q_WO) {
  const Eigen::Index num_derivatives = CommonNumDerivatives(state, q_WT, q_WO);
  if (clusters.num_derivatives != num_derivatives ||
      contact_wrench.num_derivatives != num_derivatives) {
    throw std::invalid_argument(
        "clusters and contact_wrench must have derivatives by the variables of "
        "the state");
  }
  AutoDiffFrictionStep step{
      CheckedStep<AutoDiff>(model, ToList(state), clusters.set,
                            contact_wrench.set, ToScalars<7>(q_WT, "q_WT"),
                            ToList(q_WO)),
      num_derivatives};
  SetValues(CheckedStep<double>(
                model, ToSpan(state.value), ValuesOf(clusters.set),
                ValuesOf(contact_wrench.set), q_WT.value, ToSpan(q_WO.value)),
            &step);
  return step;
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
      [](const FrictionStep& s) { return ToRows(s.f_cluster_W); },
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
      &step, "next_state", "(n,) state from which the next tick starts.");
  DefFrozenCopy(&step);
}

void BindAutoDiffStep(nb::module_& m) {
  nb::class_<AutoDiffFrictionStep> step(
      m, "AutoDiffFrictionStep",
      "A `FrictionStep` with derivatives by D variables. Immutable; copies are "
      "the object itself.");
  DefGradient(
      &step, "wrench_model", [](const auto& s) { return ToVector(s.tool); },
      "(78,) wrench on the tool at To with its linear model.");
  DefGradient(
      &step, "f_cluster_W", [](const auto& s) { return Flat(s.f_cluster_W); },
      "(3 k,) force of each cluster on the tool, N.");
  DefGradient(
      &step, "stored_J",
      [](const auto& s) { return VectorOf<AutoDiff>{{s.stored}}; },
      "(1,) elastic energy of the contacts, J.");
  DefGradient(
      &step, "next_state",
      [](const auto& s) {
        return Eigen::Map<const VectorOf<AutoDiff>>(s.next_state.data(),
                                                    s.next_state.size());
      },
      "(n,) state from which the next tick starts.");
  DefDifferentiated(&step, "The `FrictionStep`.");
}

void BindStickSlipModel(nb::module_& m) {
  nb::class_<StickSlipModel>(
      m, "StickSlipModel",
      "Stick-slip friction after Hayward and Armstrong (2000) of a tool on "
      "objects, at the representative contacts of clusters. Immutable: the "
      "state (n,) is passed in and returned. It is [X_WT (7); X_WO (7) of each "
      "object that moves; 32 slots of object, p_WC (3), nhat_BA_W (3), z (3), "
      "load, grip], the poses and the contacts of the last tick. A slot "
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
          "object; 0 for no friction.\n"
          "    moves: (m,) whether each object moves.\n"
          "    static_ratio: ratio of the static to the sliding coefficient.\n"
          "    break_away_m: displacement after which a contact breaks away.\n"
          "    reach_m: distance over which contacts hand their adhesion "
          "on.\n\n"
          "Raises:\n"
          "    ValueError: a coefficient is negative, the ratio below 1, or a "
          "length not above 0.")
      .def_prop_ro("state_size", &StickSlipModel::state_size, "n.")
      .def("step", &StepFriction, nb::arg("state"), nb::arg("clusters"),
           nb::arg("contact_wrench"), nb::arg("q_WT"), nb::arg("q_WO"),
           "Returns the friction of this tick, and with it the state for the "
           "next.\n\n"
           "Args:\n"
           "    state: (n,) state from the last tick; zeros before the first.\n"
           "    clusters: clusters of this tick.\n"
           "    contact_wrench: wrench of the clusters; the norms of its "
           "`f_cluster_W` are the normal forces.\n"
           "    q_WT: (7,) pose of the tool.\n"
           "    q_WO: (7 j,) poses of the j objects that move, one after the "
           "other.\n\n"
           "Raises:\n"
           "    ValueError: a size does not match, or a cluster names an "
           "object that has no coefficient.")
      .def("step", &DifferentiateStep, nb::arg("state"), nb::arg("clusters"),
           nb::arg("contact_wrench"), nb::arg("q_WT"), nb::arg("q_WO"),
           "The same with derivatives; which contacts stick or slide, and "
           "their neighbors, are fixed.");
}

}  // namespace

void BindFriction(nb::module_& m) {
  BindFrictionStep(m);
  BindAutoDiffStep(m);
  BindStickSlipModel(m);
}

}  // namespace drake_haptics
