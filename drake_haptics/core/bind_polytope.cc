#include "bind.h"

namespace drake_haptics {

void BindPolytope(nanobind::module_& m) {}

}  // namespace drake_haptics
