#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// Which pieces of a decomposition become one.
struct MergedPieces {
  std::vector<int> group_of_piece;  ///< from 0 without gaps
  double departure = 0;  ///< m, a bound on how far any group's hull departs
};

/// Joins neighboring pieces of an exact decomposition, the cheapest two first,
/// for as long as the hull of what they hold departs from the surface by no
/// more than `error` (see hull_departure.h). The hulls are of corners of the
/// mesh: they fill hollows and cut nothing away. Deterministic.
/// @param solid for each triangle, whether its part bounds a solid.
/// @param piece_of_triangle of the exact decomposition.
/// @param error m, zero or more.
/// @throws std::invalid_argument for bad indices or values,
///         std::runtime_error when `progress` asked to stop.
MergedPieces MergePieces(std::span<const Vec3> vertices,
                         std::span<const Triangle> triangles,
                         std::span<const std::uint8_t> solid,
                         std::span<const int> piece_of_triangle, double error,
                         const Progress& progress = {});

/// The pieces of groups. A group of one piece is that piece, exactly. Of the
/// hull of a larger one those facets are original below which, no deeper than
/// the error explains, the mesh comes and faces as they do. The others are
/// virtual, first of all those that are inside of the solid.
/// @param group_of_piece, error as of `MergePieces`.
Decomposition AssembleMergedPieces(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> solid,
                                   std::span<const int> piece_of_triangle,
                                   std::span<const int> group_of_piece,
                                   double error);

}  // namespace drake_haptics
