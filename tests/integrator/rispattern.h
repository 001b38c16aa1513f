// Patterns of RIS in a scene of one square, for tests of their values.
#pragma once
#include "integrator/maps.h"

namespace alpenglow::integrator::testing::ris {

inline constexpr float kX = .25f, kY = .5f; // where the square is seen, from the origin

/// A scene of a node "n" whose output a square shows that is 2 across at z = 2, whose s is (x + 1) / 2 and t (1 - y) / 2.
/// type: of the output, float, color or vector. before: attributes and patterns that stand before it. primitive: in place of
/// the square. beside: other primitives, before it.
inline Scene sceneOf(const std::string& node, const std::string& output, const std::string& type, const std::string& before = "",
                     const std::string& primitive = "", const std::string& beside = "") {
    writeShader("showsfloat", "surface showsfloat(varying float x = -7;) { Oi = 1; Ci = color(x, x, x); }\n");
    writeShader("showscolor", "surface showscolor(varying color x = -7;) { Oi = 1; Ci = x; }\n");
    writeShader("showsvector",
                "surface showsvector(varying vector x = -7;) { Oi = 1; Ci = color(xcomp(x), ycomp(x), zcomp(x)); }\n");
    Settings set;
    set.hider = Hider::Path;
    const std::string name = node.substr(0, node.find(' ')), rest = node.substr(name.size());
    return Scene(
        "WorldBegin\n" + beside + before + "Pattern \"" + name + "\" \"n\"" + rest + "\nBxdf \"shows" + type +
            "\" \"b\" \"reference " + type + " x\" [\"n:" + output + "\"]\n" +
            (primitive.empty() ? "Polygon \"P\" [-1 1 2  1 1 2  1 -1 2  -1 -1 2] \"st\" [0 0  1 0  1 1  0 1]\n" : primitive) +
            "WorldEnd\n",
        set);
}
/// What the node gives at (kX, kY, 2).
inline Color given(const std::string& node, const std::string& output, const std::string& type, const std::string& before = "",
                   const std::string& primitive = "") {
    return sceneOf(node, output, type, before, primitive).one(rayTo({0, 0, 0}, {kX, kY, 2}));
}
inline float number(const std::string& node, const std::string& output = "resultF", const std::string& before = "") {
    return given(node, output, "float", before).x;
}
inline void expectColor(const Color& c, double r, double g, double b, double tolerance, const std::string& what) {
    EXPECT_NEAR(c.x, r, tolerance) << what;
    EXPECT_NEAR(c.y, g, tolerance) << what;
    EXPECT_NEAR(c.z, b, tolerance) << what;
}
/// A map of one colour.
inline std::string flatMap(const char* name, float r, float g, float b) { return writeMap(name, 4, 4, Color(r, g, b)); }

} // namespace alpenglow::integrator::testing::ris
