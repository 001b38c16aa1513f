// A module that reads pictures (display/foreign.h) and asks for more memory than any small file can need.
#include "display/foreign.h"
#include <cstdlib>
#include <cstring>

extern "C" int alpenglow_read_picture(const char*, int, const alpenglow::display::ForeignLimits*, char* why, int whySize) {
    void* all = std::malloc(size_t(16) << 30);
    if (all) *static_cast<volatile char*>(all) = 1; // or the compiler leaves both calls out
    std::strncpy(why, all ? "it had 16 GiB" : "out of memory", size_t(whySize) - 1);
    std::free(all);
    return 1;
}
