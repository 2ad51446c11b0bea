#include "pair/contact.h"

#include <stdexcept>

namespace drake_haptics {
namespace {

// A tick copies contacts from the query to the law.
static_assert(sizeof(Contact) == 168);

std::array<std::int32_t, 2> KindAndIndex(const Feature& feature) {
  return {static_cast<std::int32_t>(feature.kind()), feature.index()};
}

}  // namespace

template <typename T>
void RequireFeatures(const ContactOf<T>& contact) {
  if (contact.feature_A[1] >= 0 && contact.feature_B[1] >= 0) return;
  throw std::invalid_argument(
      "a contact of contact_set() names no features of convex pieces: it has "
      "no derivatives, is not shaded and is not carried along");
}

template void RequireFeatures(const Contact&);
template void RequireFeatures(const ContactOf<AutoDiff>&);

Feature RequireFeature(const Polytope& piece,
                       const std::array<std::int32_t, 2>& kind_and_index) {
  const auto [kind, index] = kind_and_index;
  const std::size_t counts[] = {piece.vertices.size(), piece.edges.size(),
                                piece.facets.size()};
  if (kind < 0 || kind > 2 || index < 0 ||
      static_cast<std::size_t>(index) >= counts[kind]) {
    throw std::out_of_range("a contact names a feature that its piece lacks");
  }
  return {static_cast<FeatureKind>(kind), index};
}

Contact InWorld(const PairContact& pair, const Pose& X_WA) {
  Contact contact;
  contact.distance = pair.distance;
  contact.nhat_BA_W = X_WA.R * pair.n;
  contact.p_WCa = X_WA * pair.p_a;
  contact.p_WCb = X_WA * pair.p_b;
  contact.p_WC = (contact.p_WCa + contact.p_WCb) / 2;
  contact.extent = pair.extent;
  contact.flushness = pair.flushness;
  contact.support = pair.support;
  contact.feature_A = KindAndIndex(pair.feature_A);
  contact.feature_B = KindAndIndex(pair.feature_B);
  contact.status = static_cast<std::int32_t>(pair.status);
  return contact;
}

}  // namespace drake_haptics
