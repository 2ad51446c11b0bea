#include "pair/gauss_overlay_reject.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <span>

namespace drake_haptics {
namespace {

// Regions with more corners than this go to the overlay without a clip.
constexpr int kMaxCorners = 24;
constexpr int kMaxClips = 6;

// A spherical polygon: directions of any length.
struct Region {
  int size = 0;
  std::array<Vec3, kMaxCorners> corner;
  std::array<bool, kMaxCorners> exceeds;  // whether its gap exceeds the floor

  bool is_full() const { return size == kMaxCorners; }
  void Add(const Vec3& direction, bool is_beyond) {
    corner[size] = direction;
    exceeds[size++] = is_beyond;
  }
  // A corner that exceeds the floor, or -1.
  int FindExceeding() const {
    const auto end = exceeds.begin() + size;
    const auto found = std::find(exceeds.begin(), end, true);
    return found == end ? -1 : static_cast<int>(found - exceeds.begin());
  }
};

// Whether the gap along a direction of any length exceeds a negative floor.
bool Exceeds(const Vec3& direction, const Vec3& w, double floor) {
  const double gap = direction.dot(w);
  return gap > 0 || gap * gap < floor * floor * direction.squaredNorm();
}

// Clips a region to the half-space direction · edge <= 0. A clip adds a corner,
// or more if round-off has bent the region. Returns false if there are too
// many.
bool Clip(const Region& region, const Vec3& edge, const Vec3& w, double floor,
          Region* out) {
  out->size = 0;
  double before = region.corner[region.size - 1].dot(edge);
  for (int k = 0; k < region.size; ++k) {
    const Vec3& p = region.corner[k];
    const double here = p.dot(edge);
    if ((before <= 0) != (here <= 0)) {
      const Vec3& q = region.corner[k == 0 ? region.size - 1 : k - 1];
      if (out->is_full()) return false;
      // Weights of opposite signs: made positive by the sign of `here`.
      const Vec3 cut =
          here > 0 ? Vec3(here * q - before * p) : Vec3(before * p - here * q);
      out->Add(cut, Exceeds(cut, w, floor));
    }
    if (here <= 0) {
      if (out->is_full()) return false;
      out->Add(p, region.exceeds[k]);
    }
    before = here;
  }
  return true;
}

// The edge of B that excludes a direction (in B's frame) most; null if none
// does.
const Polytope::OneRingEntry* FindExcluding(
    std::span<const Polytope::OneRingEntry> fan_B, const Vec3& n_B) {
  const Polytope::OneRingEntry* found = nullptr;
  double most = 0;
  for (const Polytope::OneRingEntry& ring_entry : fan_B) {
    const double value = n_B.dot(ring_entry.along);
    if (value > most) {
      most = value;
      found = &ring_entry;
    }
  }
  return found;
}

}  // namespace

bool OverlayMayExceed(const PosedPair& pair, const MinkowskiVertex& vertex_pair,
                      const Vec3& w, double floor) {
  assert(floor < 0);
  const auto fan_A = pair.A.fan_of(vertex_pair.a);
  if (pair.A.dimension < 3 || fan_A.size() + kMaxClips > kMaxCorners) {
    return true;
  }
  Region region, clipped;
  for (const Polytope::OneRingEntry& ring_entry : fan_A) {
    region.Add(-ring_entry.normal, -ring_entry.normal.dot(w) > floor);
  }
  for (int clips = 0;; ++clips) {
    Region& from = clips % 2 == 0 ? region : clipped;
    Region& to = clips % 2 == 0 ? clipped : region;
    const int k = from.FindExceeding();
    if (k < 0) return false;
    const Polytope::OneRingEntry* ring_entry = FindExcluding(
        pair.B.fan_of(vertex_pair.b), pair.X_AB.R.transpose() * from.corner[k]);
    if (ring_entry == nullptr || clips == kMaxClips) return true;
    if (!Clip(from, pair.X_AB.R * ring_entry->along, w, floor, &to)) {
      return true;
    }
    if (to.size == 0) return false;
  }
}

}  // namespace drake_haptics
