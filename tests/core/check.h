#pragma once

#include <cstdio>

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
