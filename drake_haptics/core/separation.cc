#include "separation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace drake_haptics {
namespace {

constexpr int kMaxRounds = 128;
// The gap that ends the search, relative to the size of the pair.
constexpr double kRelativeGap = 4e-16;
// Below this share of the size the difference of the closest points carries
// no direction any more.
constexpr double kTouchingShare = 1e-13;

Simplex Start(const PosedPair& pair, const Simplex& start) {
  Simplex simplex;
  for (int i = 0; i < start.size; ++i) {
    const Hub hub = start.hubs[i];
    if (!simplex.Contains(hub)) simplex.Add(hub, pair.a(hub.a) - pair.b(hub.b));
  }
  if (simplex.size == 0) {
    const Hub hub;
    simplex.Add(hub, pair.a(hub.a) - pair.b(hub.b));
  }
  ReduceToClosest(&simplex);
  return simplex;
}

// The normal of the features where three vertices define it: exact to
// round-off however small the distance is.
Vec3 FeatureNormal(const Simplex& simplex, const Vec3& v) {
  if (simplex.size == 3) {
    const Vec3 u = simplex.points[1] - simplex.points[0];
    const Vec3 w = simplex.points[2] - simplex.points[0];
    Vec3 n = u.cross(w);
    const double length = n.norm();
    if (length > 1e-8 * u.norm() * w.norm()) {
      n /= length;
      return n.dot(v) < 0 ? Vec3(-n) : n;
    }
  }
  return v.normalized();
}

}  // namespace

bool HoldsOrigin(const PosedPair& pair, const Simplex& simplex) {
  if (simplex.size < 4) return false;
  Vec3 p[4];
  for (int i = 0; i < 4; ++i) {
    p[i] = pair.a(simplex.hubs[i].a) - pair.b(simplex.hubs[i].b);
  }
  // Volumes, with signs, of the tetrahedra that the origin makes with the
  // faces: the origin is inside where all are alike.
  const Vec3 u = p[2].cross(p[3]), v = p[0].cross(p[1]);
  const double volumes[4] = {p[1].dot(u), -p[0].dot(u), p[3].dot(v),
                             -p[2].dot(v)};
  const double scale = pair.scale();
  const double round_off = 1e-13 * scale * scale * scale;
  const double sign = volumes[0] < 0 ? -1.0 : 1.0;
  return std::all_of(std::begin(volumes), std::end(volumes),
                     [&](double volume) { return sign * volume > round_off; });
}

Separation ComputeSeparation(const PosedPair& pair, const Simplex& start,
                             double limit) {
  Separation result;
  Simplex& simplex = result.simplex;
  simplex = Start(pair, start);
  const double scale = pair.scale() + simplex.points[0].norm();
  Hub hub = simplex.hubs[0];
  for (int round = 0; round < kMaxRounds; ++round) {
    if (simplex.size == 4) return result;
    const Vec3 v = simplex.Closest();
    const double length = v.norm();
    if (!(length > kTouchingShare * scale)) return result;
    const Vec3 n = v / length;
    const double gap = SupportGap(pair, n, &hub);
    if (gap > limit) {
      result.status = SeparationStatus::kBeyond;
      result.distance = gap;
      result.n = n;
      return result;
    }
    if (length - gap <= kRelativeGap * scale || simplex.Contains(hub)) break;
    Simplex next = simplex;
    next.Add(hub, pair.a(hub.a) - pair.b(hub.b));
    ReduceToClosest(&next);
    // Round-off can stop the descent a hair short of the gap above.
    if (next.size < 4 && !(next.Closest().squaredNorm() < length * length)) {
      break;
    }
    simplex = next;
  }
  result.status = SeparationStatus::kApart;
  result.n = FeatureNormal(simplex, simplex.Closest());
  result.p_a.setZero();
  result.p_b.setZero();
  for (int i = 0; i < simplex.size; ++i) {
    result.p_a += simplex.weights[i] * pair.a(simplex.hubs[i].a);
    result.p_b += simplex.weights[i] * pair.b(simplex.hubs[i].b);
  }
  result.distance = result.n.dot(result.p_a - result.p_b);
  return result;
}

}  // namespace drake_haptics
