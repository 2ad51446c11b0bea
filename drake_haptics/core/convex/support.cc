#include "convex/support.h"

#include <cassert>

namespace drake_haptics {
namespace {

// Whether a gain along a direction is more than the round-off of the product.
// An absolute threshold would end the climb at edges that are short compared
// with the polytope.
bool IsGain(double gain, const Vec3& direction, const Vec3& along) {
  constexpr double kRoundOff = 4e-16;
  return gain > kRoundOff * direction.cwiseProduct(along).cwiseAbs().sum();
}

}  // namespace

int SupportVertex(const Polytope& polytope, const Vec3& direction, int start) {
  // Every vertex is extreme, so a vertex that no neighbor beats is the farthest
  // one. The bound ends cycles that round-off allows.
  assert(start >= 0 && start < polytope.num_vertices());
  int best = start;
  for (int left = polytope.num_vertices(); left > 0; --left) {
    double most = 0;
    int next = -1;
    const auto consider = [&](const auto& edge) {
      const double gain = direction.dot(edge.along);
      if (gain > most && IsGain(gain, direction, edge.along)) {
        most = gain;
        next = edge.neighbor;
      }
    };
    for (const auto& ring_entry : polytope.fan_of(best)) consider(ring_entry);
    if (next < 0) {
      for (const auto& edge : polytope.hidden_of(best)) consider(edge);
    }
    if (next < 0) break;
    best = next;
  }
  return best;
}

double SupportGap(const PosedPair& pair, const Vec3& n,
                  MinkowskiVertex* vertex_pair) {
  vertex_pair->a = SupportVertex(pair.A, -n, vertex_pair->a);
  vertex_pair->b =
      SupportVertex(pair.B, pair.X_AB.R.transpose() * n, vertex_pair->b);
  return n.dot(pair.a(vertex_pair->a) - pair.b(vertex_pair->b));
}

}  // namespace drake_haptics
