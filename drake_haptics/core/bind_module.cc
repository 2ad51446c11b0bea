#include "bind.h"

NB_MODULE(_core, m) {
  m.doc() =
      "The compiled core of drake_haptics: geometry, contact query, clustering "
      "and wrenches. Use the classes of drake_haptics, which document and "
      "check "
      "their input; this module is their engine.";
  drake_haptics::BindPolytope(m);
  drake_haptics::BindDecomposition(m);
  drake_haptics::BindQuery(m);
  drake_haptics::BindForce(m);
}
