#include "bind.h"

namespace drake_haptics {

void BindDecomposition(nanobind::module_& m) {}

}  // namespace drake_haptics
