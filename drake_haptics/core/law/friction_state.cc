#include "law/friction_state.h"

#include <cmath>
#include <limits>

namespace drake_haptics {
namespace {

// Index that a number of the state stands for, or -1. Numerical differentiation
// may have moved the number a little to either side.
int ToObject(double number) {
  const double index = std::round(number);
  const bool is_index = index >= 0 && index <= std::numeric_limits<int>::max();
  return is_index ? static_cast<int>(index) : -1;
}

}  // namespace

template <typename T>
AdhesiveContactsOf<T> AdhesiveContactsOf<T>::Read(const T* slots) {
  AdhesiveContactsOf contacts;
  for (int i = 0; i < kCapacity; ++i, slots += kSlotSize) {
    if (!(ValueOf(slots[10]) > 0)) break;
    contacts.push_back(
        {ToObject(ValueOf(slots[0])), Eigen::Map<const Vec3Of<T>>(slots + 1),
         Eigen::Map<const Vec3Of<T>>(slots + 4),
         Eigen::Map<const Vec3Of<T>>(slots + 7), slots[10], slots[11]});
  }
  return contacts;
}

template <typename T>
void AdhesiveContactsOf<T>::Write(T* slots) const {
  for (const AdhesiveContactOf<T>& contact : *this) {
    slots[0] = T(contact.object);
    Eigen::Map<Vec3Of<T>>(slots + 1) = contact.p_WC;
    Eigen::Map<Vec3Of<T>>(slots + 4) = contact.nhat_BA_W;
    Eigen::Map<Vec3Of<T>>(slots + 7) = contact.z_W;
    slots[10] = contact.load;
    slots[11] = contact.grip;
    slots += kSlotSize;
  }
}

template class AdhesiveContactsOf<double>;
template class AdhesiveContactsOf<AutoDiff>;

}  // namespace drake_haptics
