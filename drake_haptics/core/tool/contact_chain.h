#pragma once

#include <optional>
#include <vector>

#include "base/rotation.h"
#include "law/clustering.h"
#include "law/penalty_force.h"
#include "tool/rigid_tool.h"
#include "tracker/contact_tracker.h"

namespace drake_haptics {

/// How contacts become a wrench.
struct ContactLaw {
  double tolerance = 0;         ///< contacts below it push, m
  std::optional<double> delta;  ///< cell of the octree, m; shared without
  std::vector<MovingFrame> objects;
  std::vector<ContactMaterial> materials;  ///< one for each object
};

/// The chain from the tool's motion to the wrench of its contacts: query,
/// clusters, penalty force. What was asked last is kept, so that who asks for
/// the same again, or for a part of it, gets what is there.
class ContactChain {
 public:
  void SetLaw(ContactLaw law);

  /// Forgets what was asked last, as what the tracker watches was changed.
  void Forget();

  /// The contacts at a pose up to a tolerance, m.
  /// @throws as ContactTracker::Query and PoseFromVector.
  const ContactSet& FindContacts(const PoseVector& q_WT, double tolerance,
                                 ContactTracker* tracker);

  /// Those that were asked for last.
  const ContactSet& contacts() const { return contacts_; }

  /// Distance of the nearest of them, m; infinite without any.
  double least_distance() const;

  /// Those of them below it push, m.
  /// @throws std::logic_error without a law.
  double tolerance_of_law() const { return law().tolerance; }

  /// How many clusters these make at the wrench that was asked for last.
  int num_clusters() const {
    return static_cast<int>(clusters_.clusters.size());
  }

  /// The wrench of the contacts on the tool at To.
  /// @throws also as ComputePenaltyWrench; std::logic_error without a law.
  const WrenchModel& FindWrench(const ToolState& tool, ContactTracker* tracker);

 private:
  const ContactLaw& law() const;

  std::optional<ContactLaw> law_;
  bool has_contacts_ = false;  // those of q_WT_ and tolerance_
  PoseVector q_WT_;
  double tolerance_ = 0;
  ContactSet contacts_;
  bool has_wrench_ = false;  // that of q_WT_ and V_WT_ too
  Vec6 V_WT_;
  ClusterSet clusters_;
  WrenchModel wrench_;
};

}  // namespace drake_haptics
