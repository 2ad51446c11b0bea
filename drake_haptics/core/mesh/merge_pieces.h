#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// Groups of pieces of a decomposition that are merged.
struct MergedPieces {
  std::vector<int> group_of_piece;  ///< numbered from 0 without gaps
  double departure = 0;             ///< upper bound on any group's departure, m
};

/// Joins neighboring pieces of an exact decomposition, the cheapest two first,
/// for as long as their joint hull departs from the surface by no more than
/// `error` (see hull_deviation.h). The corners of the hulls are mesh vertices:
/// hulls fill hollows and cut nothing away. Deterministic.
/// @param solid for each triangle, whether its part bounds a solid.
/// @param piece_of_triangle pieces of the exact decomposition.
/// @param error m, zero or more.
/// @throws std::invalid_argument for bad indices or values,
///         std::runtime_error when `progress` asked to stop.
MergedPieces MergePieces(std::span<const Vec3> vertices,
                         std::span<const Triangle> triangles,
                         std::span<const std::uint8_t> solid,
                         std::span<const int> piece_of_triangle, double error,
                         const Progress& progress = {});

/// Makes one piece of each group. A group of one piece is exactly that piece. A
/// facet of a larger group's hull is original if the mesh below it, no deeper
/// than the error explains, faces as the facet does. The other facets are
/// virtual, in particular those inside the solid.
/// @param group_of_piece, error as in `MergePieces`.
Decomposition AssembleMergedPieces(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> solid,
                                   std::span<const int> piece_of_triangle,
                                   std::span<const int> group_of_piece,
                                   double error);

}  // namespace drake_haptics
