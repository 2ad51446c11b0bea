#pragma once

#include <array>

#include "types.h"

namespace drake_haptics {

/// A contact as friction remembers it from one tick to the next, in the world.
/// Nothing is preset: a list of them costs what is in it.
struct AdhesiveContact {
  int object;
  Vec3 p_WC;       ///< position, m
  Vec3 nhat_BA_W;  ///< unit normal, out of the object
  Vec3 z_W;        ///< displacement from the adhesion point, m
  double load;     ///< normal force that the adhesion was formed under, N
  double grip;     ///< 1 holds up to the static limit, 0 to the sliding one
};

/// The contacts of one tick: a list of fixed capacity, which allocates nothing.
class AdhesiveContacts {
 public:
  static constexpr int kCapacity = 32;
  /// Numbers per contact: object, p (3), n (3), z (3), load, grip.
  static constexpr int kSlotSize = 12;

  /// Reads kCapacity slots; one without a load is empty, and so is all behind.
  static AdhesiveContacts Read(const double* slots);
  /// Writes the slots, of which all are zero.
  void Write(double* slots) const;

  void push_back(const AdhesiveContact& contact) { items_[size_++] = contact; }
  int size() const { return size_; }
  const AdhesiveContact& operator[](int i) const { return items_[i]; }
  AdhesiveContact& operator[](int i) { return items_[i]; }
  const AdhesiveContact* begin() const { return items_.data(); }
  const AdhesiveContact* end() const { return items_.data() + size_; }
  AdhesiveContact* begin() { return items_.data(); }
  AdhesiveContact* end() { return items_.data() + size_; }

 private:
  std::array<AdhesiveContact, kCapacity> items_;
  int size_ = 0;
};

}  // namespace drake_haptics
