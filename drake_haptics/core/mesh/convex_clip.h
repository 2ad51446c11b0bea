#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "mesh/surface_mesh.h"

namespace drake_haptics {

double PolygonArea(std::span<const Vec3> polygon);

/// The part of a convex polygon below all planes, each lowered by `inset`.
std::vector<Vec3> ClipPolygon(std::vector<Vec3> polygon,
                              std::span<const Plane> planes, double inset);

/// Whether a triangle meets the part of a convex body that is more than `inset`
/// below all of its planes.
/// @param[in,out] likely index of the plane that is asked first: the one that
/// the last triangle was beyond, since the next one often is, too. At first 0.
[[nodiscard]] bool MeetsInterior(const std::array<Vec3, 3>& triangle,
                                 std::span<const Plane> planes, double inset,
                                 std::size_t* likely);

}  // namespace drake_haptics
