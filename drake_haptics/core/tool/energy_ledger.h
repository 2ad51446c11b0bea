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

/// What the ledger reads of a haptic loop at an instant between two ticks.
struct LoopReading {
  ToolState tool;
  PoseVector q_WH;       ///< of the handle
  Vec6 F_Ho_W_rendered;  ///< held on the handle up to now, at Ho in W
  WrenchModel coupling;  ///< of the virtual coupling on the tool
  std::vector<SourceReading> sources;
};

/// Books, tick by tick, the energy that goes through each part of a haptic
/// loop:
///   hand ⇄ display ⇄ coupling ⇄ tool ⇄ each source (contact, friction, …).
/// tick_energy.h derives what a tick brings to each. All of it balances: what
/// goes out of one part goes into its neighbor, to the last bit but rounding.
///
/// - `coupling` stores what its spring does.
/// - A source stores what its reading says.
/// - `tool` stores its kinetic energy E, and loses what the integrator makes
///   of the work done on it: ½ ΔVᵀM ΔV − g. Its bound is max(0, g).
/// - `display` is between the wrench that the coupling asks for and the one
///   that is applied: the device's limits, and passivity control where there
///   is. Nothing of it is sampling: its bound is zero.
/// - `device` is the whole loop as the hand has it in its port:
///   −F_Ho_W_renderedᵀ [a; Δp] goes in, exact unless the axis about which the
///   handle turns changes within a tick. It stores, loses and may seem to make
///   what all parts together do.
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

  /// Books the tick between the reading before and this one; the first reading
  /// only says what is stored. A reading or a tick with an energy that is not
  /// finite is left out.
  /// @throws std::invalid_argument unless there is a reading of each source.
  void Add(const LoopReading& reading);

  /// The coupling's gains are others from now on, or those of a source. The
  /// tick up to the next reading is left out of the books, and so is what the
  /// change puts into springs or takes out.
  void BeginAgain(const CouplingGains& gains) {
    gains_ = gains;
    has_begun_ = false;
  }

  const Accounts& accounts() const { return accounts_; }

 private:
  // A reading and what follows from it.
  struct Instant {
    LoopReading reading;
    ToolMotionTerms motion;
    CouplingStretch spring;

    double KineticEnergy() const;
  };

  // False if there is no finite number to begin with.
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
  Accounts booked_;  // Becomes accounts_ if it is finite.
};

}  // namespace drake_haptics
