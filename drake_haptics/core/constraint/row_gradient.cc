#include "constraint/row_gradient.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drake_haptics {
namespace {

// Distance from a feature within which a point lies on it, as a share of the
// piece's size.
constexpr double kOnFeature = 1e-9;
// Likewise for facets, which are flat within a tolerance.
constexpr double kOnFacet = 2e-6;
// Directions that are more nearly parallel do not fix a point.
constexpr double kParallel = 1e-6;

// Directions in which a point may move on the smallest feature of a piece that
// it lies on; empty on a vertex and off the surface.
std::vector<Vec3> DirectionsAt(const Polytope& P, const Vec3& p) {
  const double near = kOnFeature * P.radius;
  for (const Vec3& vertex : P.vertices) {
    if ((p - vertex).norm() < near) return {};
  }
  for (const Polytope::Edge& edge : P.edges) {
    const Vec3 along = P.vertices[edge.v1] - P.vertices[edge.v0];
    const Vec3 u = along.normalized(), from = p - P.vertices[edge.v0];
    const double place = from.dot(u);
    if (place > 0 && place < along.norm() && (from - place * u).norm() < near) {
      return {u};
    }
  }
  for (const Polytope::Facet& facet : P.facets) {
    if (std::abs(facet.normal.dot(p) - facet.offset) < kOnFacet * P.radius) {
      const Vec3 u = facet.normal.unitOrthogonal();
      return {u, facet.normal.cross(u)};
    }
  }
  return {};
}

// Point at which B supports a row: the row's point or, if that is beside B, as
// of a turned plane, the nearest vertex at the same height.
Vec3 PointOfB(const Polytope& B, const Vec3& p, const Vec3& n) {
  const double near = kOnFeature * B.radius;
  if (std::all_of(B.facets.begin(), B.facets.end(), [&](const auto& facet) {
        return facet.normal.dot(p) < facet.offset + near;
      })) {
    return p;
  }
  Vec3 nearest = p;
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : B.vertices) {
    const double distance = (vertex - p).norm();
    if (distance < least && std::abs(n.dot(vertex - p)) < near) {
      nearest = vertex;
      least = distance;
    }
  }
  return nearest;
}

}  // namespace

ContactOf<AutoDiff> DifferentiatePieces(const PairContact& pair,
                                        const PiecePair& pieces,
                                        const DisplacedShape& tool,
                                        const DisplacedShape& object) {
  Contact contact = InWorld(pair, ValuesOf(tool.X_WB));
  contact.piece_A = pieces.a;
  contact.piece_B = pieces.b;
  contact.flushness = 0;
  return DifferentiateContacts({{contact}, 0}, 0, tool, {object}).contacts[0];
}

MovingRow DifferentiateRow(const ConstraintRow& row, const PiecePair& pieces,
                           const Vec3Of<AutoDiff>& n,
                           const DisplacedShape& tool,
                           const DisplacedShape& object) {
  const Pose X_WT = ValuesOf(tool.X_WB), X_WO = ValuesOf(object.X_WB);
  const Vec3 p_a = X_WT.inverse() * row.p_WCa;
  const Polytope& B = object.shape->pieces[pieces.b];
  const Vec3 p_b =
      PointOfB(B, X_WO.inverse() * row.p_WCb, X_WO.R.transpose() * row.n);
  std::vector<Vec3> along_A = DirectionsAt(tool.shape->pieces[pieces.a], p_a);
  std::vector<Vec3> along_B = DirectionsAt(B, p_b);
  // Two conditions fix the points, so the one on the smaller feature rests.
  if (along_A.size() + along_B.size() > 2) {
    (along_B.size() < along_A.size() ? along_B : along_A).clear();
  }
  MovingRow moving;
  moving.n = n;
  moving.p_WCa = tool.X_WB * Vec3Of<AutoDiff>(p_a.cast<AutoDiff>());
  moving.p_WCb = object.X_WB * Vec3Of<AutoDiff>(p_b.cast<AutoDiff>());
  // Offset by which the points are no longer opposite each other, and the
  // slides that remove it.
  const Vec3Of<AutoDiff> gap = moving.p_WCa - moving.p_WCb;
  Vec3Of<AutoDiff> off = gap - n * AutoDiff(n.dot(gap));
  SetValues(Vec3::Zero(), 0, &off);
  const Mat3 across = Mat3::Identity() - row.n * row.n.transpose();
  Eigen::Matrix<double, 3, Eigen::Dynamic> slides(
      3, along_A.size() + along_B.size());
  Eigen::Index column = 0;
  for (const Vec3& u : along_A) slides.col(column++) = X_WT.R * u;
  for (const Vec3& u : along_B) slides.col(column++) = -(X_WO.R * u);
  if (column > 0) {
    // The pseudoinverse Pᵀ (P Pᵀ)⁺, in the principal axes of P Pᵀ.
    const Eigen::Matrix<double, 3, Eigen::Dynamic> P = across * slides;
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(
        P.lazyProduct(P.transpose()));
    const Vec3 squares = axes.eigenvalues();
    const double least = kParallel * kParallel * squares[2];
    const Vec3 inverses =
        squares.unaryExpr([&](double x) { return x > least ? 1 / x : 0.0; });
    const Mat3 inverse = axes.eigenvectors() * inverses.asDiagonal() *
                         axes.eigenvectors().transpose();
    const Eigen::Matrix<double, Eigen::Dynamic, 3> places_inverse =
        P.transpose().lazyProduct(inverse);
    const VectorOf<AutoDiff> slid = -(places_inverse.cast<AutoDiff>() * off);
    const auto num_A = static_cast<Eigen::Index>(along_A.size());
    for (Eigen::Index i = 0; i < column; ++i) {
      const Vec3Of<AutoDiff> slide =
          slides.col(i).cast<AutoDiff>() * AutoDiff(slid[i]);
      if (i < num_A) {
        moving.p_WCa += slide;
      } else {
        moving.p_WCb -= slide;
      }
    }
  }
  moving.distance = n.dot(moving.p_WCa - moving.p_WCb);
  moving.distance.value() = row.distance;
  const Vec3Of<AutoDiff> arm = moving.p_WCa - tool.X_WB.p;
  moving.a << arm.cross(n), n;
  SetValues(row.a, 0, &moving.a);
  // The forces on both bodies act on one line along the normal.
  moving.p_WCb = moving.p_WCa - moving.distance * n;
  return moving;
}

}  // namespace drake_haptics
