#include "pair_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "draw.h"
#include "pair_truth.h"

namespace drake_haptics::fuzz {
namespace {

using Real = PairTruth::Real;
using RealVec3 = PairTruth::RealVec3;

constexpr int kAnswerProbes = 12;
// How far a witness of flush faces may be beside its body, as a share of the
// size: the tilt to which faces count as flush, and round-off.
constexpr double kFlushShare = 1e-8;

bool IsFinite(const PairContact& answer) {
  return std::isfinite(answer.distance) && answer.n.allFinite() &&
         answer.p_a.allFinite() && answer.p_b.allFinite();
}

bool Exists(const Polytope& P, Feature feature) {
  if (feature.is_none()) return false;
  const std::size_t count =
      feature.kind() == FeatureKind::kVertex ? P.vertices.size()
      : feature.kind() == FeatureKind::kEdge ? P.edges.size()
                                             : P.facets.size();
  return feature.index() < static_cast<int>(count);
}

double HeightAbove(const Polytope& P, const Vec3& point) {
  double height = 0;
  for (const Polytope::Facet& facet : P.facets) {
    height = std::max(height, facet.normal.dot(point) - facet.offset);
  }
  return height;
}

}  // namespace

double Tolerance(const PosedPair& pair, double distance) {
  const double magnitude = static_cast<double>(PairTruth(pair).magnitude());
  return 1e-9 * (pair.scale() + std::abs(distance)) + 1e-14 * magnitude;
}

void CheckAnswer(const PosedPair& pair, const PairContact& answer,
                 ByteSource* probes, Tally* tally) {
  ++tally->queries;
  ++(answer.distance > 0 ? tally->apart : tally->overlapping);
  const bool is_bounded = answer.status == ContactStatus::kBounded;
  tally->bounded += is_bounded;
  const double d = answer.distance;
  const Vec3& n = answer.n;
  if (!IsFinite(answer)) {
    tally->Violated("not finite", "d = %g, n = %g %g %g", d, n.x(), n.y(),
                    n.z());
    return;
  }
  if (std::abs(n.norm() - 1) > 1e-12) {
    tally->Violated("unit normal", "|n| - 1 = %g, d = %g", n.norm() - 1, d);
  }
  if (!Exists(pair.A, answer.feature_A) || !Exists(pair.B, answer.feature_B)) {
    tally->Violated("features exist", "%d of A, %d of B",
                    answer.feature_A.code(), answer.feature_B.code());
  }
  const PairTruth truth(pair);
  const double tolerance =
      1e-9 * (pair.scale() + std::abs(d)) + 1e-14 * truth.magnitude();
  const double mismatch = (answer.p_a - answer.p_b - d * n).norm();
  if (!(mismatch <= tolerance)) {
    tally->Violated("p_a - p_b = d n", "off by %g, d = %g, tolerance %g",
                    mismatch, d, tolerance);
  }
  const double beside =
      std::max(HeightAbove(pair.A, answer.p_a),
               HeightAbove(pair.B, pair.X_AB.inverse() * answer.p_b));
  if (!is_bounded && !(beside <= tolerance + kFlushShare * pair.scale())) {
    tally->Violated("witness on its body", "beside by %g, d = %g, size %g",
                    beside, d, pair.scale());
  }

  const RealVec3 n_real = n.cast<Real>();
  const double off = static_cast<double>(truth.SupportGap(n_real) - d);
  if (!(std::abs(off) <= tolerance)) {
    tally->Violated("d = h(n)", "h(n) - d = %g, d = %g, tolerance %g", off, d,
                    tolerance);
  }
  if (is_bounded) return;
  const RealVec3 zero = RealVec3::Zero();
  const RealVec3 to_touch = -static_cast<Real>(d) * n_real;
  Real still_apart = truth.is_small() ? truth.LargestGap(to_touch) : 0;
  Real apart = truth.is_small() && d <= 0 ? truth.LargestGap(zero) : 0;
  for (int i = 0; i < kAnswerProbes; ++i) {
    const Vec3 direction = DrawDirection(probes);
    const double turn = probes->Flag() ? 1 : probes->Power(-12, -1);
    const RealVec3 tilted = n_real + (turn * direction).cast<Real>();
    if (!(tilted.norm() > 1e-3)) continue;
    const RealVec3 probe = tilted / tilted.norm();
    still_apart = std::max(still_apart, truth.SupportGap(probe, to_touch));
    if (d <= 0) apart = std::max(apart, truth.SupportGap(probe));
  }
  if (!(still_apart <= tolerance)) {
    tally->Violated(d > 0 ? "nearest points" : "local minimum",
                    "moved by -d n still apart by %Lg, d = %g, tolerance %g",
                    still_apart, d, tolerance);
  }
  if (!(apart <= tolerance)) {
    tally->Violated("overlap", "apart by %Lg, d = %g, tolerance %g", apart, d,
                    tolerance);
  }
}

}  // namespace drake_haptics::fuzz
