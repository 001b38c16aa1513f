// The seven quadrics (RISpec 3.2, 5.4): numbers in RIB order and primitive variables.
#include "ri/interpreter.h"

namespace alpenglow::ri {
namespace {

void quadric(Interpreter& in, const Call& c) {
    scene::Primitive p;
    p.numbers = c.reals(0);
    p.params = in.bind(c, Use::Primitive);
    in.emit(std::move(p), c);
}

} // namespace

std::vector<Request> quadricRequests() {
    const Kind k = Kind::Primitive;
    const unsigned s = kWorld | kObject;
    return {
        {"Sphere", "number[4] shape; ..", k, s, true, "radius zmin zmax thetamax (degrees).", "1 -1 1 360", quadric, nullptr,
         "RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax"},
        {"Cone", "number[3] shape; ..", k, s, true, "height radius thetamax.", "2 1 360", quadric, nullptr,
         "RtFloat height, RtFloat radius, RtFloat thetamax"},
        {"Cylinder", "number[4] shape; ..", k, s, true, "radius zmin zmax thetamax.", "1 -1 1 360", quadric, nullptr,
         "RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax"},
        {"Hyperboloid", "number[7] shape; ..", k, s, true, "point 1, point 2, thetamax.", "[1 0 0 1 1 1 360]", quadric, nullptr,
         "RtPoint point1, RtPoint point2, RtFloat thetamax"},
        {"Paraboloid", "number[4] shape; ..", k, s, true, "rmax zmin zmax thetamax.", "1 0 2 360", quadric, nullptr,
         "RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax"},
        {"Disk", "number[3] shape; ..", k, s, true, "height radius thetamax.", "0 1 360 \"Cs\" [1 0 0 0 1 0 0 0 1 1 1 1]",
         quadric, nullptr, "RtFloat height, RtFloat radius, RtFloat thetamax"},
        {"Torus", "number[5] shape; ..", k, s, true, "major radius, minor radius, phimin phimax thetamax.", "2 .5 0 360 360",
         quadric, nullptr, "RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax"},
    };
}

} // namespace alpenglow::ri
