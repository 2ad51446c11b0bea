#pragma once

#include <vector>

#include "base/rotation.h"
#include "law/penalty_force.h"
#include "tool/contact_chain.h"
#include "tool/rigid_tool.h"
#include "tool/virtual_coupling.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics {

/// The tool's part of a haptic loop without Drake: one call goes from the
/// handle to the tool's next state. It computes the same as the systems of a
/// loop without effects, in their order.
class ToolLoop {
 public:
  struct Settings {
    ToolInertia inertia;
    CouplingGains gains;
    PoseVector q_HT;                         ///< pose of the tool in the handle
    std::vector<ContactMaterial> materials;  ///< one for each object
    double period = 0;                       ///< s
  };

  /// @param tracker tracker with its objects posed; they rest.
  /// @throws std::invalid_argument unless there is a material for each object.
  ToolLoop(ContactTracker tracker, Settings settings);

  /// Advances the tool by a tick.
  void Step(const PoseVector& q_WH, const Vec6& V_WH, ToolState* state);

  /// Contacts at the beginning of the last tick.
  const ContactSet& contacts() const { return chain_.contacts(); }

 private:
  ContactTracker tracker_;
  Settings settings_;
  ContactChain chain_;
};

}  // namespace drake_haptics
