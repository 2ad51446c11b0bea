#include "bind.h"

namespace drake_haptics {

void BindQuery(nanobind::module_& m) {}

}  // namespace drake_haptics
