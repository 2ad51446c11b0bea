#pragma once

#include <span>

#include "byte_source.h"
#include "convex/polytope.h"
#include "tally.h"

namespace drake_haptics::fuzz {

/// Holds a hull against its definition: indices within bounds, a closed
/// surface, unit normals, all `points` behind all facets within `tolerance`
/// (m), and supports that a climb over its edges finds from any vertex.
void CheckPolytope(const Polytope& P, std::span<const Vec3> points,
                   double tolerance, ByteSource* probes, Tally* tally);

}  // namespace drake_haptics::fuzz
