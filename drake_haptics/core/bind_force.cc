#include "bind.h"

namespace drake_haptics {

void BindForce(nanobind::module_& m) {}

}  // namespace drake_haptics
