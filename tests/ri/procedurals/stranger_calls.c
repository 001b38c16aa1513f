/* Calls what nobody has. */
#include <ri.h>

extern RtVoid RiNotThere(void);

RtPointer ConvertParameters(RtString data) { return 0; }
RtVoid Subdivide(RtPointer data, RtFloat detail) { RiNotThere(); }
RtVoid Free(RtPointer data) {}
