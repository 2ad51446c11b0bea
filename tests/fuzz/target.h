#pragma once

#include <cstdint>
#include <span>

#include "tally.h"

namespace drake_haptics::fuzz {

/// What a fuzz target does with one input; each target defines it once.
/// Counts what it saw and every broken promise; throws nothing.
void RunInput(std::span<const std::uint8_t> bytes, Tally* tally);

}  // namespace drake_haptics::fuzz
