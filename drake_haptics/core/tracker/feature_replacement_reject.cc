#include "tracker/feature_replacement_reject.h"

#include <algorithm>

#include "pair/gauss_overlay.h"

namespace drake_haptics {

bool MayReplaceFeature(const PosedPair& pair, const Vec3& n, int facet,
                       bool is_of_A, const MinkowskiVertex& near,
                       double floor) {
  const Polytope::Facet& face = (is_of_A ? pair.A : pair.B).facets[facet];
  if (!face.original) return false;
  const Mat3& R = pair.X_AB.R;
  double gap;
  if (is_of_A) {
    const Vec3 n_B = R.transpose() * n;
    if (!pair.B.normal_cone.Holds(n_B)) return false;
    const int b = SupportVertex(pair.B, n_B, near.b);
    gap = face.normal.dot(pair.b(b)) - face.offset;
  } else {
    if (!pair.A.normal_cone.Holds(-n)) return false;
    const int a = SupportVertex(pair.A, -n, near.a);
    gap = n.dot(pair.a(a) - pair.X_AB.p) - face.offset;
  }
  return gap > floor - Tie(pair);
}

bool IsRepeated(const Simplex& simplex, int corner,
                int MinkowskiVertex::* side) {
  const auto begin = simplex.vertex_pairs.begin();
  return std::any_of(
      begin, begin + corner, [&](const MinkowskiVertex& vertex_pair) {
        return vertex_pair.*side == simplex.vertex_pairs[corner].*side;
      });
}

}  // namespace drake_haptics
