#pragma once

/// Checks of user input. Messages contain the name, the bound and the value.
namespace drake_haptics {

/// @throws std::invalid_argument unless the value is finite and above zero.
void RequirePositive(double value, const char* name);

/// @throws std::invalid_argument unless the value is finite and at least zero.
void RequireNotNegative(double value, const char* name);

}  // namespace drake_haptics
