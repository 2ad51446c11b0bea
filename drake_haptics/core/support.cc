#include "support.h"

namespace drake_haptics {
namespace {

// Up to this many vertices, reading all of them beats climbing.
constexpr int kScanLimit = 12;

}  // namespace

int SupportVertex(const Polytope& polytope, const Vec3& direction, int start) {
  const std::vector<Vec3>& vertices = polytope.vertices;
  const int count = polytope.num_vertices();
  int best = start;
  double best_value = direction.dot(vertices[best]);
  if (count <= kScanLimit) {
    for (int i = 0; i < count; ++i) {
      const double value = direction.dot(vertices[i]);
      if (value > best_value) {
        best_value = value;
        best = i;
      }
    }
    return best;
  }
  // Every vertex is extreme, so a vertex that no neighbour beats is the
  // farthest one; the strict test ends the climb.
  for (bool climbing = true; climbing;) {
    climbing = false;
    for (const int neighbor : polytope.neighbors_of(best)) {
      const double value = direction.dot(vertices[neighbor]);
      if (value > best_value) {
        best_value = value;
        best = neighbor;
        climbing = true;
      }
    }
  }
  return best;
}

double SupportGap(const PosedPair& pair, const Vec3& n, Hub* hub) {
  hub->a = pair.SupportA(-n, hub->a);
  hub->b = pair.SupportB(n, hub->b);
  return n.dot(pair.a(hub->a) - pair.b(hub->b));
}

}  // namespace drake_haptics
