#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

#include "mesh/decomposition.h"

/// Shapes that Python passes in: a Decomposition, or its core's ConvexPieces.
namespace drake_haptics {

using DecompositionPtr = std::shared_ptr<const Decomposition>;

/// @param name the argument, for messages.
/// @throws std::invalid_argument unless it is a decomposition.
DecompositionPtr ToDecomposition(nanobind::handle value,
                                 const std::string& name);

/// The shapes of a scene's objects.
/// @throws std::invalid_argument unless they are one decomposition or more.
std::vector<DecompositionPtr> ToDecompositions(nanobind::handle values);

}  // namespace drake_haptics
