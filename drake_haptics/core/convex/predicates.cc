#include "convex/predicates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/expansion.h"

namespace drake_haptics {
namespace {

// Half a unit in the last place of 1: the bound of one rounding.
constexpr double kRound = std::numeric_limits<double>::epsilon() / 2;

// Bounds of the error of the floating-point determinants, relative to the sum
// of the magnitudes of their products: Shewchuk 1997, sections 4.3 and 4.4.
constexpr double kOrient3dBound = (7 + 56 * kRound) * kRound;
constexpr double kOrient2dBound = (3 + 16 * kRound) * kRound;

// A cross product above this share of |u| |v| has lost few digits and is kept.
constexpr double kCrossKept = 0.05;

struct ExactEdge {
  ExactEdge(const Vec3& from, const Vec3& to)
      : x(ExactDifference(to.x(), from.x())),
        y(ExactDifference(to.y(), from.y())),
        z(ExactDifference(to.z(), from.z())) {}
  Expansion<2> x, y, z;
};

double ExactOrient3d(const Vec3& a, const Vec3& b, const Vec3& c,
                     const Vec3& d) {
  const ExactEdge u(a, b), v(a, c), w(a, d);
  return ((u.y * v.z - u.z * v.y) * w.x + (u.z * v.x - u.x * v.z) * w.y +
          (u.x * v.y - u.y * v.x) * w.z)
      .Round();
}

}  // namespace

double Orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double yz = u.y() * v.z(), zy = u.z() * v.y();
  const double zx = u.z() * v.x(), xz = u.x() * v.z();
  const double xy = u.x() * v.y(), yx = u.y() * v.x();
  const double det = (yz - zy) * w.x() + (zx - xz) * w.y() + (xy - yx) * w.z();
  const double magnitude = (std::abs(yz) + std::abs(zy)) * std::abs(w.x()) +
                           (std::abs(zx) + std::abs(xz)) * std::abs(w.y()) +
                           (std::abs(xy) + std::abs(yx)) * std::abs(w.z());
  if (std::abs(det) > kOrient3dBound * magnitude) return det;
  return ExactOrient3d(a, b, c, d);
}

double Orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                const Eigen::Vector2d& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y());
  const double right = (b.y() - a.y()) * (c.x() - a.x());
  const double det = left - right;
  if (std::abs(det) > kOrient2dBound * (std::abs(left) + std::abs(right))) {
    return det;
  }
  return (ExactDifference(b.x(), a.x()) * ExactDifference(c.y(), a.y()) -
          ExactDifference(b.y(), a.y()) * ExactDifference(c.x(), a.x()))
      .Round();
}

Vec3 TriangleCross(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  const Vec3 cross = u.cross(v);
  if (cross.squaredNorm() >
      kCrossKept * kCrossKept * u.squaredNorm() * v.squaredNorm()) {
    return cross;
  }
  const ExactEdge p(a, b), q(a, c);
  return {(p.y * q.z - p.z * q.y).Round(), (p.z * q.x - p.x * q.z).Round(),
          (p.x * q.y - p.y * q.x).Round()};
}

double PowerOfTwoScale(double magnitude) {
  int exponent = 0;
  std::frexp(magnitude, &exponent);
  // The smallest numbers would need two steps; here they count as zero.
  return std::ldexp(1.0, std::min(-exponent, 1000));
}

Vec3 NormalizeForPredicates(const Vec3& point, double scale) {
  constexpr double kSmallest = 0x1p-200;
  const Vec3 scaled = point * scale;
  return (scaled.array().abs() < kSmallest).select(Vec3::Zero(), scaled);
}

}  // namespace drake_haptics
