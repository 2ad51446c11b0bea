#include "energy_ledger.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace drake_haptics {
namespace {

// Rotation vector and displacement of a frame between two poses, in W.
Vec6 Displacement(const PoseVector& from, const PoseVector& to) {
  Vec6 turn_dp;
  turn_dp << RotationLog(QuaternionOf(to) * QuaternionOf(from).conjugate()),
      to.tail<3>() - from.tail<3>();
  return turn_dp;
}

// What the loop as a whole has in a tick, summed over its parts.
struct Total {
  double stored = 0;
  double bound = 0;
};

void Close(EnergyAccount* part, double damped, double stored, double bound,
           EnergyAccount* device, Total* total) {
  part->Damp(damped);
  part->Close(stored, bound);
  device->Damp(damped);
  total->stored += stored;
  total->bound += bound;
}

bool IsFinite(const EnergyLedger::Accounts& accounts) {
  // What is not finite anywhere is not so in the sums either.
  return accounts.device.IsFinite() && accounts.display.IsFinite();
}

}  // namespace

EnergyLedger::EnergyLedger(const ToolInertia& inertia,
                           const CouplingGains& gains, const PoseVector& q_HT,
                           double h, std::size_t num_sources)
    : inertia_(inertia), gains_(gains), q_HT_(q_HT), h_(h) {
  if (!(h > 0)) throw std::invalid_argument("the tick must be above 0 s");
  accounts_.sources.resize(num_sources);
}

double EnergyLedger::Instant::KineticEnergy() const {
  const Vec6& V = reading.tool.V_WT;
  return 0.5 * V.dot(motion.M * V);
}

void EnergyLedger::Add(LoopReading reading) {
  if (reading.sources.size() != accounts_.sources.size()) {
    throw std::invalid_argument(
        "there must be a wrench model and a stored energy of each source");
  }
  Instant next{std::move(reading), {}, {}};
  next.motion = ComputeMotionTerms(inertia_, next.reading.tool);
  next.spring =
      ComputeStretch(next.reading.q_WH, q_HT_, next.reading.tool.q_WT);
  if (has_begun_) {
    BookTick(next);
  } else {
    has_begun_ = Begin(next);
  }
  last_ = std::move(next);
}

bool EnergyLedger::Begin(const Instant& first) {
  Accounts begun = accounts_;
  double total = 0;
  const auto start = [&total](EnergyAccount* account, double stored) {
    account->Start(stored);
    total += stored;
  };
  start(&begun.coupling, first.spring.Energy(gains_));
  start(&begun.tool, first.KineticEnergy());
  for (std::size_t i = 0; i < begun.sources.size(); ++i) {
    start(&begun.sources[i], first.reading.sources[i].stored);
  }
  begun.device.Start(total);
  if (!IsFinite(begun)) return false;
  accounts_ = std::move(begun);
  return true;
}

void EnergyLedger::BookTick(const Instant& next) {
  const LoopReading& from = last_.reading;
  const LoopReading& to = next.reading;
  const TickMotion motion{h_, from.tool.V_WT, to.tool.V_WT,
                          Displacement(from.q_WH, to.q_WH)};
  Accounts booked = accounts_;
  Total total;

  const TickEnergy coupling =
      CouplingEnergy(from.coupling, gains_, last_.spring, next.spring, motion);
  const double from_hand = -to.F_applied.dot(motion.turn_dp);
  booked.device.Flow(from_hand);
  booked.display.Flow(from_hand);
  booked.display.Flow(-coupling.from_handle);
  booked.display.Close(0, 0);
  booked.coupling.Flow(coupling.from_handle);
  booked.coupling.Flow(coupling.from_tool);
  booked.tool.Flow(-coupling.from_tool);
  Close(&booked.coupling, coupling.damped, next.spring.Energy(gains_),
        coupling.bound, &booked.device, &total);

  for (std::size_t i = 0; i < booked.sources.size(); ++i) {
    const TickEnergy source =
        SourceEnergy(from.sources[i].wrench, to.sources[i].wrench, motion);
    booked.sources[i].Flow(source.from_tool);
    booked.tool.Flow(-source.from_tool);
    Close(&booked.sources[i], source.damped, to.sources[i].stored, source.bound,
          &booked.device, &total);
  }

  const double g = GyroscopicEnergy(last_.motion, next.motion, motion);
  Close(&booked.tool, 0, next.KineticEnergy(), std::max(0.0, g), &booked.device,
        &total);
  booked.device.Close(total.stored, total.bound);
  if (IsFinite(booked)) accounts_ = std::move(booked);
}

}  // namespace drake_haptics
