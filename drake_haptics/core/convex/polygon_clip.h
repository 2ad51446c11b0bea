#pragma once

#include <cstddef>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Keeps the part of a convex polygon, or of a segment given as two corners,
/// where a linear function is not negative (Sutherland and Hodgman 1974).
/// @param value the function, called with a point.
/// @param buffer memory kept between calls, so that they do not allocate.
template <typename Value>
void ClipPolygon(const Value& value, std::vector<Vec3>* polygon,
                 std::vector<Vec3>* buffer) {
  buffer->clear();
  const std::size_t count = polygon->size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = (*polygon)[i];
    const double at_p = value(p);
    if (at_p >= 0) buffer->push_back(p);
    if (count == 2 && i == 1) break;  // A segment does not close.
    const Vec3& q = (*polygon)[(i + 1) % count];
    const double at_q = value(q);
    if ((at_p < 0) != (at_q < 0) && at_p != at_q) {
      buffer->push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
  }
  polygon->swap(*buffer);
}

}  // namespace drake_haptics
