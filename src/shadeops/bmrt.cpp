// Shadeops of BMRT that shaders of its time call, and bump() of the first interface: written in RSL over our own.
#include "shadeops/describe.h"

namespace alpenglow::rsl {

std::vector<Shadeop> bmrtShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, const char* signature, const char* doc, const char* source, const char* rsl) -> Shadeop& {
        Shadeop op;
        op.section = "Ray tracing";
        op.source = source;
        op.name = name;
        op.signatures = sigs({{signature}});
        op.contexts = kSurface | kVolume | kLight;
        op.lowering = Lowering::Rsl;
        op.derivative = DerivativeRule::Inherent;
        op.pure = false;
        op.doc = doc;
        op.rsl = rsl;
        list.push_back(std::move(op));
        return list.back();
    };
    add("visibility", "color visibility(point a, point b)", "Visibility between two points: transmission(a, b).", "BMRT", R"(
color visibility(point a, b) { return transmission(a, b); }
)");
    add("rayhittest", "float rayhittest(point from; vector dir; output point Ph, output vector Nh)",
        "Distance from `from` along dir to the nearest surface that is visible to transmission rays, in units of length; above 1e30 for none. Ph becomes "
        "the point that was hit, Nh the normal there; both stay as they are when nothing was hit.",
        "BMRT", R"(
float rayhittest(point from; vector dir; output point Ph; output vector Nh) {
    float dist = 1e38;
    vector n = 0;
    vector d = normalize(dir);
    color c = trace(from, d, dist, "type", "transmission", "hitnormal", n);
    if (dist < 1e30) {
        Ph = from + dist * d;
        Nh = n;
    }
    return dist;
}
)");
    add("fulltrace",
        "float fulltrace(point pos; vector dir; output color hitcolor; output float hitdist; output point Phit; output vector Nhit; output point Pmiss; output "
        "vector Rmiss)",
        "Traces a ray from pos along dir. On a hit 1, with the colour, the distance, the point and the normal of the hit; else 0, with Pmiss = pos and Rmiss = dir, "
        "the ray that saw nothing, hitcolor the light from there and hitdist above 1e30. What does not apply stays as it is.",
        "BMRT", R"(
float fulltrace(point pos; vector dir; output color hitcolor; output float hitdist; output point Phit; output vector Nhit; output point Pmiss; output vector Rmiss) {
    float dist = 1e38;
    vector n = 0;
    vector d = normalize(dir);
    float found = 0;
    hitcolor = trace(pos, d, dist, "hitnormal", n);
    hitdist = dist; // published shaders tell a miss by it
    if (dist < 1e30) {
        Phit = pos + dist * d;
        Nhit = n;
        found = 1;
    } else {
        Pmiss = pos;
        Rmiss = dir;
    }
    return found;
}
)");
    Shadeop& bump = add("bump", "point bump(string name; normal norm; vector dPds, vector dPdt)",
                        "Displacement of the normal by a bump map, for N = normalize(bump(...) + N): the height in the first channel of the texture "
                        "is read at s, t and beside them, and its slopes along dPds and dPdt tilt the normal.",
                        "RISpec 3.0 (bump maps); formula (k)", R"(
point bump(string name; normal norm; vector dPds; vector dPdt) {
    extern float s, t;
    float d = 1 / 1024;
    float hs = (float texture(name, s + d, t) - float texture(name, s - d, t)) / (2 * d);
    float ht = (float texture(name, s, t + d) - float texture(name, s, t - d)) / (2 * d);
    vector n = normalize(vector norm);
    vector turn = hs * (n ^ dPdt) - ht * (n ^ dPds);
    return point(xcomp(turn), ycomp(turn), zcomp(turn));
}
)");
    bump.section = "Texture";
    bump.contexts = kAnyContext;
    bump.bias = Bias::Biased;
    bump.biasReason = "values are filtered over the footprint before they are used";
    return list;
}

} // namespace alpenglow::rsl
