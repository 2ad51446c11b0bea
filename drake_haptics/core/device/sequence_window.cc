#include "device/sequence_window.h"

namespace drake_haptics {

SequenceWindow::Arrival SequenceWindow::Accept(std::uint32_t sequence) {
  if (!has_newest_) {
    has_newest_ = true;
    newest_ = sequence;
    came_ = ~std::uint64_t{0};  // packets before the first are not lost
    return Arrival::kNewest;
  }
  const auto ahead = static_cast<std::int32_t>(sequence - newest_);
  if (ahead > 0) {
    came_ = ahead < 64 ? came_ << ahead : 0;
    came_ |= 1;
    newest_ = sequence;
    num_lost_ += ahead - 1;
    return Arrival::kNewest;
  }
  const std::uint32_t behind = newest_ - sequence;
  const std::uint64_t bit = behind < 64 ? std::uint64_t{1} << behind : 0;
  if (bit == 0 || (came_ & bit) != 0) {
    ++num_duplicate_;
    return Arrival::kDuplicate;
  }
  came_ |= bit;
  --num_lost_;
  ++num_late_;
  return Arrival::kLate;
}

}  // namespace drake_haptics
