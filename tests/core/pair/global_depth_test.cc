// The global depth against enumeration of every facet of A ⊖ B.
#include "pair/global_depth.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "check.h"
#include "minkowski_facets.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

using Points = std::vector<Vec3>;

std::mt19937 random_bits(7);

double Uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random_bits);
}

Vec3 Gaussian() {
  std::normal_distribution<double> normal;
  return {normal(random_bits), normal(random_bits), normal(random_bits)};
}

Mat3 AnyRotation() {
  return Eigen::AngleAxisd(Uniform(0, 2 * std::numbers::pi),
                           Gaussian().normalized())
      .toRotationMatrix();
}

Points Box(double x, double y, double z) {
  Points points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z);
  }
  return points;
}

// Nearly even points on a sphere.
Points Ball(int n, double radius) {
  Points points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z);
    points.push_back(
        radius * Vec3(r * std::cos(golden * i), r * std::sin(golden * i), z));
  }
  return points;
}

Points Polygon(int n, double radius) {
  Points points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return points;
}

Points Cloud(int n) {
  Points points;
  for (int i = 0; i < n; ++i) points.push_back(0.04 * Gaussian());
  return points;
}

std::vector<Polytope> Shapes() {
  const Points octahedron{{0.05, 0, 0},  {-0.05, 0, 0}, {0, 0.05, 0},
                          {0, -0.05, 0}, {0, 0, 0.05},  {0, 0, -0.05}};
  const Points segment{{-0.05, 0, 0}, {0.05, 0, 0}};
  std::vector<Polytope> shapes;
  for (const Points& points :
       {Box(0.05, 0.05, 0.05), Box(0.06, 0.04, 0.01), Box(0.05, 5e-4, 5e-4),
        Box(0.05, 5e-5, 5e-5), octahedron, Ball(12, 0.05), Ball(10, 0.03),
        Polygon(5, 0.05), segment, Cloud(12)}) {
    shapes.push_back(MakePolytope(points));
  }
  return shapes;
}

// A local minimum from the line that joins the centroids: often not the
// global one.
Depth LocalDepth(const PosedPair& pair, DepthWorkspace* workspace) {
  Vec3 n = pair.A.centroid - pair.X_AB * pair.B.centroid;
  if (!(n.norm() > 1e-12 * pair.scale())) n = Vec3::UnitX();
  MinkowskiVertex vertex_pair;
  SupportGap(pair, n, &vertex_pair);
  return WalkDepth(pair, vertex_pair, SurfaceRule::kWholeBoundary, nullptr, {1},
                   workspace);
}

struct Run {
  Run(const Polytope& first, const Polytope& second) : A(first), B(second) {}

  // Queries and compares, if asked to: the truth takes long. Pairs that overlap
  // by no more than round-off and parallel segments, which have no facet, are
  // passed over.
  void Query(const Pose& X_AB, bool compare = true) {
    const PosedPair pair{A, B, X_AB};
    if (!compare) {
      FindGlobalDepth(pair, LocalDepth(pair, &workspace), &state);
      return;
    }
    const double truth = EnumeratedDepth(pair);
    if (!(truth > 1e-13 * pair.scale()) || !std::isfinite(truth)) return;
    const Depth local = LocalDepth(pair, &workspace);
    CHECK(local.status == DepthStatus::kLocalMinimum);
    const GlobalDepth answer = FindGlobalDepth(pair, local, &state);
    const DepthCandidate& facet = answer.facet;
    CHECK(answer.status != GlobalDepthStatus::kBounded);
    CHECK(std::abs(-facet.h - truth) <= 1e-11 * truth + 2e-13 * pair.scale());
    // The normal is that of a facet as shallow as this, but for a tie.
    CHECK(std::abs(FullGap(pair, facet.n) - facet.h) <= 1.1e-9 * pair.scale());
    const Witness witness = WitnessOfFeatures(
        pair, facet.feature_A, facet.feature_B, facet.n, facet.h);
    CHECK((witness.p_a - witness.p_b - facet.h * facet.n).norm() <=
          1e-12 * pair.scale());
    ++num_queries;
    num_global += facet.h > local.best.h + 1e-9 * pair.scale();
  }

  const Polytope& A;
  const Polytope& B;
  GlobalDepthState state;
  DepthWorkspace workspace;
  int num_queries = 0;
  int num_global = 0;  // where the local depth was not the global one
};

// All pairs of shapes at poses without any coherence.
void Teleports() {
  const std::vector<Polytope> shapes = Shapes();
  int num_queries = 0, num_global = 0;
  for (const Polytope& A : shapes) {
    for (const Polytope& B : shapes) {
      Run run(A, B);
      for (int k = 0; k < 3; ++k) {
        const Mat3 R = k == 0 ? Mat3::Identity() : AnyRotation();
        run.Query({R, k < 2 ? Vec3::Zero() : Vec3(0.015 * Gaussian())});
      }
      num_queries += run.num_queries;
      num_global += run.num_global;
    }
  }
  CHECK(num_queries > 150);
  CHECK(num_global > 20);
}

// All pairs of shapes in slow motion, in turning and through the center, where
// the facets of all sides are equally deep.
void Tumbling() {
  const std::vector<Polytope> shapes = Shapes();
  for (const Polytope& A : shapes) {
    for (const Polytope& B : shapes) {
      Run run(A, B);
      const Vec3 axis = Gaussian().normalized();
      const Vec3 across = Gaussian().normalized();
      for (int k = -2; k <= 2; ++k) {
        const double angle = 0.01 * k;
        run.Query({Eigen::AngleAxisd(angle, axis).toRotationMatrix(),
                   1e-3 * k * across});
      }
    }
  }
}

// One pair over a longer way, so that the surface is raised and simplified
// many times.
void LongWay() {
  const Polytope A = MakePolytope(Ball(26, 0.05));
  const Polytope B = MakePolytope(Ball(22, 0.04));
  Run run(A, B);
  Mat3 R = Mat3::Identity();
  for (int k = 0; k < 400; ++k) {
    R = Eigen::Quaterniond(
            Eigen::AngleAxisd(0.01, Vec3(1, 2, std::sin(0.01 * k)).normalized())
                .toRotationMatrix() *
            R)
            .normalized()
            .toRotationMatrix();
    const double angle = 0.02 * k;
    run.Query({R, Vec3(0.07 * std::cos(angle), 0.07 * std::sin(angle),
                       0.02 * std::sin(0.3 * angle))},
              k % 25 == 0);
  }
  CHECK(run.num_queries > 14);
  CHECK(run.state.surface.num_alive() < 200);
}

// From touching by a trillionth of the size, and at other sizes.
void Shallow() {
  for (const double size : {1e-6, 1.0, 1e6}) {
    Points box = Box(0.05 * size, 0.04 * size, 0.03 * size);
    Points ball = Ball(12, 0.05 * size);
    const Polytope A = MakePolytope(box), B = MakePolytope(ball);
    Run run(A, B);
    double top = 0;
    for (const Vec3& p : B.vertices) top = std::max(top, p.z());
    for (double depth = 1e-11 * size; depth < 0.02 * size; depth *= 6) {
      run.Query({Mat3::Identity(), Vec3(0, 0, -0.03 * size - top + depth)});
    }
    CHECK(run.num_queries > 10);
  }
}

// The least depth turns from one side of a plate to the other: the normal stays
// on its side within a billionth of the size of the tie, the depth is true.
void TieKeepsTheNormal() {
  const Polytope A = MakePolytope(Box(0.05, 0.05, 0.01));
  const Polytope B = MakePolytope(Ball(12, 0.02));
  GlobalDepthState state;
  DepthWorkspace workspace;
  double last = 0;
  int num_turns = 0;
  for (int k = -40; k <= 40; ++k) {
    // To and fro over the tie by 1e-11, then away from it.
    const double z = (std::abs(k) < 30 ? 1e-11 * (k % 3) : 1e-5 * k);
    const PosedPair pair{A, B, {Mat3::Identity(), Vec3(0, 0, z)}};
    const GlobalDepth answer =
        FindGlobalDepth(pair, LocalDepth(pair, &workspace), &state);
    CHECK(std::abs(-answer.facet.h - EnumeratedDepth(pair)) < 1e-14);
    num_turns += last * answer.facet.n.z() < 0;
    last = answer.facet.n.z();
  }
  CHECK(num_turns == 1);
}

// Two polygons in one plane have a difference without interior.
void Flat() {
  const Polytope A = MakePolytope(Polygon(5, 0.05));
  const Polytope B = MakePolytope(Polygon(4, 0.03));
  GlobalDepthState state;
  DepthWorkspace workspace;
  const PosedPair pair{A, B, {Mat3::Identity(), Vec3(0.01, 0, 0)}};
  const GlobalDepth answer =
      FindGlobalDepth(pair, LocalDepth(pair, &workspace), &state);
  CHECK(answer.status == GlobalDepthStatus::kFlat);
  CHECK(answer.facet.h == 0);
  CHECK(std::abs(answer.facet.n.z()) == 1);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::Teleports();
  drake_haptics::Tumbling();
  drake_haptics::LongWay();
  drake_haptics::Shallow();
  drake_haptics::TieKeepsTheNormal();
  drake_haptics::Flat();
  return drake_haptics::FailedChecks() > 0;
}
