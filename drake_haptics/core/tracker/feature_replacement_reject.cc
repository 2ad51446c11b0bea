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
    if (!pair.B.carrying.Holds(n_B)) return false;
    const int b = SupportVertex(pair.B, n_B, near.b);
    gap = face.normal.dot(pair.b(b)) - face.offset;
  } else {
    if (!pair.A.carrying.Holds(-n)) return false;
    const int a = SupportVertex(pair.A, -n, near.a);
    gap = n.dot(pair.a(a) - pair.X_AB.p) - face.offset;
  }
  return gap > floor - Tie(pair);
}

bool IsRepeated(const Simplex& simplex, int corner,
                int MinkowskiVertex::* side) {
  const auto begin = simplex.hubs.begin();
  return std::any_of(begin, begin + corner, [&](const MinkowskiVertex& hub) {
    return hub.*side == simplex.hubs[corner].*side;
  });
}

}  // namespace drake_haptics
