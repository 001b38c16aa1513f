// A large floor y = 0 seen at the origin, with lights of constant Cl above it and surfaces that loop over them.
#pragma once
#include "integrator/floorscene.h"

namespace lightloop_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

inline std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface " + surface + "\n" + kFloor + "AttributeEnd\nWorldEnd\n";
}
/// A surface with the body of a function that sets Ci.
inline void surfaceOf(const std::string& name, const std::string& body, const std::string& parameters = "") {
    writeShader(name, "surface " + name + "(" + parameters + ") {\n    Ci = 0; Oi = 1;\n" + body + "\n}\n");
}
/// Light of constant Cl = c, h above the origin, of categories.
inline void writeLights() {
    writeShader(
        "flat",
        R"(light flat(float c = 1; float h = 2; string __category = ""; float __nondiffuse = 0; float __nonspecular = 0;) {
    illuminate(point "world" (0, h, 0)) Cl = c;
}
)");
}
inline std::string flat(int handle, float c, float h = 2, const std::string& more = "") {
    return "LightSource \"flat\" " + std::to_string(handle) + " \"float c\" " + std::to_string(c) + " \"float h\" " +
           std::to_string(h) + " " + more + "\n";
}
inline std::string category(const std::string& c) { return "\"string __category\" \"" + c + "\""; }

/// The same value at every hider, waiting for rays or not.
inline void expectEverywhere(const std::string& rib, Color want, const std::string& what) {
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(rib, under(h, suspend));
            const Color c = s.one(kView);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c[k], want[k], 1e-5 * std::max(1.f, want[k]))
                    << what << ", hider " << int(h) << (suspend ? ", suspended" : "") << s.messages();
            EXPECT_EQ(s.diagnostics.warnings(), 0) << what << s.messages();
        }
}

} // namespace lightloop_test
