#include "law/frozen_features.h"

#include <cmath>

#include "pair/gauss_overlay.h"

namespace drake_haptics {
namespace {

template <typename T>
struct Segment {
  Vec3Of<T> start, along;

  // Point of the segment nearest to another.
  Vec3Of<T> NearestTo(const Vec3Of<T>& point) const {
    const T place = (point - start).dot(along) / along.squaredNorm();
    if (place <= 0.0) return start;
    return place >= 1.0 ? Vec3Of<T>(start + along)
                        : Vec3Of<T>(start + place * along);
  }
};

// Positions are relative to A's origin, in world axes: exact far from the
// world's origin.
template <typename T>
class Evaluation {
 public:
  Evaluation(const MovedPieceOf<T>& A, const MovedPieceOf<T>& B,
             const ContactOf<T>& found)
      : A_(A),
        B_(B),
        found_(found),
        a_(RequireFeature(A.shape, found.feature_A)),
        b_(RequireFeature(B.shape, found.feature_B)),
        p_AB_(B.body.X_WB.p - A.body.X_WB.p) {}

  FeatureContactOf<T> Run() const {
    if (IsEdge(a_) && IsEdge(b_)) {
      const Segment<T> edge_A = EdgeOfA(), edge_B = EdgeOfB();
      const Vec3Of<T> cross = edge_A.along.cross(edge_B.along);
      if (ValueOf(cross.squaredNorm()) >
          kParallelSine * kParallelSine * ValueOf(edge_A.along.squaredNorm()) *
              ValueOf(edge_B.along.squaredNorm())) {
        return Cross(edge_A, edge_B, cross);
      }
    }
    FeatureContactOf<T> contact;
    contact.nhat_BA_W = Normal();
    contact.distance = contact.nhat_BA_W.dot(Gap());
    contact.p_WCa = Witness(contact) + A_.body.X_WB.p;
    return contact;
  }

 private:
  static bool IsVertex(Feature f) { return f.kind() == FeatureKind::kVertex; }
  static bool IsEdge(Feature f) { return f.kind() == FeatureKind::kEdge; }
  static bool IsFacet(Feature f) { return f.kind() == FeatureKind::kFacet; }

  Vec3Of<T> a(int i) const {
    return A_.body.X_WB.R * A_.shape.vertices.at(i).template cast<T>();
  }
  Vec3Of<T> b(int i) const {
    return B_.body.X_WB.R * B_.shape.vertices.at(i).template cast<T>() + p_AB_;
  }
  Segment<T> EdgeOfA() const {
    const Polytope::Edge& edge = A_.shape.edges[a_.index()];
    return {a(edge.v0), a(edge.v1) - a(edge.v0)};
  }
  Segment<T> EdgeOfB() const {
    const Polytope::Edge& edge = B_.shape.edges[b_.index()];
    return {b(edge.v0), b(edge.v1) - b(edge.v0)};
  }

  // From a point of B's feature to one of A's.
  Vec3Of<T> Gap() const {
    return a(IsVertex(a_) ? a_.index() : found_.support[0]) -
           b(IsVertex(b_) ? b_.index() : found_.support[1]);
  }

  Vec3Of<T> Normal() const {
    const bool is_of_A =
        !IsFacet(b_) && (IsFacet(a_) || (IsEdge(a_) && IsVertex(b_)));
    const Vec3Of<T> normal = (is_of_A ? A_ : B_).body.Turn() * found_.nhat_BA_W;
    const bool has_point = IsVertex(a_) || IsVertex(b_);
    if (IsFacet(a_) || IsFacet(b_) || !has_point || !(found_.distance > 0.0)) {
      return normal;
    }
    const Vec3Of<T> gap = Gap();
    Vec3Of<T> across = gap - normal * T(normal.dot(gap));
    if (IsEdge(a_)) across = Across(across, EdgeOfA().along);
    if (IsEdge(b_)) across = Across(across, EdgeOfB().along);
    return Vec3Of<T>(found_.distance * normal + across).normalized();
  }

  // Part of a vector perpendicular to another.
  static Vec3Of<T> Across(const Vec3Of<T>& vector, const Vec3Of<T>& along) {
    return vector - along * T(along.dot(vector) / along.squaredNorm());
  }

  Vec3Of<T> Witness(const FeatureContactOf<T>& contact) const {
    if (IsVertex(a_)) return a(a_.index());
    if (IsVertex(b_)) {
      return b(b_.index()) + contact.distance * contact.nhat_BA_W;
    }
    return A_.body.Turn() * (found_.p_WCa - A_.body.X_WB_found.p);
  }

  FeatureContactOf<T> Cross(const Segment<T>& edge_A, const Segment<T>& edge_B,
                            const Vec3Of<T>& cross) const {
    using std::sqrt;
    const T square = cross.squaredNorm();
    const Vec3Of<T> last = B_.body.Turn() * found_.nhat_BA_W;
    const T length =
        ValueOf(cross.dot(last)) < 0 ? T(-sqrt(square)) : T(sqrt(square));
    FeatureContactOf<T> contact;
    contact.nhat_BA_W = cross / length;
    const Vec3Of<T> between = edge_B.start - edge_A.start;
    contact.distance = -contact.nhat_BA_W.dot(between);
    const T place = between.cross(edge_B.along).dot(cross) / square;
    // If the lines cross beyond the ends of the edges, the nearest points of
    // the edges count (OnCrossedEdges).
    const Vec3Of<T> crossing = edge_A.start + place * edge_A.along;
    contact.p_WCa =
        edge_A.NearestTo(edge_B.NearestTo(crossing)) + A_.body.X_WB.p;
    return contact;
  }

  const MovedPieceOf<T>& A_;
  const MovedPieceOf<T>& B_;
  const ContactOf<T>& found_;
  const Feature a_, b_;
  const Vec3Of<T> p_AB_;
};

}  // namespace

template <typename T>
FeatureContactOf<T> EvaluateFeatures(const MovedPieceOf<T>& A,
                                     const MovedPieceOf<T>& B,
                                     const ContactOf<T>& found) {
  return Evaluation<T>(A, B, found).Run();
}

template FeatureContactOf<double> EvaluateFeatures(const MovedPieceOf<double>&,
                                                   const MovedPieceOf<double>&,
                                                   const Contact&);
template FeatureContactOf<AutoDiff> EvaluateFeatures(
    const MovedPieceOf<AutoDiff>&, const MovedPieceOf<AutoDiff>&,
    const ContactOf<AutoDiff>&);

}  // namespace drake_haptics
