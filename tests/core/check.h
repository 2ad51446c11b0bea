#pragma once

#include <chrono>
#include <cstdio>
#include <thread>

/// Tests are plain programs: `return drake_haptics::FailedChecks() > 0;`.
namespace drake_haptics {

inline int& FailedChecks() {
  static int failed = 0;
  return failed;
}

}  // namespace drake_haptics

/// Reports and counts a condition that does not hold; the test goes on.
#define CHECK(condition)                                                   \
  do {                                                                     \
    if (!(condition)) {                                                    \
      std::fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      ++drake_haptics::FailedChecks();                                     \
    }                                                                      \
  } while (false)

/// Counts a failure unless the statement throws the exception.
#define CHECK_THROWS(statement, exception) \
  do {                                     \
    bool thrown = false;                   \
    try {                                  \
      statement;                           \
    } catch (const exception&) {           \
      thrown = true;                       \
    }                                      \
    CHECK(thrown && #statement);           \
  } while (false)

namespace drake_haptics {

/// Waits until another thread has made a condition true, and counts a failure
/// after a minute, so that a test never hangs. It sleeps between two looks: a
/// busy wait would take the processor from the thread that it waits for.
template <typename Condition>
void WaitUntil(Condition condition) {
  const auto begin = std::chrono::steady_clock::now();
  while (!condition()) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::minutes(1)) {
      CHECK(!"the condition has not become true within a minute");
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

}  // namespace drake_haptics
