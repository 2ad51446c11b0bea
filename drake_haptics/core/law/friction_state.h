#pragma once

#include <array>

#include "base/autodiff.h"
#include "base/types.h"

namespace drake_haptics {

/// A contact that friction remembers from one tick to the next, in the world.
/// Members are not initialized, so that a list costs only what it holds.
template <typename T>
struct AdhesiveContactOf {
  int object;
  Vec3Of<T> p_WC;       ///< position, m
  Vec3Of<T> nhat_BA_W;  ///< unit normal, out of the object
  Vec3Of<T> z_W;        ///< displacement from the adhesion point, m
  T load;               ///< normal force under which adhesion formed, N
  T grip;  ///< 1 holds up to the static limit, 0 to the sliding one
};

/// The contacts of one tick: a list of fixed capacity, which allocates nothing
/// where T is double.
template <typename T>
class AdhesiveContactsOf {
 public:
  static constexpr int kCapacity = 32;
  /// Numbers per contact: object, p (3), n (3), z (3), load, grip.
  static constexpr int kSlotSize = 12;

  /// Reads kCapacity slots, up to the first without a load.
  static AdhesiveContactsOf Read(const T* slots);
  /// Writes the slots, which must be zero before.
  void Write(T* slots) const;

  void push_back(const AdhesiveContactOf<T>& contact) {
    items_[size_++] = contact;
  }
  int size() const { return size_; }
  const AdhesiveContactOf<T>& operator[](int i) const { return items_[i]; }
  AdhesiveContactOf<T>& operator[](int i) { return items_[i]; }
  const AdhesiveContactOf<T>* begin() const { return items_.data(); }
  const AdhesiveContactOf<T>* end() const { return items_.data() + size_; }
  AdhesiveContactOf<T>* begin() { return items_.data(); }
  AdhesiveContactOf<T>* end() { return items_.data() + size_; }

 private:
  std::array<AdhesiveContactOf<T>, kCapacity> items_;
  int size_ = 0;
};

}  // namespace drake_haptics
