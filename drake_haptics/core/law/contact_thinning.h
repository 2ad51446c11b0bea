#pragma once

#include <vector>

#include "pair/contact.h"

namespace drake_haptics {

/// Leaves out contacts that a deeper one nearby stands for, so that what comes
/// after has less to do: of contacts of one object that are nearer to each
/// other than `cell` and whose normals differ by less than 45°, the deepest
/// stays. It takes over the extents of those that it stands for.
///
/// No contact is left out without one that is at least as deep, on the same
/// object, within `cell` and 45° of it; so none that penetrates is lost, and
/// what pushes from another side stays. Which ones stay depends on the contacts
/// alone, and where two are equally deep on their order.
/// @param cell m; 0 leaves nothing out.
/// @throws std::invalid_argument unless cell >= 0 and finite.
template <typename T>
void ThinContacts(const std::vector<ContactOf<T>>& contacts, double cell,
                  std::vector<ContactOf<T>>* out);

}  // namespace drake_haptics
