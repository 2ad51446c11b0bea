#include "law/contact_extrapolation.h"

#include <stdexcept>

namespace drake_haptics {
namespace {

// Moves a point with its body.
template <typename T>
Vec3Of<T> Carry(const MovedBodyOf<T>& body, const Vec3Of<T>& p_W) {
  return body.X_WB.p + body.Turn() * (p_W - body.X_WB_found.p);
}

template <typename T>
void Advance(const MovedPieceOf<T>& A, const MovedPieceOf<T>& B,
             ContactOf<T>* contact) {
  const FeatureContactOf<T> now = EvaluateFeatures(A, B, *contact);
  if (contact->flushness > 0.0) {  // centers of pressure
    contact->p_WCa = Carry(A.body, contact->p_WCa);
    contact->p_WCb = Carry(B.body, contact->p_WCb);
  } else {
    contact->p_WCa = now.p_WCa;
    contact->p_WCb = now.p_WCa - now.distance * now.nhat_BA_W;
  }
  contact->p_WC = (contact->p_WCa + contact->p_WCb) / 2.0;
  contact->nhat_BA_W = now.nhat_BA_W;
  contact->distance = now.distance;
}

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
  for (ContactOf<T>& contact : contacts->contacts) {
    RequireFeatures(contact);
    const Decomposition& object = *ObjectAt(objects_, contact.object);
    const auto& rest = X_WO_[contact.object];
    MovedBodyOf<T> at_rest;
    if (rest) {
      at_rest.X_WB = rest->template cast<T>();
      at_rest.X_WB_found = at_rest.X_WB;
    }
    const MovedBodyOf<T>& B = rest ? at_rest : moving[place_[contact.object]];
    drake_haptics::Advance<T>({tool_->pieces.at(contact.piece_A), tool},
                              {object.pieces.at(contact.piece_B), B}, &contact);
  }
}

template void ContactExtrapolation::Advance(
    const MovedBodyOf<double>&, std::span<const MovedBodyOf<double>>,
    ContactSet*) const;
template void ContactExtrapolation::Advance(
    const MovedBodyOf<AutoDiff>&, std::span<const MovedBodyOf<AutoDiff>>,
    ContactSetOf<AutoDiff>*) const;

}  // namespace drake_haptics
