#include "tool/tool_loop.h"

#include <stdexcept>
#include <utility>

namespace drake_haptics {

ToolLoop::ToolLoop(ContactTracker tracker, Settings settings)
    : tracker_(std::move(tracker)), settings_(std::move(settings)) {
  const auto num_objects = static_cast<std::size_t>(tracker_.num_objects());
  if (settings_.materials.size() != num_objects) {
    throw std::invalid_argument("there must be a material for each object");
  }
  chain_.SetLaw({tracker_.tolerance(), std::nullopt,
                 std::vector<MovingFrame>(num_objects), settings_.materials});
}

void ToolLoop::Step(const PoseVector& q_WH, const Vec6& V_WH,
                    ToolState* state) {
  WrenchModel sum = chain_.FindWrench(*state, &tracker_);
  sum += ComputeCoupling(q_WH, V_WH, settings_.q_HT, state->q_WT, state->V_WT,
                         settings_.gains)
             .tool;
  *state = StepTool(settings_.inertia, *state, sum, settings_.period);
}

}  // namespace drake_haptics
