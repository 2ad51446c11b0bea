#pragma once

#include "base/types.h"
#include "law/wrench_model.h"
#include "tool/rigid_tool.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

/// Motion of the tool and the handle in one tick of h seconds.
///
/// The tool's step (rigid_tool.h), from V to V⁺ = V + ΔV, moves it along the
/// twist δ = h V⁺, which is constant during the tick, so that the formulas
/// below for its path are exact.
struct TickMotion {
  double h;      ///< s
  Vec6 V;        ///< velocity of the tool as the tick begins
  Vec6 V_next;   ///< velocity of the tool as it ends, V⁺
  Vec6 turn_dp;  ///< handle's rotation vector a, displacement Δp of Ho

  Vec6 delta() const { return h * V_next; }
  Vec6 dV() const { return V_next - V; }
};

/// Energy of one part of the loop in one tick, J.
struct TickEnergy {
  double from_tool = 0;    ///< energy into the part from the tool
  double from_handle = 0;  ///< energy into the part from the handle
  double damped = 0;       ///< energy that the part's damper took
  double bound = 0;        ///< energy that sampling may seem to make
};

/// Returns the energies of a source of wrench whose object rests.
///
/// With the model [F; K; B] at the start, the step applies F − B ΔV − K δ. Its
/// work on the tool is
///   W = δᵀ(F − B ΔV − K δ) = δᵀF₀ − δᵀK δ − δᵀB V⁺,   F₀ = F + B V,
/// where F₀ is the force on a tool at rest and δᵀB V⁺ the energy that the
/// damper takes.
///
/// The bound: let φ(s) = δᵀF₀ at the share s of the tick's path. If F₀ is the
/// gradient of −U, then U⁺ − U = −∫φ ds, and the source loses
///   −W − (U⁺ − U) = δᵀB V⁺ + δᵀK δ − (φ(0) − ∫φ ds).
/// If φ is nowhere below the smaller of its end values, the parenthesis is at
/// most max(0, φ(0) − φ(1)). So sampling explains
///   max(0, max(0, δᵀF₀ − δᵀF₀⁺) − δᵀK δ).
/// A spring that the tool reaches within the tick, or whose direction turns,
/// makes up to half of this bound. Forces without a potential, forces that jump
/// and negative dampers can make more.
TickEnergy SourceEnergy(const WrenchModel& start, const WrenchModel& end,
                        const TickMotion& motion);

/// Returns the energies of the virtual coupling: a spring and a damper between
/// tool and handle.
///
/// The reaction on the handle is held during the tick. With p from Ho to the
/// point where the handle holds the tool, it works along
/// x = [a; Δp + a × p], so that xᵀF comes from the handle. Let the spring have
/// the stretch [θ; s], the wrench S = [S_τ; S_f] and the energy U. Below its
/// limits S = [k_r θ; k s] and U = ½ k_r |θ|² + ½ k |s|²; above them U curves
/// less. So for the translation, with equality below the limit,
///   ΔU <= S_fᵀΔs + ½ k |Δs|²,
/// and for the rotation, with Θ = min(π, |θ| + |a| + |δ_ω|),
///   ΔU <= S_τᵀ(a − δ_ω) + ½ k_r (|a − δ_ω|² + Θ |a × δ_ω|):
/// along the path the second derivative of ½ |θ|² is at most
/// |a − δ_ω|² + |θ| |a × δ_ω|.
/// The damper would take D = (x − δ)ᵀB (x − δ)/h in continuous time; sampled,
/// it takes (F − S)ᵀ(x − δ) + δᵀB ΔV. So sampling explains, where above zero,
///   ½ k |Δs|² + ½ k_r (|a − δ_ω|² + Θ |a × δ_ω|)
///   + S_fᵀ(Δp_HT − a × p) + D − (F − S)ᵀ(x − δ) − δᵀB ΔV − δᵀK δ.
/// For a tool at rest and no damper this is the ½ k |Δs|² of every sampled
/// wall, which is reached (Colgate and Schenkel 1997).
TickEnergy CouplingEnergy(const WrenchModel& start, const CouplingGains& gains,
                          const CouplingStretch& from,
                          const CouplingStretch& to, const TickMotion& motion);

/// Returns the energy that the gyroscopic force makes because it is taken at
/// the start of the tick, J:
///   g = ½ V⁺ᵀ(M⁺ − M) V⁺ − h V⁺ᵀb,
/// of either sign and of order h²; in continuous time it is zero.
/// V⁺ᵀ times the tool's step gives, for its kinetic energy E and the work W of
/// each part, exactly
///   E⁺ − E = Σ W − ½ ΔVᵀM ΔV + g.
double GyroscopicEnergy(const ToolMotionTerms& start,
                        const ToolMotionTerms& end, const TickMotion& motion);

}  // namespace drake_haptics
