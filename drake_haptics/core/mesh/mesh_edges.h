#pragma once

#include <span>
#include <vector>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// The vertices of some triangles, ascending.
/// @param members indices in `triangles`.
std::vector<int> VerticesOf(std::span<const Triangle> triangles,
                            std::span<const int> members);

/// One side of a triangle: edge k runs from corner k to corner k + 1.
struct TriangleSide {
  int low, high;  ///< vertices, low < high
  int triangle, edge;
  bool forward;  ///< runs from low to high
};

/// The sides of all triangles, sorted such that those on one mesh edge are
/// adjacent. Sides of no length are left out.
std::vector<TriangleSide> SortedSides(std::span<const Triangle> triangles);

/// Calls `visit(span of sides)` for each mesh edge.
template <typename Visit>
void ForEachMeshEdge(std::span<const TriangleSide> sides, const Visit& visit) {
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low &&
           sides[j].high == sides[i].high) {
      ++j;
    }
    visit(sides.subspan(i, j - i));
  }
}

}  // namespace drake_haptics
