#include "law/contact_gradient.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "law/patch_gradient.h"

namespace drake_haptics {
namespace {

// Velocity of a point of the tool at `r` from To, by the displacement.
Mat36 MotionAt(const Vec3& r) {
  Mat36 motion;
  motion << -Cross(r), Mat3::Identity();
  return motion;
}

// Turning of a direction that is fixed in the tool.
Mat36 TurnOf(const Vec3& u) {
  Mat36 turn;
  turn << -Cross(u), Mat3::Zero();
  return turn;
}

// From its first vertex to its second.
struct Edge {
  Vec3 p = Vec3::Zero();  // a point, from To
  Vec3 along = Vec3::Zero();

  Vec3 At(double place) const { return p + place * along; }
  double PlaceOf(const Vec3& x) const {
    return (x - p).dot(along) / along.squaredNorm();
  }
};

// A contact and its features. Positions are from To, in the world's axes.
class Differentiation {
 public:
  Differentiation(const PosedPieces& pieces, const Contact& contact)
      : pieces_(pieces),
        contact_(contact),
        a_{static_cast<FeatureKind>(contact.feature_A[0]),
           contact.feature_A[1]},
        b_{static_cast<FeatureKind>(contact.feature_B[0]),
           contact.feature_B[1]},
        n_(contact.nhat_BA_W),
        d_(contact.distance) {
    if (IsEdge(a_)) edge_A_ = EdgeOfA();
    if (IsEdge(b_)) edge_B_ = EdgeOfB();
    common_ = edge_A_.along.cross(edge_B_.along);
    cross_ = common_.norm() >
             kParallelEdges * edge_A_.along.norm() * edge_B_.along.norm();
    p_a_ = FindWitness();
  }

  ContactGradient Run(double tolerance) {
    const Mat36 motion = MotionAt(p_a_);
    gradient_.distance = n_.transpose() * motion;
    gradient_.nhat_BA_W = Normal(motion);
    // Of the vector from B's witness point to A's.
    const Mat36 gap = n_ * gradient_.distance + d_ * gradient_.nhat_BA_W;
    MovingWitness witness = Witness(motion, gap);
    if (contact_.flushness > 0) {
      DifferentiatePatch(pieces_, contact_, tolerance, &gradient_, &witness);
    }
    gradient_.p_WC = witness.motion - gap / 2;
    return gradient_;
  }

 private:
  static bool IsVertex(Feature f) { return f.kind() == FeatureKind::kVertex; }
  static bool IsEdge(Feature f) { return f.kind() == FeatureKind::kEdge; }
  static bool IsFacet(Feature f) { return f.kind() == FeatureKind::kFacet; }

  Vec3 a(int i) const { return pieces_.X_WA.R * pieces_.A.vertices[i]; }
  Vec3 b(int j) const {
    return pieces_.X_WB.R * pieces_.B.vertices[j] +
           (pieces_.X_WB.p - pieces_.X_WA.p);
  }
  Edge EdgeOfA() const {
    const Polytope::Edge& edge = pieces_.A.edges[a_.index()];
    return {a(edge.v0), a(edge.v1) - a(edge.v0)};
  }
  Edge EdgeOfB() const {
    const Polytope::Edge& edge = pieces_.B.edges[b_.index()];
    return {b(edge.v0), b(edge.v1) - b(edge.v0)};
  }

  // A's witness point. That of the contact may be a center of pressure.
  Vec3 FindWitness() const {
    if (IsVertex(a_)) return a(a_.index());
    if (IsVertex(b_)) return b(b_.index()) + d_ * n_;
    if (!cross_) return contact_.p_WCa - pieces_.X_WA.p;
    const double s = (edge_B_.p - edge_A_.p).cross(edge_B_.along).dot(common_) /
                     common_.squaredNorm();
    return edge_A_.p + s * edge_A_.along;
  }

  // Derivative of a direction that is `vector` made unit, of length `length`,
  // kept at right angles to `axis`.
  Mat36 Direction(const Mat36& vector, double length,
                  const Vec3& axis = Vec3::Zero()) const {
    if (!(length > 0)) return Mat36::Zero();
    Mat36 across = vector - n_ * (n_.transpose() * vector);
    if (!axis.isZero()) {
      const Vec3 e = axis.normalized();
      across -= e * (e.transpose() * across);
    }
    return across / length;
  }

  Mat36 Normal(const Mat36& motion) const {
    if (IsFacet(b_)) return Mat36::Zero();
    if (IsFacet(a_)) return TurnOf(n_);
    if (IsVertex(a_)) return Direction(motion, d_, edge_B_.along);
    // Seen from the tool, B's vertex moves the other way.
    if (IsVertex(b_)) {
      return TurnOf(n_) +
             Direction(MotionAt(p_a_ - d_ * n_), d_, edge_A_.along);
    }
    if (!cross_) return Mat36::Zero();
    const double side = common_.dot(n_) > 0 ? 1.0 : -1.0;
    return Direction(-side * Cross(edge_B_.along) * TurnOf(edge_A_.along),
                     common_.norm());
  }

  // @param motion of the tool at p_a_.
  // @param gap motion of A's witness point from B's.
  MovingWitness Witness(const Mat36& motion, const Mat36& gap) const {
    if (IsVertex(a_)) return {p_a_, motion};
    if (IsVertex(b_)) return {p_a_, gap};
    if (!cross_) return {p_a_, motion};
    return WitnessOfEdges(motion, gap);
  }

  // Edges whose lines pass each other beyond their ends meet at the nearest
  // points that they have (OnCrossedEdges).
  MovingWitness WitnessOfEdges(const Mat36& motion, const Mat36& gap) const {
    const Vec3 &u = edge_A_.along, &v = edge_B_.along;
    const double on_B = edge_B_.PlaceOf(p_a_);
    const Vec3 b = edge_B_.At(std::clamp(on_B, 0.0, 1.0));
    const double on_A = std::clamp(edge_A_.PlaceOf(b), 0.0, 1.0);
    const Vec3 p_a = edge_A_.At(on_A);
    if (on_A == 0 || on_A == 1) return {p_a, MotionAt(p_a)};
    // A's point slides along its edge, so that B's stays on its own, or as the
    // foot of B's end.
    const Row6 slide =
        on_B == std::clamp(on_B, 0.0, 1.0)
            ? Row6(v.cross(common_).transpose() * (gap - motion) /
                   common_.squaredNorm())
            : Row6(-u.transpose() * MotionAt(b) / u.squaredNorm());
    return {p_a, MotionAt(p_a) + u * slide};
  }

  const PosedPieces& pieces_;
  const Contact& contact_;
  const Feature a_, b_;
  const Vec3& n_;
  const double d_;
  Edge edge_A_, edge_B_;
  Vec3 common_;  // along both edges' cross product
  bool cross_ = false;
  Vec3 p_a_;
  ContactGradient gradient_;
};

}  // namespace

ContactGradient FindContactGradient(const PosedPieces& pieces,
                                    const Contact& contact, double tolerance) {
  return Differentiation(pieces, contact).Run(tolerance);
}

}  // namespace drake_haptics
