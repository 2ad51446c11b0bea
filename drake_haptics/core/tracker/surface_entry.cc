#include "tracker/surface_entry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "base/motion.h"
#include "pair/separation.h"
#include "tracker/feature_coverage.h"
#include "tracker/supported_facets.h"

namespace drake_haptics {
namespace {

// How far behind a facet A may have been, as a share of the size: within this,
// touching pieces may be found apart or not.
constexpr double kTouchShare = 1e-9;

// Smallest gap of a facet in front of which A may have been, m.
double LeastGap(const PosedPair& pair, const Pose& last_X_AB) {
  const Motion of_B(last_X_AB, pair.X_AB);
  const Motion of_A(last_X_AB.inverse(), pair.X_AB.inverse());
  return -std::max(of_A.Bound(pair.A.centroid, pair.A.radius),
                   of_B.Bound(pair.B.centroid, pair.B.radius)) -
         kTouchShare * pair.scale();
}

// Returns the shallowest supported facet with a gap of at least `least` that
// counts.
template <typename DoesCount>
std::optional<DepthCandidate> Shallowest(const PosedPair& pair, double least,
                                         const MinkowskiVertex& near,
                                         SurfacePairWorkspace* workspace,
                                         const DoesCount& does_count) {
  const WantedFacets wanted{{}, least};
  std::vector<DepthCandidate>& facets = workspace->supported;
  ListSupportedFacets(pair, near, {&wanted, 1}, &facets);
  std::sort(facets.begin(), facets.end(),
            [](const auto& p, const auto& q) { return p.h > q.h; });
  const auto found = std::find_if(facets.begin(), facets.end(), does_count);
  if (found == facets.end()) return std::nullopt;
  return *found;
}

// Whether a segment of P passes through an original facet of Q, in Q's frame.
bool DoesCross(const Vec3& from, const Vec3& to, const Polytope& Q) {
  for (std::size_t f = 0; f < Q.facets.size(); ++f) {
    const Polytope::Facet& facet = Q.facets[f];
    if (!facet.original) continue;
    const double start = facet.normal.dot(from) - facet.offset;
    const double end = facet.normal.dot(to) - facet.offset;
    if (!(start * end < 0)) continue;
    const Vec3 p = from + (to - from) * (start / (start - end));
    const auto loop = Q.loop_of(static_cast<int>(f));
    const std::size_t first = Q.facet_loop_start[f];
    bool is_within = true;
    for (std::size_t k = 0; is_within && k < loop.size(); ++k) {
      is_within =
          Q.facet_loop_side[first + k].dot(p - Q.vertices[loop[k]]) <= 0;
    }
    if (is_within) return true;
  }
  return false;
}

// Whether an edge of P's surface, posed in Q's frame, crosses Q's.
bool DoEdgesCross(const Polytope& P, const Polytope& Q, const Pose& X_QP) {
  return std::any_of(P.edges.begin(), P.edges.end(), [&](const auto& edge) {
    return edge.original &&
           DoesCross(X_QP * P.vertices[edge.v0], X_QP * P.vertices[edge.v1], Q);
  });
}

}  // namespace

bool LayInFront(const PosedPair& pair, const DepthCandidate& facet,
                const Pose& last_X_AB) {
  const Vec3 n = facet.feature_A.kind() == FeatureKind::kFacet
                     ? facet.n
                     : Vec3(last_X_AB.R * (pair.X_AB.R.transpose() * facet.n));
  MinkowskiVertex vertex_pair = VertexPairOf(pair, facet);
  return SupportGap({pair.A, pair.B, last_X_AB}, n, &vertex_pair) >=
         -kTouchShare * pair.scale();
}

double LongestWay(const PosedPair& pair, const Pose& last_X_AB) {
  const Pose X_BA = pair.X_AB.inverse(), last_X_BA = last_X_AB.inverse();
  double longest = 0;
  for (const Vec3& p : pair.A.vertices) {
    longest = std::max(longest, (X_BA * p - last_X_BA * p).norm());
  }
  for (const Vec3& p : pair.B.vertices) {
    longest = std::max(longest, (pair.X_AB * p - last_X_AB * p).norm());
  }
  return longest + kTouchShare * pair.scale();
}

std::optional<DepthCandidate> FindEntry(const PosedPair& pair,
                                        const SurfaceRequest& request,
                                        const MinkowskiVertex& near,
                                        SurfacePairWorkspace* workspace) {
  if (request.is_any_way_out) {
    return Shallowest(pair, kNoFloor, near, workspace,
                      [](const auto&) { return true; });
  }
  return Shallowest(pair, LeastGap(pair, request.last_X_AB), near, workspace,
                    [&](const auto& facet) {
                      return LayInFront(pair, facet, request.last_X_AB) &&
                             IsWithinFeatures(pair, facet, request.tolerance,
                                              &workspace->patch);
                    });
}

std::optional<DepthCandidate> FindWayOut(const PosedPair& pair,
                                         double tolerance,
                                         SurfacePairWorkspace* workspace) {
  if (pair.A.dimension < 2 || pair.B.dimension < 2) return std::nullopt;
  const Separation separation = ComputeSeparation(pair, {}, 0);
  if (separation.status != SeparationStatus::kTouching) return std::nullopt;
  // A facet without depth separates the pieces: without an overlap there is no
  // way out, least of all one through the far side.
  const auto way = Shallowest(
      pair, kNoFloor, separation.simplex.vertex_pairs[0], workspace,
      [&](const auto& facet) {
        return facet.h >= 0 ||
               IsWithinFeatures(pair, facet, tolerance, &workspace->patch);
      });
  return way && way->h < 0 ? way : std::nullopt;
}

bool DoSurfacesCross(const PosedPair& pair) {
  return DoEdgesCross(pair.A, pair.B, pair.X_AB.inverse()) ||
         DoEdgesCross(pair.B, pair.A, pair.X_AB);
}

}  // namespace drake_haptics
