#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/rotation.h"
#include "law/braking.h"
#include "law/clustering.h"
#include "law/force_shading.h"
#include "law/friction.h"
#include "law/penalty_force.h"
#include "tool/rigid_tool.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics {

/// Law by which contacts become a wrench.
struct ContactLaw {
  double tolerance = 0;  ///< distance below which contacts push, m
  /// Size of the octree's cells, m; without it contacts share stiffness.
  std::optional<double> delta;
  std::vector<MovingFrame> objects;
  std::vector<ContactMaterial> materials;  ///< one for each object
  /// Shading of the normals along which contacts push; null for none.
  std::shared_ptr<const ContactShading> shading;
};

/// The chain from the tool's motion to the wrench of its contacts: query,
/// shading, clusters, penalty force. The chain keeps its last results and
/// returns them again for the same arguments.
class ContactChain {
 public:
  void SetLaw(ContactLaw law);

  /// Forgets the last results. Call this after a change of the tracker.
  void Forget();

  /// Returns the contacts at a pose up to a tolerance, m.
  /// @throws as ContactTracker::Query and PoseFromVector.
  const ContactSet& FindContacts(const PoseVector& q_WT, double tolerance,
                                 ContactTracker* tracker);

  /// Contacts that were found last, not shaded.
  const ContactSet& contacts() const { return contacts_; }

  /// Distance below which contacts push, m.
  /// @throws std::logic_error without a law.
  double tolerance_of_law() const { return law().tolerance; }

  /// Number of objects of the law.
  /// @throws std::logic_error without a law.
  int num_objects() const { return static_cast<int>(law().materials.size()); }

  /// Number of clusters of the wrench that was found last.
  int num_clusters() const {
    return static_cast<int>(clusters_.clusters.size());
  }

  /// Returns the wrench of the contacts on the tool at To.
  /// @throws as FindContacts and ComputePenaltyWrench; std::logic_error without
  ///         a law.
  const WrenchModel& FindWrench(const ToolState& tool, ContactTracker* tracker);

  /// Returns the friction of the contacts; their objects rest.
  /// @param state of the last tick, friction.state_size() numbers.
  /// @pre friction has the objects of the law, none of which moves.
  /// @throws as FindWrench.
  FrictionStep FindFriction(const StickSlipModel& friction, const double* state,
                            const ToolState& tool, ContactTracker* tracker);

  /// Returns the braking of the contacts, which are not shaded for it, on the
  /// tool at To.
  /// @throws as FindContacts and ComputeBraking; std::logic_error without a
  ///         law.
  WrenchModel FindBraking(const BrakingGains& gains, const ToolState& tool,
                          ContactTracker* tracker);

 private:
  const ContactLaw& law() const;
  // Returns the contacts with the normals along which they push.
  const std::vector<Contact>& Shade(const ContactTracker& tracker);

  std::optional<ContactLaw> law_;
  bool has_contacts_ = false;  // for q_WT_ and tolerance_
  PoseVector q_WT_;
  double tolerance_ = 0;
  ContactSet contacts_;
  ContactSet shaded_;
  std::vector<Pose> X_WO_;   // of the tracker's objects; empty until needed
  bool has_wrench_ = false;  // for q_WT_ and V_WT_
  Vec6 V_WT_;
  ClusterSet clusters_;
  PenaltyWrench wrench_;
};

}  // namespace drake_haptics
