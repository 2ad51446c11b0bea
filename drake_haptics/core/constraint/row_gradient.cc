#include "constraint/row_gradient.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

namespace drake_haptics {
namespace {

// A point so near to a feature lies on it, as a share of the piece's size.
constexpr double kOnFeature = 1e-9;
// Directions that are nearly one do not fix a place.
constexpr double kParallel = 1e-6;

// The directions in which a point may move on the smallest feature of a piece
// that it lies on; none where it lies on a vertex, or on nothing.
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
    if (std::abs(facet.normal.dot(p) - facet.offset) < 1e3 * near) {
      const Vec3 u = facet.normal.unitOrthogonal();
      return {u, facet.normal.cross(u)};
    }
  }
  return {};
}

Pose ValuesOf(const PoseOf<AutoDiff>& X) {
  return {drake_haptics::ValuesOf(X.R), drake_haptics::ValuesOf(X.p)};
}

}  // namespace

ContactOf<AutoDiff> DifferentiatePlane(const SeparatingPlane& plane,
                                       const DisplacedShape& tool,
                                       const DisplacedShape& object) {
  Contact contact = InWorld(plane.contact, ValuesOf(tool.X_WB));
  contact.piece_A = plane.pieces.a;
  contact.piece_B = plane.pieces.b;
  contact.flushness = 0;
  return DifferentiateContacts({{contact}, 0}, 0, tool, {object}).contacts[0];
}

MovingRow DifferentiateRow(const ConstraintRow& row,
                           const SeparatingPlane& plane,
                           const DisplacedShape& tool,
                           const DisplacedShape& object) {
  const Pose X_WT = ValuesOf(tool.X_WB), X_WO = ValuesOf(object.X_WB);
  const Vec3 p_a = X_WT.inverse() * row.p_WCa;
  const Vec3 p_b = X_WO.inverse() * row.p_WCb;
  std::vector<Vec3> along_A =
      DirectionsAt(tool.shape->pieces[plane.pieces.a], p_a);
  std::vector<Vec3> along_B =
      DirectionsAt(object.shape->pieces[plane.pieces.b], p_b);
  // Two conditions place the points: the one on the smaller feature rests.
  if (along_A.size() + along_B.size() > 2) {
    (along_B.size() < along_A.size() ? along_B : along_A).clear();
  }
  MovingRow moving;
  moving.n = DifferentiatePlane(plane, tool, object).nhat_BA_W;
  moving.p_WCa = tool.X_WB * Vec3Of<AutoDiff>(p_a.cast<AutoDiff>());
  moving.p_WCb = object.X_WB * Vec3Of<AutoDiff>(p_b.cast<AutoDiff>());
  Vec3Of<AutoDiff> gap = moving.p_WCa - moving.p_WCb;
  // By what they are no longer opposite each other, and how they make up for
  // it.
  const Vec3Of<AutoDiff> off = gap - moving.n * AutoDiff(moving.n.dot(gap));
  const Mat3 across = Mat3::Identity() - row.n * row.n.transpose();
  Eigen::Matrix<double, 3, Eigen::Dynamic> slides(
      3, along_A.size() + along_B.size());
  Eigen::Index column = 0;
  for (const Vec3& u : along_A) slides.col(column++) = X_WT.R * u;
  for (const Vec3& u : along_B) slides.col(column++) = -(X_WO.R * u);
  if (column > 0) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> places(across *
                                                                   slides);
    places.setThreshold(kParallel);
    const Eigen::MatrixXd pseudo_inverse = places.pseudoInverse();
    const VectorOf<AutoDiff> slid = -(pseudo_inverse.cast<AutoDiff>() * off);
    for (Eigen::Index i = 0; i < column; ++i) {
      const Vec3Of<AutoDiff> slide =
          slides.col(i).cast<AutoDiff>() * AutoDiff(slid[i]);
      if (i < static_cast<Eigen::Index>(along_A.size())) {
        moving.p_WCa += slide;
      } else {
        moving.p_WCb -= slide;
      }
    }
    gap = moving.p_WCa - moving.p_WCb;
  }
  moving.distance = moving.n.dot(gap);
  const Vec3Of<AutoDiff> arm = moving.p_WCa - tool.X_WB.p;
  moving.a << arm.cross(moving.n), moving.n;
  return moving;
}

}  // namespace drake_haptics
