#include "pair/separation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace drake_haptics {
namespace {

// The gap that ends the search, relative to the size of the pair.
constexpr double kRelativeGap = 4e-16;
// The gap, relative to the same size, up to which an answer counts as proven.
constexpr double kProvenShare = 1e-10;
// Below this share of the size the difference of the closest points has no
// reliable direction.
constexpr double kTouchingShare = 1e-13;

void Start(const PosedPair& pair, const SimplexVertexPairs& start,
           Simplex* simplex) {
  for (int i = 0; i < start.size; ++i) {
    const MinkowskiVertex vertex_pair = start.vertex_pairs[i];
    simplex->Add(vertex_pair, pair.a(vertex_pair.a) - pair.b(vertex_pair.b));
  }
  if (simplex->size == 0) {
    simplex->Add({0, 0}, pair.a(0) - pair.b(0));
  }
  ReduceToClosest(simplex);
}

// The direction of the closest point. For three vertices it is the normal of
// their triangle, exact to round-off however small the distance; for two it is
// perpendicular to their segment.
Vec3 Direction(const Simplex& simplex, const Vec3& closest, double length) {
  if (simplex.size == 3) return simplex.normal.normalized();
  if (simplex.size == 1) return closest / length;
  const Vec3 along = simplex.points[1] - simplex.points[0];
  const Vec3 n = closest / length;
  return (n - along * (along.dot(n) / along.squaredNorm())).normalized();
}

// Where round-off tilts the direction, a facet beside the closest features may
// have a better normal: nearly parallel faces leave a sliver between them.
void Straighten(const PosedPair& pair, double scale, Separation* result) {
  constexpr double kNearby = 0.999;  // cosine
  const Vec3 v = result->simplex.Closest();
  const Vec3 tilted = result->n;
  MinkowskiVertex vertex_pair = result->simplex.vertex_pairs[0];
  double best = SupportGap(pair, tilted, &vertex_pair);
  const auto consider = [&](const Vec3& n) {
    if (n.dot(tilted) < kNearby) return;
    const double gap = SupportGap(pair, n, &vertex_pair);
    if (!(gap > best)) return;
    best = gap;
    result->n = n;
    result->distance = n.dot(v);
    result->is_proven = result->distance - gap <= kProvenShare * scale;
  };
  for (int i = 0; i < result->simplex.size; ++i) {
    const MinkowskiVertex corner = result->simplex.vertex_pairs[i];
    for (const auto& ring_entry : pair.A.fan_of(corner.a))
      consider(-ring_entry.normal);
    for (const auto& ring_entry : pair.B.fan_of(corner.b)) {
      consider(pair.X_AB.R * ring_entry.normal);
    }
  }
}

void SetClosestPoints(const PosedPair& pair, Separation* result) {
  const Simplex& simplex = result->simplex;
  result->p_a.setZero();
  for (int i = 0; i < simplex.size; ++i) {
    result->p_a += simplex.weights[i] * pair.a(simplex.vertex_pairs[i].a);
  }
  result->p_b = result->p_a - result->distance * result->n;
}

Separation Search(const PosedPair& pair, const SimplexVertexPairs& start,
                  double limit, int max_rounds) {
  Separation result;
  Simplex& simplex = result.simplex;
  Start(pair, start, &simplex);
  const double scale = pair.scale() + simplex.points[0].norm();
  MinkowskiVertex vertex_pair = simplex.vertex_pairs[0];
  for (int round = 0;; ++round) {
    const Vec3 v = simplex.Closest();
    const double length = v.norm();
    if (simplex.size == 4 || !(length > kTouchingShare * scale)) {
      result.status = SeparationStatus::kTouching;
      result.distance = 0;
      break;
    }
    result.status = SeparationStatus::kApart;
    result.n = Direction(simplex, v, length);
    result.distance = result.n.dot(v);
    const double gap = SupportGap(pair, result.n, &vertex_pair);
    if (gap > limit) {
      result.status = SeparationStatus::kBeyond;
      result.distance = gap;
      return result;
    }
    result.is_proven = length - gap <= kProvenShare * scale;
    if (length - gap <= kRelativeGap * scale || simplex.Contains(vertex_pair))
      break;
    Simplex next = simplex;
    next.Add(vertex_pair, pair.a(vertex_pair.a) - pair.b(vertex_pair.b));
    ReduceToClosest(&next);
    // Round-off can stop the descent just short of kRelativeGap.
    if (next.size < 4 && !(next.Closest().squaredNorm() < length * length)) {
      break;
    }
    result.is_bounded = round + 1 == max_rounds;
    if (result.is_bounded) break;
    simplex = next;
  }
  if (result.status == SeparationStatus::kApart && !result.is_proven) {
    Straighten(pair, scale, &result);
  }
  result.is_bounded &= !result.is_proven;
  SetClosestPoints(pair, &result);
  return result;
}

}  // namespace

bool HoldsOrigin(const PosedPair& pair, const SimplexVertexPairs& simplex) {
  if (simplex.size < 4) return false;
  Vec3 p[4];
  for (int i = 0; i < 4; ++i) {
    p[i] =
        pair.a(simplex.vertex_pairs[i].a) - pair.b(simplex.vertex_pairs[i].b);
  }
  // Signed volumes of the tetrahedra that the origin makes with the faces: the
  // origin is inside if all signs are equal.
  const Vec3 u = p[2].cross(p[3]), v = p[0].cross(p[1]);
  const double volumes[4] = {p[1].dot(u), -p[0].dot(u), p[3].dot(v),
                             -p[2].dot(v)};
  const double scale = pair.scale();
  const double round_off = 1e-13 * scale * scale * scale;
  const double sign = volumes[0] < 0 ? -1.0 : 1.0;
  return std::all_of(std::begin(volumes), std::end(volumes),
                     [&](double volume) { return sign * volume > round_off; });
}

Separation ComputeSeparation(const PosedPair& pair,
                             const SimplexVertexPairs& start, double limit,
                             int max_rounds) {
  assert(max_rounds > 0);
  const Separation result = Search(pair, start, limit, max_rounds);
  if (result.status != SeparationStatus::kApart || result.is_proven ||
      start.size == 0) {
    return result;
  }
  const Separation again = Search(pair, {}, limit, max_rounds);
  return again.status != SeparationStatus::kApart || again.is_proven ? again
                                                                     : result;
}

}  // namespace drake_haptics
