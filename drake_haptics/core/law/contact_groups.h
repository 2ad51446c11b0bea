#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Properties that tell flush contacts apart.
struct GroupedContact {
  Vec3 nhat_BA_W;
  double depth;      ///< below the tolerance, m, above 0
  double flushness;  ///< 0 to 1
  std::size_t contact;
};

/// Contacts of nearly the same direction and depth.
struct ContactGroup {
  std::span<const GroupedContact> members;
  double shallowest, deepest;  ///< bounds of the depths, m
  double least_flushness;
  Vec3 nhat_BA_W;
  double spread;  ///< bound of |n − nhat_BA_W| over the members
};

/// Bounds for all pairs of contacts from two groups.
struct GroupBounds {
  /// Shallower depth over deeper depth.
  double least_ratio, most_ratio;
  double least_turn, most_turn;  ///< 1 − cos of the normals' angle
};

/// Sorts contacts and splits them into groups, in time n log n. Where they are
/// split affects speed only.
/// @param contacts must outlive the groups, which refer to it.
std::vector<ContactGroup> GroupContacts(std::vector<GroupedContact>* contacts);

GroupBounds BoundGroups(const ContactGroup& one, const ContactGroup& other);

}  // namespace drake_haptics
