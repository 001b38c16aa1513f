/* No library of procedurals: two of its functions are missing. */
#include <ri.h>

RtPointer ConvertParameters(RtString data) { return data; }
