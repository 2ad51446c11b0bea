#include "bind.h"

NB_MODULE(_core, m) {
  m.doc() =
      "The compiled core of drake_haptics: geometry, contact query, clustering "
      "and wrenches. Use the classes of drake_haptics, which document and "
      "check "
      "their input; this module is their engine.";
  // Drake keeps the Python systems of a Diagram alive until the interpreter is
  // gone, and with them what they hold of ours: no leak, but reported as one.
  nanobind::set_leak_warnings(false);
  drake_haptics::BindPolytope(m);
  drake_haptics::BindDecomposition(m);
  drake_haptics::BindQuery(m);
  drake_haptics::BindForce(m);
  drake_haptics::BindHand(m);
}
