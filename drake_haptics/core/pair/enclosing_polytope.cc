#include "pair/enclosing_polytope.h"

#include <Eigen/Geometry>
#include <array>
#include <limits>

#include "pair/pair_contact_builders.h"

namespace drake_haptics {
namespace {

constexpr int kMaxGrowth = 1024;
// Height that is round-off, as a share of the size.
constexpr double kThinShare = 1e-13;

class Growth {
 public:
  Growth(const PosedPair& pair, DepthCertificate* surface)
      : pair_(pair), surface_(*surface), flat_(kThinShare * pair.scale()) {}

  bool Run(const DepthCandidate& facet) {
    Start(facet);
    for (int raises = 0; raises < kMaxGrowth; ++raises) {
      for (const int t : surface_.added()) Measure(t);
      const int t = Lowest();
      const double height = surface_.keys()[t];
      if (height > flat_) return true;
      MinkowskiVertex vertex_pair = surface_.vertex_pair(t, 0);
      const double support = -SupportGap(pair_, -Normal(t), &vertex_pair);
      if (!(support > height + flat_) ||
          !surface_.Raise(t, vertex_pair, nullptr)) {
        return false;
      }
    }
    return false;
  }

 private:
  void Start(const DepthCandidate& facet) {
    std::array<MinkowskiVertex, 4> vertex_pairs;
    std::array<Vec3, 3> p;
    const auto spanning =
        SpanningVertices(pair_, facet.feature_A, facet.feature_B);
    for (int k = 0; k < 3; ++k) {
      vertex_pairs[k] = spanning[k];
      p[k] = pair_.a(vertex_pairs[k].a) - pair_.b(vertex_pairs[k].b);
    }
    // The outward normal of A ⊖ B is opposite to n.
    if ((p[1] - p[0]).cross(p[2] - p[0]).dot(facet.n) > 0) {
      std::swap(vertex_pairs[1], vertex_pairs[2]);
    }
    vertex_pairs[3] = vertex_pairs[0];
    SupportGap(pair_, -facet.n, &vertex_pairs[3]);
    surface_.StartTetrahedron(vertex_pairs);
  }

  Vec3 Normal(int t) {
    const Vec3& p = surface_.point(t, 0);
    return (surface_.point(t, 1) - p)
        .cross(surface_.point(t, 2) - p)
        .normalized();
  }

  // A triangle's key is the height of its plane over the origin; one without
  // area bounds nothing.
  void Measure(int t) {
    const Vec3 n = Normal(t);
    surface_.set_key(t, n.squaredNorm() > 0.5
                            ? n.dot(surface_.point(t, 0))
                            : std::numeric_limits<double>::infinity());
  }

  int Lowest() const {
    const auto keys = surface_.keys();
    int lowest = 0;
    for (int t = 1; t < surface_.num_slots(); ++t) {
      if (keys[t] < keys[lowest]) lowest = t;
    }
    return lowest;
  }

  const PosedPair& pair_;
  DepthCertificate& surface_;
  const double flat_;
};

}  // namespace

bool GrowEnclosingPolytope(const PosedPair& pair, const DepthCandidate& facet,
                           DepthCertificate* surface) {
  return Growth(pair, surface).Run(facet) &&
         surface->WindingNumber(RayBehind(facet)) == 1;
}

Vec3 RayBehind(const DepthCandidate& facet) {
  const Vec3 side = facet.n.unitOrthogonal();
  return facet.n + 0.11 * side + 0.07 * facet.n.cross(side);
}

}  // namespace drake_haptics
