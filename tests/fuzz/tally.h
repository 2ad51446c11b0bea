#pragma once

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>

namespace drake_haptics::fuzz {

/// What a run saw: how much was asked, and everything that must not happen.
struct Tally {
  bool tells_inputs = false;  ///< print what is asked, as Python
  std::int64_t queries = 0;   ///< answers that were checked
  std::int64_t refusals = 0;  ///< inputs refused with std::invalid_argument
  std::int64_t apart = 0;     ///< answers by regime
  std::int64_t overlapping = 0;
  std::int64_t bounded = 0;  ///< answers whose search met its bound
  /// Overlaps of solids in several pieces that began within one step, with
  /// surfaces that cross, and those
  /// which a tracker did not meet that had come, or that began there.
  std::int64_t landings = 0, unmet = 0, unmet_at_first = 0;
  std::size_t most_hubs = 0;  ///< hubs that the longest walk looked at
  std::map<std::string, std::int64_t> violations;  ///< by the broken promise
  std::string last_violation;                      ///< with its figures

  bool is_clean() const { return violations.empty(); }

  /// Counts a broken promise and keeps its figures.
  [[gnu::format(printf, 3, 4)]] void Violated(const char* promise,
                                              const char* figures, ...) {
    ++violations[promise];
    char text[512];
    va_list arguments;
    va_start(arguments, figures);
    std::vsnprintf(text, sizeof text, figures, arguments);
    va_end(arguments);
    last_violation = std::string(promise) + ": " + text;
  }
};

}  // namespace drake_haptics::fuzz
