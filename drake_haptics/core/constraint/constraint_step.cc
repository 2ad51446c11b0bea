#include "constraint/constraint_step.h"

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/require.h"

namespace drake_haptics {

ConstraintStepper::ConstraintStepper(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects,
    Settings settings)
    : objects_(objects.size()), settings_(std::move(settings)) {
  if (tool == nullptr) throw std::invalid_argument("the tool is missing");
  for (const auto& pieces : objects) {
    if (pieces == nullptr) throw std::invalid_argument("an object is missing");
  }
  if (settings_.skin.size() != objects.size()) {
    throw std::invalid_argument("there must be a skin for each object");
  }
  for (const double skin : settings_.skin) RequirePositive(skin, "skin_m");
  RequirePositive(settings_.period, "period_s");
  RequirePhysical(settings_.inertia);
}

void ConstraintStepper::SetObjectPose(int i, const Pose& X_WO,
                                      const Vec6& V_WO) {
  if (i < 0 || i >= num_objects()) {
    throw std::out_of_range("there is no object " + std::to_string(i));
  }
  if (!X_WO.R.allFinite() || !X_WO.p.allFinite() || !V_WO.allFinite()) {
    throw std::invalid_argument(
        "the pose or velocity of an object holds a value that is not finite");
  }
  objects_[i] = {X_WO, V_WO};
}

void ConstraintStepper::Step(const ToolState& state, const PoseVector& q_WH,
                             const Vec6& V_WH, const Vec6& F_applied,
                             ConstraintStepResult* result) {
  const double h = settings_.period;
  const CouplingWrench coupling = ComputeCoupling(
      q_WH, V_WH, settings_.q_HT, state.q_WT, state.V_WT, settings_.gains);
  WrenchModel wrench = coupling.tool;
  wrench.F += F_applied;
  const auto [M, b] = ComputeMotionTerms(settings_.inertia, state);
  result->next = StepTool(settings_.inertia, state, wrench, h);
  result->F_Ho_W_commanded = coupling.F_Ho_W_commanded;
  result->hessian = M / (h * h) + wrench.B / h + wrench.K;
  result->contacts.contacts.clear();
  result->force.clear();
  result->F_Oo_W.assign(objects_.size(), Vec6::Zero());
  result->num_rows = result->num_iterations = 0;
  result->num_substeps = 1;
  result->least_distance = std::numeric_limits<double>::infinity();
  result->is_apart = true;
}

void ConstraintStepper::Reset() {}

}  // namespace drake_haptics
