#pragma once

#include "byte_source.h"
#include "pair/convex_pair.h"
#include "tally.h"

namespace drake_haptics::fuzz {

/// The error that an answer about the pair may have, m.
double Tolerance(const PosedPair& pair, double distance);

/// Holds one answer against what its definition says of it:
///
/// - all values are finite, the normal is a unit vector, the features exist,
/// - p_a − p_b = d · n, and both points are on their bodies (but for the
///   tilt of flush faces),
/// - d = h(n), the support gap along the normal,
/// - moved by −d · n the two touch and no more: no direction separates them
///   then. Apart this makes d the distance; in overlap it makes the depth a
///   local minimum of A ⊖ B,
/// - in overlap no direction separates the two as they are.
///
/// `probes` chooses directions to try; pairs of few features are enumerated.
void CheckAnswer(const PosedPair& pair, const PairContact& answer,
                 ByteSource* probes, Tally* tally);

}  // namespace drake_haptics::fuzz
