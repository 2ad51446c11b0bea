#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "bind/bind_eigen.h"

/// Each bind_<topic>.cc adds one topic to the Python module `_core`.
namespace drake_haptics {

/// "1 piece", "2 pieces".
inline std::string Counted(std::size_t number, const char* noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

void BindAdvance(nanobind::module_& m);
void BindAutoDiff(nanobind::module_& m);
void BindPolytope(nanobind::module_& m);
void BindDecomposition(nanobind::module_& m);
void BindContact(nanobind::module_& m);
void BindConvexPair(nanobind::module_& m);
void BindTracker(nanobind::module_& m);
void BindClustering(nanobind::module_& m);
void BindPenaltyForce(nanobind::module_& m);
void BindConstraintStep(nanobind::module_& m);
void BindTool(nanobind::module_& m);
void BindAutoDiffContact(nanobind::module_& m);
void BindAutoDiffForce(nanobind::module_& m);
void BindShading(nanobind::module_& m);
void BindFriction(nanobind::module_& m);
void BindBraking(nanobind::module_& m);
void BindPassivity(nanobind::module_& m);
void BindHand(nanobind::module_& m);
void BindEnergy(nanobind::module_& m);
void BindPackets(nanobind::module_& m);
void BindGate(nanobind::module_& m);
void BindServo(nanobind::module_& m);
void BindContactServo(nanobind::module_& m);
void BindToolLoop(nanobind::module_& m);
void BindContactChain(nanobind::module_& m);
void BindForeignContacts(nanobind::module_& m);

}  // namespace drake_haptics
