#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "convex/polytope.h"

namespace drake_haptics {

/// Sines of the tilt up to which a facet is flush, and from which on it is not.
/// Two edges of a right-angled corner that tilt by kFlush span a facet that
/// tilts by kTilted, so that a facet takes over before two edges share the
/// contact.
inline constexpr double kFlush = 0.05;
inline constexpr double kTilted = 0.0707;

/// Share of a contact, 1 to 0, that a facet or an edge takes at a tilt.
inline double FacetShare(double sine) {
  return std::clamp((kTilted - sine) / (kTilted - kFlush), 0.0, 1.0);
}
inline double EdgeShare(double sine) {
  return std::max(0.0, 1 - sine * sine / (kFlush * kFlush));
}

/// Facets at a vertex that are nearly flush with the contact's plane, and the
/// share of the contact that they leave to edges. Virtual facets carry no
/// pressure: they are inside the body, or another piece has their face.
struct FlushFacets {
  struct Item {
    int index = -1;
    double share = 0;
  };
  /// Further facets are left out: so fine a fan is a smooth surface.
  static constexpr int kMost = 8;
  std::array<Item, kMost> facets;
  int count = 0;
  double rest = 1;

  FlushFacets(const Polytope& P, int vertex, const Vec3& outward) {
    // Slightly below the cosine of the tilt kTilted.
    constexpr double kCosTilted = 0.9974;
    for (const Polytope::OneRingEntry& ring_entry : P.fan_of(vertex)) {
      if (!(ring_entry.normal.dot(outward) > kCosTilted) || count == kMost ||
          !P.facets[ring_entry.facet].original) {
        continue;
      }
      const double share = FacetShare(ring_entry.normal.cross(outward).norm());
      if (!(share > 0)) continue;
      facets[count++] = {ring_entry.facet, share};
      rest *= 1 - share;
    }
  }
  const Item* begin() const { return facets.data(); }
  const Item* end() const { return facets.data() + count; }
};

/// Calls visit(edge, share) for each nearly flush edge at a vertex.
template <typename Visitor>
void VisitFlushEdges(const Polytope& P, int vertex, const Vec3& outward,
                     const Visitor& visit) {
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(vertex)) {
    const double rise = ring_entry.along.dot(outward);
    const double length_squared = ring_entry.along.squaredNorm();
    if (rise * rise < kFlush * kFlush * length_squared) {
      visit(ring_entry.edge,
            EdgeShare(std::abs(rise) / std::sqrt(length_squared)));
    }
  }
}

}  // namespace drake_haptics
