#include "mesh/mesh_edges.h"

#include <algorithm>
#include <tuple>

#include "base/sort_unique.h"

namespace drake_haptics {

std::vector<int> VerticesOf(std::span<const Triangle> triangles,
                            std::span<const int> members) {
  std::vector<int> vertices;
  for (const int t : members) {
    vertices.insert(vertices.end(), triangles[t].begin(), triangles[t].end());
  }
  SortUnique(&vertices);
  return vertices;
}

std::vector<TriangleSide> SortedSides(std::span<const Triangle> triangles) {
  std::vector<TriangleSide> sides;
  sides.reserve(3 * triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      if (a == b) continue;
      sides.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const TriangleSide& s, const TriangleSide& t) {
              return std::tie(s.low, s.high, s.triangle, s.edge) <
                     std::tie(t.low, t.high, t.triangle, t.edge);
            });
  return sides;
}

}  // namespace drake_haptics
