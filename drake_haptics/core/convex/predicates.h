#pragma once

#include "base/types.h"

namespace drake_haptics {

/// The determinant ((b - a) × (c - a)) · (d - a), with the right sign: positive
/// when d is above the plane of the counter-clockwise triangle a, b, c, exactly
/// zero when the four points are coplanar. A floating-point filter answers the
/// clear cases, exact arithmetic the others. Coordinates must be such that no
/// product of three underflows (see NormalizeForPredicates).
[[nodiscard]] double Orient3d(const Vec3& a, const Vec3& b, const Vec3& c,
                              const Vec3& d);

/// The determinant (b - a) × (c - a) in the plane, with the right sign:
/// positive when a, b, c turn counter-clockwise.
[[nodiscard]] double Orient2d(const Eigen::Vector2d& a,
                              const Eigen::Vector2d& b,
                              const Eigen::Vector2d& c);

/// (b - a) × (c - a), each component correct to round-off however thin the
/// triangle is.
Vec3 TriangleCross(const Vec3& a, const Vec3& b, const Vec3& c);

/// Factor, a power of two, that brings `magnitude` into [0.5, 1).
double PowerOfTwoScale(double magnitude);

/// `point` times `scale` with coordinates below 2^-200 set to zero: then every
/// exact value of the predicates is a multiple of 2^-756 and nothing
/// underflows.
Vec3 NormalizeForPredicates(const Vec3& point, double scale);

}  // namespace drake_haptics
