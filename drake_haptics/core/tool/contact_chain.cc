#include "tool/contact_chain.h"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "law/shared_stiffness.h"

namespace drake_haptics {
namespace {

// Compares bit for bit: 0 differs from −0, and a NaN equals itself.
template <typename Vector>
bool IsSame(const Vector& a, const Vector& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

}  // namespace

void ContactChain::SetLaw(ContactLaw law) {
  law_ = std::move(law);
  has_wrench_ = false;
}

const ContactLaw& ContactChain::law() const {
  if (!law_.has_value()) {
    throw std::logic_error("no contact law was set");
  }
  return *law_;
}

void ContactChain::Forget() {
  has_contacts_ = has_wrench_ = false;
  X_WO_.clear();
}

const ContactSet& ContactChain::FindContacts(const PoseVector& q_WT,
                                             double tolerance,
                                             ContactTracker* tracker) {
  if (!has_contacts_ || tolerance != tolerance_ || !IsSame(q_WT, q_WT_)) {
    has_contacts_ = has_wrench_ = false;
    tracker->Query(PoseFromVector(q_WT, "X_WT"), tolerance, &contacts_);
    q_WT_ = q_WT;
    tolerance_ = tolerance;
    has_contacts_ = true;
  }
  return contacts_;
}

const std::vector<Contact>& ContactChain::Shade(const ContactTracker& tracker) {
  if (law().shading == nullptr) return contacts_.contacts;
  for (int i = static_cast<int>(X_WO_.size()); i < tracker.num_objects(); ++i) {
    X_WO_.push_back(tracker.object_pose(i));
  }
  shaded_ = contacts_;
  law().shading->Shade<double>(PoseFromVector(q_WT_, "X_WT"), X_WO_, &shaded_);
  return shaded_.contacts;
}

const WrenchModel& ContactChain::FindWrench(const ToolState& tool,
                                            ContactTracker* tracker) {
  const ContactLaw& law = this->law();
  FindContacts(tool.q_WT, tracker->tolerance(), tracker);
  if (has_wrench_ && IsSame(tool.V_WT, V_WT_)) {
    return wrench_.tool;
  }
  has_wrench_ = false;
  const std::vector<Contact>& pushing = Shade(*tracker);
  if (law.delta.has_value()) {
    ClusterContacts(pushing, *law.delta, law.tolerance, &clusters_);
  } else {
    ShareStiffness(pushing, law.tolerance, &clusters_);
  }
  wrench_ = ComputePenaltyWrench(clusters_, {tool.q_WT.tail<3>(), tool.V_WT},
                                 law.objects, law.materials);
  V_WT_ = tool.V_WT;
  has_wrench_ = true;
  return wrench_.tool;
}

FrictionStep ContactChain::FindFriction(const StickSlipModel& friction,
                                        const double* state,
                                        const ToolState& tool,
                                        ContactTracker* tracker) {
  FindWrench(tool, tracker);
  return friction.Step<double>(state, clusters_.clusters,
                               wrench_.NormalForces(), tool.q_WT, nullptr);
}

WrenchModel ContactChain::FindBraking(const BrakingGains& gains,
                                      const ToolState& tool,
                                      ContactTracker* tracker) {
  FindContacts(tool.q_WT, tracker->tolerance(), tracker);
  return ComputeBraking<double>(contacts_.contacts,
                                {tool.q_WT.tail<3>(), tool.V_WT}, law().objects,
                                gains)
      .tool;
}

}  // namespace drake_haptics
