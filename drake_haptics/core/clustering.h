#pragma once

#include <cstdint>
#include <vector>

#include "contact.h"
#include "types.h"

namespace drake_haptics {

/// The representative contact of a cluster (paper, Eq. 3 to 5), in the world.
struct Cluster {
  double distance = 0;  ///< smallest distance of the members (Eq. 5), m
  Vec3 nhat_BA_W;       ///< weighted mean direction (Eq. 3), unit
  Vec3 p_WC;            ///< weighted mean position (Eq. 4), m
  std::int32_t object = 0;
  std::int32_t num_contacts = 0;
};

/// Clusters ordered by their first contact, and the cluster of each contact.
struct ClusterSet {
  std::vector<Cluster> clusters;
  std::vector<std::int32_t> label;
};

/// Groups contacts of the same object with an octree whose leaves have the
/// size `delta`: contacts in one leaf are together, and adjacent occupied
/// leaves (26 neighbours) are merged (paper, 4.2). Contacts closer than delta
/// are always together, contacts of different clusters are at least delta
/// apart; between delta and 2·√3·delta the leaves decide. Each member weighs
/// `tolerance` − distance.
/// @param delta leaf size, m.
/// @param tolerance the distance t up to which contacts were looked for, m.
/// @throws std::invalid_argument unless delta > 0 and tolerance >= 0, finite.
void ClusterContacts(const std::vector<Contact>& contacts, double delta,
                     double tolerance, ClusterSet* out);

}  // namespace drake_haptics
