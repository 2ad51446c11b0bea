#include "law/contact_extrapolation.h"

#include <cmath>
#include <stdexcept>

#include "law/contact_gradient.h"

namespace drake_haptics {
namespace {

// A piece of a body that has moved. What is fixed to it moves along.
template <typename T>
struct MovedPiece {
  Vec3Of<T> Carry(const Vec3Of<T>& p_W) const {
    return body.X_WB.p + turn * (p_W - body.X_WB_found.p);
  }
  Vec3Of<T> Vertex(int i) const {
    return body.X_WB * Vec3Of<T>(shape.vertices.at(i).template cast<T>());
  }
  Vec3Of<T> Along(const Polytope::Edge& edge) const {
    const Vec3 along = shape.vertices[edge.v1] - shape.vertices[edge.v0];
    return body.X_WB.R * along.template cast<T>();
  }

  const MovedBodyOf<T>& body;
  const Mat3Of<T> turn;
  const Polytope& shape;
};

template <typename T>
Mat3Of<T> TurnOf(const MovedBodyOf<T>& body) {
  return body.X_WB.R * body.X_WB_found.R.transpose();
}

template <typename T>
class Advancing {
 public:
  Advancing(const MovedPiece<T>& A, const MovedPiece<T>& B,
            ContactOf<T>* contact)
      : A_(A), B_(B), contact_(*contact) {}

  void Run() {
    contact_.p_WCa = A_.Carry(contact_.p_WCa);
    contact_.p_WCb = B_.Carry(contact_.p_WCb);
    contact_.p_WC = (contact_.p_WCa + contact_.p_WCb) / 2;
    if (kind_A() == FeatureKind::kEdge && kind_B() == FeatureKind::kEdge &&
        CrossEdges()) {
      return;
    }
    const Mat3Of<T>& turn = IsNormalOfA() ? A_.turn : B_.turn;
    contact_.nhat_BA_W = Vec3Of<T>(turn * contact_.nhat_BA_W);
    contact_.distance = contact_.nhat_BA_W.dot(A_.Vertex(contact_.support[0]) -
                                               B_.Vertex(contact_.support[1]));
  }

 private:
  FeatureKind kind_A() const {
    return static_cast<FeatureKind>(contact_.feature_A[0]);
  }
  FeatureKind kind_B() const {
    return static_cast<FeatureKind>(contact_.feature_B[0]);
  }

  // Whether the normal belongs to A rather than to B.
  bool IsNormalOfA() const {
    return kind_B() != FeatureKind::kFacet &&
           (kind_A() == FeatureKind::kFacet ||
            (kind_A() == FeatureKind::kEdge &&
             kind_B() == FeatureKind::kVertex));
  }

  // The normal and the distance of two edges; false where they are parallel.
  bool CrossEdges() {
    const Polytope::Edge& a = A_.shape.edges.at(contact_.feature_A[1]);
    const Polytope::Edge& b = B_.shape.edges.at(contact_.feature_B[1]);
    const Vec3Of<T> u = A_.Along(a), v = B_.Along(b);
    const Vec3Of<T> cross = u.cross(v);
    const T square = cross.squaredNorm();
    if (!(ValueOf(square) > kParallelEdges * kParallelEdges *
                                ValueOf(u.squaredNorm()) *
                                ValueOf(v.squaredNorm()))) {
      return false;
    }
    const Vec3Of<T> last = B_.turn * contact_.nhat_BA_W;
    using std::sqrt;
    const T length =
        ValueOf(cross.dot(last)) < 0 ? T(-sqrt(square)) : T(sqrt(square));
    contact_.nhat_BA_W = Vec3Of<T>(cross / length);
    contact_.distance =
        contact_.nhat_BA_W.dot(A_.Vertex(a.v0) - B_.Vertex(b.v0));
    return true;
  }

  const MovedPiece<T>& A_;
  const MovedPiece<T>& B_;
  ContactOf<T>& contact_;
};

}  // namespace

ContactExtrapolation::ContactExtrapolation(
    std::shared_ptr<const Decomposition> tool,
    std::vector<std::shared_ptr<const Decomposition>> objects,
    std::vector<std::optional<Pose>> X_WO)
    : tool_(std::move(tool)),
      objects_(std::move(objects)),
      X_WO_(std::move(X_WO)) {
  if (tool_ == nullptr) throw std::invalid_argument("the tool is missing");
  for (const auto& object : objects_) {
    if (object == nullptr) throw std::invalid_argument("an object is missing");
  }
  if (X_WO_.size() != objects_.size()) {
    throw std::invalid_argument("X_WO must have one entry for each object");
  }
  for (const auto& X : X_WO_) place_.push_back(X ? -1 : num_moving_++);
}

template <typename T>
void ContactExtrapolation::Advance(const MovedBodyOf<T>& tool,
                                   std::span<const MovedBodyOf<T>> moving,
                                   ContactSetOf<T>* contacts) const {
  if (static_cast<int>(moving.size()) != num_moving_) {
    throw std::invalid_argument("there must be a pose for each moving object");
  }
  const Mat3Of<T> turn_A = TurnOf(tool);
  for (ContactOf<T>& contact : contacts->contacts) {
    RequireFeatures(contact);
    const Decomposition& object = *objects_.at(contact.object);
    const auto& rest = X_WO_[contact.object];
    MovedBodyOf<T> at_rest;
    if (rest) {
      at_rest.X_WB = {rest->R.template cast<T>(), rest->p.template cast<T>()};
      at_rest.X_WB_found = at_rest.X_WB;
    }
    const MovedBodyOf<T>& B = rest ? at_rest : moving[place_[contact.object]];
    const Mat3Of<T> turn_B =
        rest ? Mat3Of<T>(Mat3Of<T>::Identity()) : TurnOf(B);
    Advancing<T>({tool, turn_A, tool_->pieces.at(contact.piece_A)},
                 {B, turn_B, object.pieces.at(contact.piece_B)}, &contact)
        .Run();
  }
}

template void ContactExtrapolation::Advance(
    const MovedBodyOf<double>&, std::span<const MovedBodyOf<double>>,
    ContactSet*) const;
template void ContactExtrapolation::Advance(
    const MovedBodyOf<AutoDiff>&, std::span<const MovedBodyOf<AutoDiff>>,
    ContactSetOf<AutoDiff>*) const;

}  // namespace drake_haptics
