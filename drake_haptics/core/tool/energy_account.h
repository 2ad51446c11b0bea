#pragma once

#include <cmath>

namespace drake_haptics {

/// The largest fall of a sequence from any earlier value, and how much of it
/// was allowed over the same stretch.
class LargestFall {
 public:
  /// @param level the next value of the sequence.
  /// @param allowed sum of what each step so far was allowed to fall.
  void Add(double level, double allowed);

  double fall() const { return fall_; }
  double allowed() const { return fall_allowed_; }

 private:
  double peak_ = 0;
  double allowed_at_peak_ = 0;
  double fall_ = 0;
  double fall_allowed_ = 0;
};

/// The books of one part of a haptic loop, J. A part has ports, through which
/// energy goes in and out, and may store some. What is neither stored nor came
/// out is lost:
///   lost = in − out − (stored − stored at the start).
/// A part that makes no energy never gets back what it lost: over no stretch
/// of time does `lost` fall, but by what a tick's sampling explains.
class EnergyAccount {
 public:
  /// Says what the part holds where no tick has brought it there: at first, and
  /// where its gains were changed.
  void Start(double stored) {
    stored_at_start_ += stored - stored_;
    stored_ = stored;
  }

  /// Books what went into the part through one of its ports in a tick; negative
  /// if it came out.
  void Flow(double energy) { (energy > 0 ? in_ : out_) += std::abs(energy); }

  /// Books what a damper took in a tick; it is a part of what is lost.
  void Damp(double energy) { damped_ += energy; }

  /// Ends a tick.
  /// @param stored what the part holds now.
  /// @param bound what it may seem to have made in this tick because its
  ///        force is sampled and linearized.
  void Close(double stored, double bound);

  double in() const { return in_; }
  double out() const { return out_; }
  double stored() const { return stored_; }
  double lost() const { return in_ - out_ - (stored_ - stored_at_start_); }
  double damped() const { return damped_; }

  /// The energy it made: the largest fall of `lost`.
  double created() const { return created_.fall(); }
  /// What sampling explains of it, over the same stretch of time.
  double bound() const { return created_.allowed(); }
  /// The most that was made over a stretch of time beyond what sampling
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
