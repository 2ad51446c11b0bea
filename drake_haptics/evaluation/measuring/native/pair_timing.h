#pragma once

#include <chrono>

/// What the adapters of compiled libraries share. Poses are row-major 4x4.
namespace bench {

/// Calls `query` and returns the seconds it took.
template <typename Query>
double Timed(const Query& query) {
  const auto start = std::chrono::steady_clock::now();
  query();
  const auto end = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(end - start).count();
}

}  // namespace bench
