#include "polytope.h"
