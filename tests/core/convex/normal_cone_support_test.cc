// Which contacts the surface of a polytope carries at its edges and vertices.
#include "convex/normal_cone_support.h"

#include <vector>

#include "check.h"

namespace drake_haptics {
namespace {

Polytope Octahedron(const Vec3& half) {
  std::vector<Vec3> points;
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      points.push_back(sign * half[i] * Vec3::Unit(i));
    }
  }
  return MakePolytope(points);
}

// What the vertices or edges that are farthest along n carry along it, against
// the facet of a large body that faces them.
NormalConeSupport SupportAlong(const Polytope& P, const Vec3& n) {
  const Polytope wall =
      MakePolytope(std::vector{Vec3(0, 0, 0), Vec3(9, 0, 0), Vec3(0, 9, 0)});
  double most = -1e9;
  for (const Vec3& v : P.vertices) most = std::max(most, n.dot(v));
  std::vector<int> farthest;
  for (int v = 0; v < P.num_vertices(); ++v) {
    if (n.dot(P.vertices[v]) > most - 1e-12) farthest.push_back(v);
  }
  const Feature feature = FeatureOfVertices(
      P, farthest.data(), static_cast<int>(farthest.size()), n);
  return ClassifySupport(P, feature, -n, wall, {FeatureKind::kFacet, 0}, n);
}

// What is sharper than the slack ends there all the same: the directions out of
// it are nearly in its faces.
void BladesAndNeedlesCarryOutward() {
  const Polytope blade = Octahedron({1e-5, 1, 1});
  const Polytope needle = Octahedron({1, 1e-5, 1e-5});
  CHECK(SupportAlong(blade, Vec3::UnitY()) == NormalConeSupport::kSupported);
  CHECK(SupportAlong(blade, Vec3(0, 1, 1).normalized()) ==
        NormalConeSupport::kSupported);
  CHECK(SupportAlong(needle, Vec3::UnitX()) == NormalConeSupport::kSupported);
}

// Into the body nothing is carried, by whatever feature.
void NothingIsCarriedInward() {
  const Polytope wall =
      MakePolytope(std::vector{Vec3(0, 0, 0), Vec3(9, 0, 0), Vec3(0, 9, 0)});
  for (const Vec3& half : {Vec3(1e-5, 1, 1), Vec3(1, 1e-5, 1e-5), Vec3(1, 1, 1),
                           Vec3(1e-4, 1, 1)}) {
    const Polytope P = Octahedron(half);
    for (int v = 0; v < P.num_vertices(); ++v) {
      const Vec3 inward = -P.vertices[v].normalized();
      CHECK(ClassifySupport(P, {FeatureKind::kVertex, v}, -inward, wall,
                            {FeatureKind::kFacet, 0},
                            inward) != NormalConeSupport::kSupported);
    }
    for (int e = 0; e < static_cast<int>(P.edges.size()); ++e) {
      const Vec3 inward =
          (P.edges[e].wings[0] + P.edges[e].wings[1]).normalized();
      CHECK(ClassifySupport(P, {FeatureKind::kEdge, e}, -inward, wall,
                            {FeatureKind::kFacet, 0},
                            inward) == NormalConeSupport::kVirtual);
    }
  }
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::BladesAndNeedlesCarryOutward();
  drake_haptics::NothingIsCarriedInward();
  return drake_haptics::FailedChecks() > 0;
}
