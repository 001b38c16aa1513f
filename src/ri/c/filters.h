// Pixel filters as functions of C (RISpec 3.2, appendix E).
#pragma once
#include "ri/c/client.h"

namespace alpenglow::ri {

/// The name of the filter that is, or computes the same as, this function, as the next text of a request. A function of a
/// program's own is an error, and "gaussian" stands for it.
Building& filterName(Building&, RtFilterFunc, RtFloat xwidth, RtFloat ywidth);

} // namespace alpenglow::ri
