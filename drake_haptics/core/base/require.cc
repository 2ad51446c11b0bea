#include "base/require.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace drake_haptics {
namespace {

[[noreturn]] void Refuse(double value, const char* name, const char* bound) {
  std::ostringstream message;
  message << name << " must be finite and " << bound << ", is " << value;
  throw std::invalid_argument(message.str());
}

}  // namespace

void RequirePositive(double value, const char* name) {
  if (!(value > 0 && std::isfinite(value))) Refuse(value, name, "above 0");
}

void RequireNotNegative(double value, const char* name) {
  if (!(value >= 0 && std::isfinite(value))) Refuse(value, name, "at least 0");
}

}  // namespace drake_haptics
