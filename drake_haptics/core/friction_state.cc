#include "friction_state.h"

namespace drake_haptics {

AdhesiveContacts AdhesiveContacts::Read(const double* slots) {
  AdhesiveContacts contacts;
  for (int i = 0; i < kCapacity; ++i, slots += kSlotSize) {
    if (!(slots[10] > 0)) break;
    contacts.push_back(
        {static_cast<int>(slots[0]), Eigen::Map<const Vec3>(slots + 1),
         Eigen::Map<const Vec3>(slots + 4), Eigen::Map<const Vec3>(slots + 7),
         slots[10], slots[11]});
  }
  return contacts;
}

void AdhesiveContacts::Write(double* slots) const {
  for (const AdhesiveContact& contact : *this) {
    slots[0] = contact.object;
    Eigen::Map<Vec3>(slots + 1) = contact.p_WC;
    Eigen::Map<Vec3>(slots + 4) = contact.nhat_BA_W;
    Eigen::Map<Vec3>(slots + 7) = contact.z_W;
    slots[10] = contact.load;
    slots[11] = contact.grip;
    slots += kSlotSize;
  }
}

}  // namespace drake_haptics
