#pragma once

#include <cstddef>

namespace drake_haptics {

/// Asks the system to run the calling thread before all others that are not of
/// this kind (SCHED_FIFO).
/// @returns whether it was granted, which usually needs a privilege.
bool RequestRealtimePriority();

/// Asks the system to keep memory from being paged out.
/// @returns whether it was granted.
bool RequestLockedMemory(const void* begin, std::size_t size);

}  // namespace drake_haptics
