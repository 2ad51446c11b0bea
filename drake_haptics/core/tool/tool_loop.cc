#include "tool/tool_loop.h"

#include <stdexcept>
#include <utility>

#include "law/shared_stiffness.h"

namespace drake_haptics {

ToolLoop::ToolLoop(ContactTracker tracker, Settings settings)
    : tracker_(std::move(tracker)),
      settings_(std::move(settings)),
      objects_(tracker_.num_objects()) {
  if (settings_.materials.size() != objects_.size()) {
    throw std::invalid_argument("there must be a material for each object");
  }
}

void ToolLoop::Step(const PoseVector& q_WH, const Vec6& V_WH,
                    ToolState* state) {
  tracker_.Query(PoseFromVector(state->q_WT, "the tool"), &contacts_);
  ShareStiffness(contacts_.contacts, tracker_.tolerance(), &clusters_);
  const MovingFrame tool{state->q_WT.tail<3>(), state->V_WT};
  WrenchModel sum =
      ComputePenaltyWrench(clusters_, tool, objects_, settings_.materials).tool;
  sum += ComputeCoupling(q_WH, V_WH, settings_.q_HT, state->q_WT, state->V_WT,
                         settings_.gains)
             .tool;
  *state = StepTool(settings_.inertia, *state, sum, settings_.period);
}

}  // namespace drake_haptics
