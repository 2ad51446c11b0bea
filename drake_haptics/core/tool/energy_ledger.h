#pragma once

#include <vector>

#include "base/rotation.h"
#include "base/types.h"
#include "law/wrench_model.h"
#include "tool/energy_account.h"
#include "tool/rigid_tool.h"
#include "tool/tick_energy.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

/// A source of wrench on the tool at an instant.
struct SourceReading {
  WrenchModel wrench;
  double stored = 0;  ///< its elastic or potential energy, J
};

/// State of a haptic loop at an instant between two ticks.
struct LoopReading {
  ToolState tool;
  PoseVector q_WH;       ///< pose of the handle
  Vec6 F_Ho_W_rendered;  ///< wrench held on the handle up to now, at Ho in W
  WrenchModel coupling;  ///< wrench of the virtual coupling on the tool
  std::vector<SourceReading> sources;
};

/// Books, tick by tick, the energy that goes through each part of a haptic
/// loop:
///   hand ⇄ display ⇄ coupling ⇄ tool ⇄ each source (contact, friction, …).
/// tick_energy.h derives the energies of a tick. The accounts balance up to
/// rounding: energy that leaves one part enters its neighbor.
///
/// - `coupling` stores the energy of its spring.
/// - A source stores the energy of its reading.
/// - `tool` stores its kinetic energy E. It loses ½ ΔVᵀM ΔV − g of the work
///   done on it to the integrator. Its bound is max(0, g).
/// - `display` is between the wrench that the coupling commands and the one
///   that is rendered: the device's limits, and passivity control if there is
///   any. Sampling explains none of its energy: its bound is zero.
/// - `device` is the whole loop as the hand feels it at its port:
///   −F_Ho_W_renderedᵀ [a; Δp] goes in, which is exact unless the handle's axis
///   of rotation changes within a tick. Its stored and lost energies and its
///   bound are the sums over all parts.
class EnergyLedger {
 public:
  struct Accounts {
    EnergyAccount device;
    EnergyAccount display;
    EnergyAccount coupling;
    EnergyAccount tool;
    std::vector<EnergyAccount> sources;
  };

  /// @param q_HT pose of the tool in the handle at which the spring rests.
  /// @param h the tick, s.
  /// @throws std::invalid_argument unless h > 0.
  EnergyLedger(const ToolInertia& inertia, const CouplingGains& gains,
               const PoseVector& q_HT, double h, std::size_t num_sources);

  /// Books the tick between the last reading and this one; the first reading
  /// only sets the stored energies. A reading or a tick with an energy that is
  /// not finite is left out.
  /// @throws std::invalid_argument unless there is a reading of each source.
  void Add(const LoopReading& reading);

  /// Goes on after a change of gains, of the coupling or of a source. The tick
  /// up to the next reading is left out of the accounts, and so is the energy
  /// that the change puts into springs or takes out.
  void BeginAgain(const CouplingGains& gains) {
    gains_ = gains;
    has_begun_ = false;
  }

  const Accounts& accounts() const { return accounts_; }

 private:
  // A reading and the terms that follow from it.
  struct Instant {
    LoopReading reading;
    ToolMotionTerms motion;
    CouplingStretch spring;

    double KineticEnergy() const;
  };

  // Starts the accounts. Returns false if an energy is not finite.
  bool Begin();
  void BookTick();

  ToolInertia inertia_;
  CouplingGains gains_;
  PoseVector q_HT_;
  double h_;
  bool has_begun_ = false;
  Instant last_;
  Instant next_;
  Accounts accounts_;
  Accounts booked_;  // becomes accounts_ if all of it is finite
};

}  // namespace drake_haptics
