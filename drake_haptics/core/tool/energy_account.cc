#include "tool/energy_account.h"

namespace drake_haptics {

void LargestFall::Add(double level, double allowed) {
  if (level >= peak_) {
    peak_ = level;
    allowed_at_peak_ = allowed;
  } else if (peak_ - level > fall_) {
    fall_ = peak_ - level;
    fall_allowed_ = allowed - allowed_at_peak_;
  }
}

void EnergyAccount::Close(double stored, double bound) {
  stored_ = stored;
  allowed_ += bound;
  created_.Add(lost(), allowed_);
  beyond_.Add(lost() + allowed_, 0);
}

bool EnergyAccount::IsFinite() const {
  return std::isfinite(in_ + out_ + stored_ + damped_ + allowed_);
}

}  // namespace drake_haptics
