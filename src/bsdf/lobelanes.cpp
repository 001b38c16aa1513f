#include "bsdf/lobelanes.h"

namespace alpenglow::bsdf {

// One for each file compiled from lanes/stages.inc: lanes, and level of x86-64.
LobeLanesList lobeLanes_1v2(), lobeLanes_1v3(), lobeLanes_4v2(), lobeLanes_8v3(), lobeLanes_16v4();

namespace {
bool has3() {
    static const bool has = __builtin_cpu_supports("x86-64-v3");
    return has;
}
bool has4() {
    static const bool has = __builtin_cpu_supports("x86-64-v4");
    return has;
}
} // namespace

LobeLanesList lobeLanes(int width) {
    switch (width) {
    case 1:
        return has3() ? lobeLanes_1v3() : lobeLanes_1v2();
    case 4:
        return lobeLanes_4v2();
    case 8:
        return has3() ? lobeLanes_8v3() : LobeLanesList{};
    case 16:
        return has4() ? lobeLanes_16v4() : LobeLanesList{};
    default:
        return {};
    }
}

int lobeWidth() { return has4() ? 16 : has3() ? 8 : 4; }

} // namespace alpenglow::bsdf
