#include "pair_truth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace drake_haptics::fuzz {
namespace {

using Real = PairTruth::Real;
using RealVec3 = PairTruth::RealVec3;

constexpr Real kFar = std::numeric_limits<Real>::infinity();
// Edge pairs up to which enumeration is worth its time.
constexpr std::size_t kFewEdgePairs = 500;

RealVec3 UnitOf(const RealVec3& v) { return v / v.norm(); }

Real SegmentDistance(const RealVec3& p, const RealVec3& d, const RealVec3& q,
                     const RealVec3& e) {
  const auto clamp = [](Real x) { return std::clamp<Real>(x, 0, 1); };
  const auto to_segment = [&](const RealVec3& x, const RealVec3& o,
                              const RealVec3& along) {
    const Real length = along.squaredNorm();
    const Real t = length > 0 ? clamp((x - o).dot(along) / length) : 0;
    return (x - o - t * along).norm();
  };
  Real least = std::min({to_segment(p, q, e), to_segment(p + d, q, e),
                         to_segment(q, p, d), to_segment(q + e, p, d)});
  const RealVec3 cross = d.cross(e);
  const Real area = cross.squaredNorm();
  if (area > 0) {
    const RealVec3 w = q - p;
    const Real s = w.cross(e).dot(cross) / area;
    const Real t = w.cross(d).dot(cross) / area;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
      least = std::min(least, std::abs(w.dot(cross)) / std::sqrt(area));
    }
  }
  return least;
}

}  // namespace

PairTruth::Body PairTruth::Place(const Polytope& polytope, const Pose& X) {
  Body body{&polytope, {}, {}, {}};
  const Eigen::Matrix<Real, 3, 3> R = X.R.cast<Real>();
  const RealVec3 p = X.p.cast<Real>();
  for (const Vec3& v : polytope.vertices) {
    body.vertices.push_back(R * v.cast<Real>() + p);
  }
  for (const Polytope::Facet& facet : polytope.facets) {
    body.normals.push_back(R * facet.normal.cast<Real>());
  }
  for (const Polytope::Edge& edge : polytope.edges) {
    body.edges.push_back(body.vertices[edge.v1] - body.vertices[edge.v0]);
  }
  return body;
}

PairTruth::PairTruth(const PosedPair& pair)
    : A_(Place(pair.A, Pose())), B_(Place(pair.B, pair.X_AB)) {
  for (const Body* body : {&A_, &B_}) {
    for (const RealVec3& v : body->vertices) {
      magnitude_ = std::max(magnitude_, v.cwiseAbs().maxCoeff());
    }
  }
  for (const Vec3& v : pair.B.vertices) {
    magnitude_ = std::max<Real>(magnitude_, v.cwiseAbs().maxCoeff());
  }
  magnitude_ = std::max<Real>(magnitude_, pair.X_AB.p.cwiseAbs().maxCoeff());
}

Real PairTruth::SupportGap(const RealVec3& n) const {
  return SupportGap(n, RealVec3::Zero());
}

Real PairTruth::SupportGap(const RealVec3& n, const RealVec3& shift) const {
  Real least = kFar, most = -kFar;
  for (const RealVec3& v : A_.vertices) least = std::min(least, n.dot(v));
  for (const RealVec3& v : B_.vertices) most = std::max(most, n.dot(v));
  return least - most + n.dot(shift);
}

bool PairTruth::is_small() const {
  return A_.edges.size() * B_.edges.size() <= kFewEdgePairs;
}

template <typename Visitor>
void PairTruth::VisitNormals(const Visitor& visit) const {
  for (const RealVec3& n : A_.normals) visit(RealVec3(-n));
  for (const RealVec3& n : B_.normals) visit(n);
  for (const RealVec3& d : A_.edges) {
    for (const RealVec3& e : B_.edges) {
      const RealVec3 cross = d.cross(e);
      if (!(cross.norm() > 1e-12L * d.norm() * e.norm())) continue;
      visit(UnitOf(cross));
      visit(RealVec3(-UnitOf(cross)));
    }
  }
}

Real PairTruth::LargestGap(const RealVec3& shift) const {
  Real largest = -kFar;
  VisitNormals([&](const RealVec3& n) {
    largest = std::max(largest, SupportGap(n, shift));
  });
  return largest;
}

Real PairTruth::LargestGapBeside(const RealVec3& n, Real cosine) const {
  Real largest = -kFar;
  VisitNormals([&](const RealVec3& other) {
    if (other.dot(n) < cosine) largest = std::max(largest, SupportGap(other));
  });
  return largest;
}

Real PairTruth::VertexFacetDistance(const Body& vertices, const Body& facets) {
  Real least = kFar;
  for (std::size_t f = 0; f < facets.normals.size(); ++f) {
    const RealVec3& n = facets.normals[f];
    const auto loop = facets.polytope->loop_of(static_cast<int>(f));
    for (const RealVec3& v : vertices.vertices) {
      const Real height = n.dot(v - facets.vertices[loop[0]]);
      if (height < 0 || height >= least) continue;
      bool inside = true;
      for (std::size_t k = 0; k < loop.size() && inside; ++k) {
        const RealVec3& p = facets.vertices[loop[k]];
        const RealVec3& q = facets.vertices[loop[(k + 1) % loop.size()]];
        inside = n.dot((q - p).cross(v - p)) >= 0;
      }
      if (inside) least = height;
    }
  }
  return least;
}

Real PairTruth::EdgeEdgeDistance() const {
  Real least = kFar;
  // A vertex alone counts as an edge without length.
  const auto segments = [](const Body& body) {
    std::vector<std::pair<RealVec3, RealVec3>> result;
    for (std::size_t e = 0; e < body.edges.size(); ++e) {
      result.emplace_back(body.vertices[body.polytope->edges[e].v0],
                          body.edges[e]);
    }
    if (result.empty()) {
      result.emplace_back(body.vertices[0], RealVec3::Zero());
    }
    return result;
  };
  const auto of_B = segments(B_);
  for (const auto& [p, d] : segments(A_)) {
    for (const auto& [q, e] : of_B) {
      least = std::min(least, SegmentDistance(p, d, q, e));
    }
  }
  return least;
}

Real PairTruth::Distance() const {
  return std::min({VertexFacetDistance(A_, B_), VertexFacetDistance(B_, A_),
                   EdgeEdgeDistance()});
}

}  // namespace drake_haptics::fuzz
