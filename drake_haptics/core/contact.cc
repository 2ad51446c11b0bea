#include "contact.h"

namespace drake_haptics {

Contact InWorld(const PairContact& pair, const Pose& X_WA) {
  Contact contact;
  contact.distance = pair.distance;
  contact.nhat_BA_W = X_WA.R * pair.n;
  contact.p_WCa = X_WA * pair.p_a;
  contact.p_WCb = X_WA * pair.p_b;
  contact.p_WC = (contact.p_WCa + contact.p_WCb) / 2;
  contact.feature_A = pair.feature_A.code();
  contact.feature_B = pair.feature_B.code();
  contact.status = static_cast<std::int32_t>(pair.status);
  return contact;
}

}  // namespace drake_haptics
