#include "pair/local_penetration_walk.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "pair/gauss_overlay.h"
#include "pair/minkowski_facet_vertices.h"
#include "pair/warm_facet.h"

namespace drake_haptics {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

class Walk {
 public:
  Walk(const PosedPair& pair, SurfaceRule rule, const WalkBounds& bounds,
       DepthWorkspace* workspace)
      : pair_(pair), rule_(rule), bounds_(bounds), workspace_(*workspace) {
    workspace_.visited.clear();
    workspace_.candidates.clear();
    workspace_.closed.clear();
  }

  Depth Run(const MinkowskiVertex& start, const Revisit* known) {
    if (known != nullptr) Add(known->facet);
    if (best_ < 0 || IsOpen(*known, start)) Visit(start);
    Depth result;
    result.vertex_pair = start;
    // Each round visits the vertex pairs of one facet: the best supported one
    // or, while there is none, the best of the others not yet visited.
    for (int num_steps = 0;;) {
      const int target = best_ >= 0 ? best_ : BestOpen();
      if (target < 0) break;
      const int before = best_;
      const bool may_step = best_ < 0 || num_steps++ < bounds_.max_steps;
      if (!may_step ||
          !VisitVertexPairsOf(target, target == 0 ? known : nullptr,
                              &result.vertex_pair)) {
        result.status = DepthStatus::kBounded;
        break;
      }
      if (best_ >= 0 && best_ == before) {
        result.status = DepthStatus::kLocalMinimum;
        result.clearance = clearance_;
        break;
      }
      if (best_ < 0) workspace_.closed[target] = 1;
    }
    const int answer = best_ >= 0 ? best_ : BestUnsupported();
    if (answer < 0) return result;
    result.best = workspace_.candidates[answer];
    result.shallowest = result.best.h;
    for (const DepthCandidate& candidate : workspace_.candidates) {
      result.shallowest = std::max(result.shallowest, candidate.h);
    }
    if (result.status == DepthStatus::kNoFacet) {
      result.status = DepthStatus::kLocalMinimum;
    }
    result.vertex_pair = {pair_.A.first_vertex_of(result.best.feature_A),
                          pair_.B.first_vertex_of(result.best.feature_B)};
    return result;
  }

 private:
  void Visit(const MinkowskiVertex& vertex_pair) {
    workspace_.visited.push_back(vertex_pair);
    const std::size_t first = workspace_.candidates.size();
    // Once a supported answer is known, only better ones count.
    const double floor =
        best_ >= 0 ? workspace_.candidates[best_].h + Tie(pair_) : kNone;
    OverlayGaussRegions(pair_, vertex_pair, rule_, floor, &workspace_);
    Take(first);
  }

  void Add(const DepthCandidate& candidate) {
    workspace_.candidates.push_back(candidate);
    Take(workspace_.candidates.size() - 1);
  }

  // Updates the best candidate with the candidates from `first` on.
  void Take(std::size_t first) {
    workspace_.closed.resize(workspace_.candidates.size(), 0);
    const double tie = Tie(pair_);
    for (std::size_t i = first; i < workspace_.candidates.size(); ++i) {
      const DepthCandidate& candidate = workspace_.candidates[i];
      if (candidate.support != NormalConeSupport::kSupported) continue;
      if (best_ < 0 || candidate.h > workspace_.candidates[best_].h + tie) {
        best_ = static_cast<int>(i);
      }
    }
  }

  static bool IsOpen(const Revisit& facet, const MinkowskiVertex& vertex_pair) {
    const auto end = facet.open.begin() + facet.num_open;
    return !facet.has_list ||
           std::find(facet.open.begin(), end, vertex_pair) != end;
  }

  // Lists the vertex pairs of a facet around which a better one may be.
  void ListOpen(const DepthCandidate& facet, const Revisit* known) {
    if (best_ >= 0) {
      const Revisit again =
          known != nullptr
              ? *known
              : RevisitFacet(pair_, SurfaceRule::kWholeBoundary,
                             facet.feature_A, facet.feature_B, facet.n);
      clearance_ = again.clearance;
      if (again.status == RevisitStatus::kMinimum || again.has_list) {
        workspace_.corners.assign(again.open.begin(),
                                  again.open.begin() + again.num_open);
        return;
      }
    }
    ListMinkowskiFacetVertices(pair_, facet.feature_A, facet.feature_B, facet.n,
                               &workspace_.corners);
  }

  // Visits the vertex pairs of a facet around which a better one may be;
  // returns false if the bound on vertex pairs without an answer stops it.
  // @param known the facet's revisit, or null.
  bool VisitVertexPairsOf(int target, const Revisit* known,
                          MinkowskiVertex* last) {
    const DepthCandidate facet = workspace_.candidates[target];
    ListOpen(facet, known);
    for (const MinkowskiVertex& vertex_pair : workspace_.corners) {
      const auto& visited = workspace_.visited;
      if (std::find(visited.begin(), visited.end(), vertex_pair) !=
          visited.end()) {
        continue;
      }
      if (best_ < 0 && static_cast<int>(visited.size()) >=
                           bounds_.max_promotion_vertex_pairs) {
        return false;
      }
      Visit(vertex_pair);
      *last = vertex_pair;
    }
    return true;
  }

  int BestOpen() const {
    int best = -1;
    for (std::size_t i = 0; i < workspace_.candidates.size(); ++i) {
      if (workspace_.closed[i]) continue;
      if (best < 0 ||
          workspace_.candidates[i].h > workspace_.candidates[best].h) {
        best = static_cast<int>(i);
      }
    }
    return best;
  }

  int BestUnsupported() const {
    int best = -1;
    for (std::size_t i = 0; i < workspace_.candidates.size(); ++i) {
      const DepthCandidate& candidate = workspace_.candidates[i];
      if (best < 0) {
        best = static_cast<int>(i);
        continue;
      }
      const DepthCandidate& other = workspace_.candidates[best];
      if (candidate.support > other.support ||
          (candidate.support == other.support && candidate.h > other.h)) {
        best = static_cast<int>(i);
      }
    }
    return best;
  }

  const PosedPair& pair_;
  const SurfaceRule rule_;
  const WalkBounds bounds_;
  DepthWorkspace& workspace_;
  int best_ = -1;          // the best candidate that both surfaces support
  double clearance_ = -1;  // of the last facet whose vertex pairs were listed
};

}  // namespace

Depth WalkDepth(const PosedPair& pair, const MinkowskiVertex& start,
                SurfaceRule rule, const Revisit* known,
                const WalkBounds& bounds, DepthWorkspace* workspace) {
  assert(start.a >= 0 && start.a < pair.A.num_vertices());
  assert(start.b >= 0 && start.b < pair.B.num_vertices());
  return Walk(pair, rule, bounds, workspace).Run(start, known);
}

}  // namespace drake_haptics
