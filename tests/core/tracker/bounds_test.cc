// Searches that meet their bounds: they end, hold their promise, and say so.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "check.h"
#include "pair/gauss_overlay_reject.h"
#include "pair/pair_contact_builders.h"
#include "pair/separation.h"
#include "tracker/piece_bvh.h"

namespace drake_haptics {
namespace {

std::mt19937 generator(0);

Vec3 RandomDirection() {
  std::normal_distribution<double> normal;
  return Vec3(normal(generator), normal(generator), normal(generator))
      .normalized();
}

Polytope Ball(int num_vertices) {
  std::vector<Vec3> points;
  for (int i = 0; i < num_vertices; ++i) points.push_back(RandomDirection());
  return MakePolytope(points);
}

void SeparationSaysThatItWasBounded() {
  int num_bounded = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Polytope A = Ball(200), B = Ball(200);
    const PosedPair pair{A, B, {Mat3::Identity(), 2.5 * RandomDirection()}};
    const Separation whole = ComputeSeparation(pair, {}, 10);
    CHECK(!whole.is_bounded);
    CHECK(whole.is_proven);
    const Separation cut = ComputeSeparation(pair, {}, 10, 2);
    CHECK(cut.status == SeparationStatus::kApart);
    CHECK(cut.is_bounded == !cut.is_proven);
    CHECK(cut.distance > whole.distance - 1e-12);
    const ContactStatus status = ContactApart(pair, cut).status;
    CHECK((status == ContactStatus::kBounded) == cut.is_bounded);
    num_bounded += cut.is_bounded;
  }
  CHECK(num_bounded > 50);
}

// A cone over a regular polygon: its tip has a region of so many corners.
Polytope Cone(int num_sides, double height) {
  std::vector<Vec3> points{Vec3(0, 0, height)};
  for (int i = 0; i < num_sides; ++i) {
    const double angle = 2 * M_PI * i / num_sides;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return MakePolytope(points);
}

// With as many corners as are clipped, and as many clips as are made.
void ClippingHasRoomForItsCorners() {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 3000; ++trial) {
    const Polytope A = Cone(18, 0.3 + 0.2 * uniform(generator));
    const Polytope B = Cone(18, 0.3 + 0.2 * uniform(generator));
    const Vec3 axis = RandomDirection();
    Pose X_AB;
    X_AB.R =
        Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix() *
        Eigen::AngleAxisd(0.3 * uniform(generator), axis).toRotationMatrix();
    X_AB.p = Vec3(0, 0, 0.5);
    const PosedPair pair{A, B, X_AB};
    MinkowskiVertex vertex_pair;
    SupportGap(pair, -Vec3::UnitZ(), &vertex_pair);
    const Vec3 w = 0.3 * RandomDirection();
    OverlayMayExceed(pair, vertex_pair, w, -1e-3);
  }
}

int Depth(const PieceBvh& tree, int node) {
  const PieceBvh::Node& at = tree.node(node);
  if (at.is_leaf()) return 0;
  return 1 + std::max(Depth(tree, at.left), Depth(tree, at.right));
}

// Boxes whose fits are all alike, and a row in which each fits best with those
// before it.
void TreesAreNoDeeperThanALogarithm() {
  const Polytope cube = MakePolytope(std::vector<Vec3>{
      Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0),
      Vec3(0, 1, 1), Vec3(1, 0, 1), Vec3(1, 1, 1)});
  const auto moved = [&cube](double x) {
    Polytope piece = cube;
    for (Vec3& v : piece.vertices) v.x() += x;
    return piece;
  };
  const int count = 512;
  for (const int power : {0, 1, 2, 3}) {
    std::vector<Polytope> pieces;
    for (int i = 0; i < count; ++i) {
      pieces.push_back(moved(power == 0 ? 0 : std::pow(i, power)));
    }
    const PieceBvh tree(pieces);
    CHECK(Depth(tree, tree.root()) <= 4 * std::log2(count));
    // Nothing is lost on the way.
    for (int i = 0; i < count; ++i) {
      CHECK(tree.box_of(i).center.x() == pieces[i].vertices[0].x() + 0.5);
    }
  }
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::SeparationSaysThatItWasBounded();
  drake_haptics::ClippingHasRoomForItsCorners();
  drake_haptics::TreesAreNoDeeperThanALogarithm();
  return drake_haptics::FailedChecks() > 0;
}
