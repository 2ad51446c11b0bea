#include "tool/energy_ledger.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace drake_haptics {
namespace {

// Energies of the whole loop in a tick, summed over its parts, J.
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
  // These accounts hold all stored energy and every flow between parts.
  return accounts.device.IsFinite() && accounts.display.IsFinite() &&
         accounts.tool.IsFinite();
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

void EnergyLedger::Add(const LoopReading& reading) {
  if (reading.sources.size() != accounts_.sources.size()) {
    throw std::invalid_argument(
        "there must be a wrench model and a stored energy of each source");
  }
  next_.reading = reading;
  next_.motion = ComputeMotionTerms(inertia_, reading.tool);
  next_.spring = ComputeStretch(reading.q_WH, q_HT_, reading.tool.q_WT);
  booked_ = accounts_;
  if (has_begun_) {
    BookTick();
  } else {
    has_begun_ = Begin();
  }
  std::swap(last_, next_);
}

bool EnergyLedger::Begin() {
  double total = 0;
  const auto start = [&total](EnergyAccount* account, double stored) {
    account->Start(stored);
    total += stored;
  };
  start(&booked_.coupling, next_.spring.Energy(gains_));
  start(&booked_.tool, next_.KineticEnergy());
  for (std::size_t i = 0; i < booked_.sources.size(); ++i) {
    start(&booked_.sources[i], next_.reading.sources[i].stored);
  }
  booked_.device.Start(total);
  if (!IsFinite(booked_)) return false;
  std::swap(accounts_, booked_);
  return true;
}

void EnergyLedger::BookTick() {
  const LoopReading& from = last_.reading;
  const LoopReading& to = next_.reading;
  const TickMotion motion{h_, from.tool.V_WT, to.tool.V_WT,
                          Displacement(from.q_WH, to.q_WH)};
  Total total;

  const TickEnergy coupling =
      CouplingEnergy(from.coupling, gains_, last_.spring, next_.spring, motion);
  const double from_hand = -to.F_Ho_W_rendered.dot(motion.turn_dp);
  booked_.device.Flow(from_hand);
  booked_.display.Flow(from_hand);
  booked_.display.Flow(-coupling.from_handle);
  booked_.display.Close(0, 0);
  booked_.coupling.Flow(coupling.from_handle);
  booked_.coupling.Flow(coupling.from_tool);
  booked_.tool.Flow(-coupling.from_tool);
  Close(&booked_.coupling, coupling.damped, next_.spring.Energy(gains_),
        coupling.bound, &booked_.device, &total);

  for (std::size_t i = 0; i < booked_.sources.size(); ++i) {
    const TickEnergy source =
        SourceEnergy(from.sources[i].wrench, to.sources[i].wrench, motion);
    booked_.sources[i].Flow(source.from_tool);
    booked_.tool.Flow(-source.from_tool);
    Close(&booked_.sources[i], source.damped, to.sources[i].stored,
          source.bound, &booked_.device, &total);
  }

  const double g = GyroscopicEnergy(last_.motion, next_.motion, motion);
  Close(&booked_.tool, 0, next_.KineticEnergy(), std::max(0.0, g),
        &booked_.device, &total);
  booked_.device.Close(total.stored, total.bound);
  if (IsFinite(booked_)) std::swap(accounts_, booked_);
}

}  // namespace drake_haptics
