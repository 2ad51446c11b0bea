#pragma once

#include <span>

#include "base/autodiff.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Share m of each contact of one object in its constraint: its extent over
/// that of all contacts at the same depth that are flush in one plane, or at
/// one place with similar normals, as on the facets of a smooth surface. From
/// an edge, distances are measured from its ends. Contacts that are neither
/// near each other nor both flush are never compared.
/// @param contacts all nearer than `tolerance` (m).
template <typename T>
VectorOf<T> ContactShares(std::span<const ContactOf<T>* const> contacts,
                          double tolerance);

}  // namespace drake_haptics
