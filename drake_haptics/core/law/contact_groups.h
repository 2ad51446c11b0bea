#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// What tells flush contacts apart.
struct GroupedContact {
  Vec3 nhat_BA_W;
  double depth;      ///< below the tolerance, m, above 0
  double flushness;  ///< 0 to 1
  std::size_t contact;
};

/// Contacts of nearly one direction and depth.
struct ContactGroup {
  std::span<const GroupedContact> members;
  double shallowest, deepest;  ///< of the depths, m
  double least_flushness;
  Vec3 nhat_BA_W;
  double spread;  ///< |n − nhat_BA_W| of its members is no more
};

/// Bounds for all pairs of a contact of one group and one of another.
struct GroupBounds {
  /// Of the shallower contact's depth over the deeper one's.
  double least_ratio, most_ratio;
  double least_turn, most_turn;  ///< of 1 − cos of the angle of their normals
};

/// Sorts contacts and splits them up into groups, in time n log n. Where they
/// are split is a matter of speed alone.
/// @param contacts stays as long as the groups, which refer to it.
std::vector<ContactGroup> GroupContacts(std::vector<GroupedContact>* contacts);

GroupBounds BoundGroups(const ContactGroup& one, const ContactGroup& other);

}  // namespace drake_haptics
