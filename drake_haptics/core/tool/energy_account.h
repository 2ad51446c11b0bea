#pragma once

#include <cmath>

namespace drake_haptics {

/// The largest fall of a sequence from any earlier value, and the fall that was
/// allowed over the same stretch.
class LargestFall {
 public:
  /// @param level the next value of the sequence.
  /// @param allowed sum of the falls that were allowed in the steps so far.
  void Add(double level, double allowed);

  double fall() const { return fall_; }
  double allowed() const { return fall_allowed_; }

 private:
  double peak_ = 0;
  double allowed_at_peak_ = 0;
  double fall_ = 0;
  double fall_allowed_ = 0;
};

/// Energy account of one part of a haptic loop, J. A part has ports, through
/// which energy goes in and out, and may store energy. Energy that is neither
/// stored nor came out is lost:
///   lost = in − out − (stored − stored at the start).
/// A passive part never regains lost energy: over any stretch of time, `lost`
/// falls by no more than the sampling of its ticks explains.
class EnergyAccount {
 public:
  /// Sets the stored energy where no tick leads to it: at first, and after a
  /// change of gains.
  void Start(double stored) {
    stored_at_start_ += stored - stored_;
    stored_ = stored;
  }

  /// Books the energy that went into the part through one of its ports in a
  /// tick; negative if it came out.
  void Flow(double energy) { (energy > 0 ? in_ : out_) += std::abs(energy); }

  /// Books the energy that a damper took in a tick; it is part of `lost`.
  void Damp(double energy) { damped_ += energy; }

  /// Ends a tick.
  /// @param stored energy that the part stores now.
  /// @param bound energy that the part may seem to have made in this tick
  ///     because its force is sampled and linearized.
  void Close(double stored, double bound);

  double in() const { return in_; }
  double out() const { return out_; }
  double stored() const { return stored_; }
  double lost() const { return in_ - out_ - (stored_ - stored_at_start_); }
  double damped() const { return damped_; }

  /// Energy that the part made: the largest fall of `lost`.
  double created() const { return created_.fall(); }
  /// Energy that sampling explains over the same stretch of time.
  double bound() const { return created_.allowed(); }
  /// Largest energy made over a stretch of time, less the energy that sampling
  /// explains there.
  double beyond() const { return beyond_.fall(); }

  bool IsFinite() const;

 private:
  double in_ = 0;
  double out_ = 0;
  double stored_ = 0;
  double stored_at_start_ = 0;
  double damped_ = 0;
  double allowed_ = 0;
  LargestFall created_;
  LargestFall beyond_;
};

}  // namespace drake_haptics
