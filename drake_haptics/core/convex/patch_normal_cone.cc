#include "convex/patch_normal_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "convex/normal_cone_support.h"

namespace drake_haptics {
namespace {

// Sine of the angle by which corners are tested more loosely than contacts.
constexpr double kLoose = 1e-6;
// Tangent of the angle by which an edge's arc extends beyond the normals beside
// it; slightly above the slack.
constexpr double kArcSlack = 1.01 * kSurfaceSlack;
// 1 + the cosine between the normals beside a knife's edge, below which an arc
// with slack at both ends would span half a turn or more.
constexpr double kKnife = 2.1 * kArcSlack * kArcSlack;
// Angle by which the arc of a knife's edge is shortened at each end, rad.
constexpr double kShort = 1e-6;
// Between two corners a boundary bulges by at most the slack and round-off.
constexpr double kBulge = 2 * kSurfaceSlack;
// Cosine of the widest useful cone. A cone narrower than a right angle contains
// all directions between those in it.
constexpr double kWidest = 0.1;

bool FallsAway(const Vec3& n, const Vec3& r) {
  return n.dot(r) <= kSurfaceSlack + kLoose;
}

bool IsInNormalCone(const Vec3& n, std::span<const Vec3> ring) {
  return std::all_of(ring.begin(), ring.end(),
                     [&](const Vec3& r) { return FallsAway(n, r); });
}

class Collection {
 public:
  explicit Collection(const Polytope& piece) : piece_(piece) {}

  // Returns false if corners do not bound the directions.
  bool Run(std::span<const std::span<const Vec3>> ring_corners) {
    for (const Polytope::Facet& facet : piece_.facets) {
      if (facet.original) corners_.push_back(facet.normal);
    }
    for (const Polytope::Edge& edge : piece_.edges) {
      if (edge.normal_arc[0].isZero(0)) continue;
      for (const Vec3& end : edge.normal_arc) {
        corners_.push_back(end.normalized());
      }
    }
    for (int v = 0; v < piece_.num_vertices(); ++v) {
      if (!AddVertex(v, ring_corners[v])) return false;
    }
    return true;
  }

  DirectionCone Cone() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : corners_) sum += corner;
    DirectionCone cone{sum.normalized(), 1};
    for (const Vec3& corner : corners_) {
      cone.cosine = std::min(cone.cosine, cone.axis.dot(corner));
    }
    cone.cosine = std::cos(std::acos(cone.cosine) + kBulge);
    return cone.cosine >= kWidest ? cone : DirectionCone();
  }

 private:
  bool AddVertex(int v, std::span<const Vec3> ring_corners) {
    const auto ring = piece_.ring_of(v);
    if (ring.size() < 3) return false;
    const Vec3* flat = FindFlatFacet(v, ring);
    for (const Vec3& n : ring_corners) {
      if (!(flat && flat->dot(n) < 0)) corners_.push_back(n);
    }
    return true;
  }

  // The normal of the plane in which the mesh lies all around a vertex, which
  // carries nothing from behind. Null if there is none.
  const Vec3* FindFlatFacet(int v, std::span<const Vec3> ring) const {
    for (const Polytope::OneRingEntry& ring_entry : piece_.fan_of(v)) {
      if (!piece_.facets[ring_entry.facet].original) continue;
      const Vec3& n = ring_entry.normal;
      const bool is_flat =
          std::all_of(ring.begin(), ring.end(), [&](const Vec3& r) {
            const Vec3 aside = n.cross(r);
            return std::abs(n.dot(r)) <= kSurfaceSlack &&
                   !IsInNormalCone(aside, ring) &&
                   !IsInNormalCone(-aside, ring);
          });
      if (is_flat) return &n;
    }
    return nullptr;
  }

  const Polytope& piece_;
  std::vector<Vec3> corners_;
};

}  // namespace

void FillEdgeNormalArcs(Polytope* piece) {
  for (Polytope::Edge& edge : piece->edges) {
    edge.normal_arc = {Vec3::Zero(), Vec3::Zero()};
    const Vec3 &left = edge.wings[0], &right = edge.wings[1];
    const bool is_rim = left.isZero(0) || right.isZero(0);
    if (!edge.original || (left.isZero(0) && right.isZero(0))) continue;
    const Vec3 along = (piece->vertices[edge.v1] - piece->vertices[edge.v0])
                           .stableNormalized();
    const Vec3 normals[2] = {along.cross(left), right.cross(along)};
    // A concave edge carries nothing. The arc of a rim runs from its face's
    // normal to the direction away from the face, and a little beyond both. The
    // arc of a knife's edge, whose faces lie back to back, ends short of their
    // normals: an arc of half a turn or more would lead through the knife.
    if (!is_rim && normals[0].dot(right) > 2 * kArcSlack) continue;
    const bool is_knife = !is_rim && normals[0].dot(normals[1]) < -1 + kKnife;
    const double slack = is_knife ? -kShort : kArcSlack;
    for (int k = 0; k < 2; ++k) {
      const Vec3& wing = edge.wings[k];
      edge.normal_arc[k] =
          wing.isZero(0) ? Vec3(-edge.wings[1 - k] - kArcSlack * normals[1 - k])
                         : Vec3(normals[k] + slack * wing);
    }
  }
}

std::vector<Vec3> FindRingCorners(std::span<const Vec3> ring) {
  std::vector<Vec3> corners;
  // The edge that rose last is asked first, since it rises for most corners
  // that do not hold: else the many edges at the hub of a disk would take the
  // cube of their number.
  std::vector<Vec3> asked(ring.begin(), ring.end());
  const auto holds = [&](const Vec3& n) {
    const auto rises = [&](const Vec3& r) { return !FallsAway(n, r); };
    const auto found = std::find_if(asked.begin(), asked.end(), rises);
    if (found == asked.end()) return true;
    std::iter_swap(asked.begin(), found);
    return false;
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 between =
          (ring[i] + ring[j]) * (kSurfaceSlack / (1 + ring[i].dot(ring[j])));
      const double rest = 1 - between.squaredNorm();
      const Vec3 across = ring[i].cross(ring[j]);
      // Collinear edges define no corner; the rest of the ring bounds n.
      if (!(rest > 0) || !(across.squaredNorm() > 1e-20)) continue;
      const Vec3 aside = across.normalized() * std::sqrt(rest);
      for (const Vec3& n : {Vec3(between + aside), Vec3(between - aside)}) {
        if (holds(n)) corners.push_back(n);
      }
    }
  }
  return corners;
}

DirectionCone FindPatchNormalCone(
    const Polytope& piece,
    std::span<const std::span<const Vec3>> ring_corners) {
  Collection collection(piece);
  return piece.dimension < 2 || !collection.Run(ring_corners)
             ? DirectionCone()
             : collection.Cone();
}

}  // namespace drake_haptics
