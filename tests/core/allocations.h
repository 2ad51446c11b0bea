// Counts what a program of tests allocates, and lets its memory run out. It
// replaces the global operators: a program includes it in one of its files.
#pragma once

#include <cstdlib>
#include <new>

namespace drake_haptics {

inline long allocations = 0;
inline long last_allocation = -1;  // the one before memory is full; -1: none

}  // namespace drake_haptics

void* operator new(std::size_t size) {
  using namespace drake_haptics;
  if (++allocations > last_allocation && last_allocation >= 0) {
    throw std::bad_alloc();
  }
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++drake_haptics::allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
