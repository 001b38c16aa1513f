// ri.h: maps of pictures.
#include "ri/c/filters.h"
#include "ri/c/pairs.h"

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

Building& filtered(Building& b, RtFilterFunc filter, RtFloat swidth, RtFloat twidth) {
    return filterName(b, filter, swidth, twidth).number(swidth).number(twidth);
}

} // namespace

extern "C" {

#define ALPENGLOW_FLAT_MAP(request)                                                                                              \
    RtVoid Ri##request##V(RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,   \
                          RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]) {                                       \
        Building b(#request);                                                                                                    \
        b.text(picture).text(texture).text(swrap).text(twrap);                                                                   \
        filtered(b, filter, swidth, twidth).parameters(n, tokens, values).run();                                                 \
    }                                                                                                                            \
    RtVoid Ri##request(RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,      \
                       RtFloat twidth, ...) {                                                                                    \
        ALPENGLOW_PAIRS(twidth);                                                                                                 \
        Ri##request##V(picture, texture, swrap, twrap, filter, swidth, twidth, ALPENGLOW_LIST);                                  \
    }
ALPENGLOW_FLAT_MAP(MakeTexture)
ALPENGLOW_FLAT_MAP(MakeBump)

RtVoid RiMakeLatLongEnvironmentV(RtToken picture, RtToken texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, RtInt n,
                                 RtToken tokens[], RtPointer values[]) {
    Building b("MakeLatLongEnvironment");
    b.text(picture).text(texture);
    filtered(b, filter, swidth, twidth).parameters(n, tokens, values).run();
}
RtVoid RiMakeLatLongEnvironment(RtToken picture, RtToken texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, ...) {
    ALPENGLOW_PAIRS(twidth);
    RiMakeLatLongEnvironmentV(picture, texture, filter, swidth, twidth, ALPENGLOW_LIST);
}

RtVoid RiMakeCubeFaceEnvironmentV(RtToken px, RtToken nx, RtToken py, RtToken ny, RtToken pz, RtToken nz, RtToken texture,
                                  RtFloat fov, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, RtInt n, RtToken tokens[],
                                  RtPointer values[]) {
    Building b("MakeCubeFaceEnvironment");
    b.text(px).text(nx).text(py).text(ny).text(pz).text(nz).text(texture).number(fov);
    filtered(b, filter, swidth, twidth).parameters(n, tokens, values).run();
}
RtVoid RiMakeCubeFaceEnvironment(RtToken px, RtToken nx, RtToken py, RtToken ny, RtToken pz, RtToken nz, RtToken texture,
                                 RtFloat fov, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, ...) {
    ALPENGLOW_PAIRS(twidth);
    RiMakeCubeFaceEnvironmentV(px, nx, py, ny, pz, nz, texture, fov, filter, swidth, twidth, ALPENGLOW_LIST);
}

ALPENGLOW_NAMED_TWICE(MakeShadow)

#define ALPENGLOW_MAP_OF_SEVERAL(request)                                                                                        \
    RtVoid Ri##request##V(RtInt nfiles, RtString files[], RtToken map, RtInt n, RtToken tokens[], RtPointer values[]) {          \
        Building(#request).texts(files, nfiles).text(map).parameters(n, tokens, values).run();                                   \
    }                                                                                                                            \
    RtVoid Ri##request(RtInt nfiles, RtString files[], RtToken map, ...) {                                                       \
        ALPENGLOW_PAIRS(map);                                                                                                    \
        Ri##request##V(nfiles, files, map, ALPENGLOW_LIST);                                                                      \
    }
ALPENGLOW_MAP_OF_SEVERAL(MakeBrickMap)
ALPENGLOW_MAP_OF_SEVERAL(MakeOcclusion)

} // extern "C"
