/* Calls what nobody has. */
#include <ri.h>

extern RtVoid RiNotThere(void);

RtPointer ConvertParameters(RtString data) {
    (void)data;
    return 0;
}
RtVoid Subdivide(RtPointer data, RtFloat detail) {
    (void)data;
    (void)detail;
    RiNotThere();
}
RtVoid Free(RtPointer data) { (void)data; }
