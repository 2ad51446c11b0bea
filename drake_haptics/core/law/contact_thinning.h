#pragma once

#include <vector>

#include "pair/contact.h"

namespace drake_haptics {

/// Drops contacts that a deeper one nearby represents, to save later work: of
/// contacts of one object that are closer than `cell` and whose normals differ
/// by less than 45°, the deepest stays. It takes over the extents of the
/// others.
///
/// For each dropped contact one stays that is at least as deep, on the same
/// object, within `cell` and 45° of it; so no penetration is lost, and contacts
/// on other sides stay. Which contacts stay depends on the contacts alone and,
/// if two are equally deep, on their order.
/// @param cell m; 0 drops nothing.
/// @throws std::invalid_argument unless cell >= 0 and finite.
template <typename T>
void ThinContacts(const std::vector<ContactOf<T>>& contacts, double cell,
                  std::vector<ContactOf<T>>* out);

}  // namespace drake_haptics
