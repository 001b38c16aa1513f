// Shadeops of BMRT that shaders of its time call, and bump() of the first interface: written in RSL over our own.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {

/// Adds a shadeop written in RSL.
Shadeop& addRayTest(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, const char* doc,
                    const char* source, const char* rsl) {
    Shadeop op;
    op.section = "Ray tracing";
    op.source = source;
    op.name = name;
    op.signatures = std::move(signatures);
    op.contexts = kSurface | kVolume | kLight;
    op.lowering = Lowering::Rsl;
    op.derivative = DerivativeRule::Inherent;
    op.pure = false;
    op.doc = doc;
    op.rsl = rsl;
    list.push_back(std::move(op));
    return list.back();
}

void addVisibility(std::vector<Shadeop>& list) {
    addRayTest(
        list, "visibility", sigs({{"color visibility(point a, point b; pairs)"}, {"float visibility(point a, point b; pairs)"}}),
        "Visibility between two points: transmission(a, b). The float form is Pixie's: the mean of the components.", "BMRT",
        R"(
color visibility(point a; point b; string label; string subset; string excludesubset; string hitmode; string hitsides; float bias;
                 float maxdist) {
    return transmission(a, b, "label", label, "subset", subset, "excludesubset", excludesubset, "hitmode", hitmode,
                        "hitsides", hitsides, "bias", bias, "maxdist", maxdist);
}
float visibility(point a; point b; string label; string subset; string excludesubset; string hitmode; string hitsides; float bias;
                 float maxdist) {
    color c = transmission(a, b, "label", label, "subset", subset, "excludesubset", excludesubset, "hitmode", hitmode,
                           "hitsides", hitsides, "bias", bias, "maxdist", maxdist);
    return (comp(c, 0) + comp(c, 1) + comp(c, 2)) / 3;
}
)");
    list.back().examples = {{"color visibility(P, P + N)", "1 1 1", "", kNothing},
                            {"float visibility(P, P + N)", "1", "", kNothing}};
}

/// Where a ray meets something.
void addHitTests(std::vector<Shadeop>& list) {
    addRayTest(
        list, "rayhittest", sigs({{"float rayhittest(point from; vector dir; output point Ph, output vector Nh; pairs)"}}),
        "Distance from `from` along dir to the nearest surface that is visible to transmission rays, in units of length; above "
        "1e30 for none. Ph becomes "
        "the point that was hit, Nh the normal there; both stay as they are when nothing was hit.",
        "BMRT", R"(
float rayhittest(point from; vector dir; output point Ph; output vector Nh; string label; string subset; string excludesubset;
                 string hitmode; string hitsides; float bias; float maxdist) {
    float dist = 1e38;
    vector n = 0;
    vector d = normalize(dir);
    color c = trace(from, d, dist, "type", "transmission", "hitnormal", n, "label", label, "subset", subset,
                    "excludesubset", excludesubset, "hitmode", hitmode, "hitsides", hitsides, "bias", bias, "maxdist", maxdist);
    if (dist < 1e30) {
        Ph = from + dist * d;
        Nh = n;
    }
    return dist;
}
)");
    list.back().examples = {{"rayhittest(P, N, p, n)", "2", "point p = 0; vector n = 0;", "a surface stands 2 away along N"}};
    addRayTest(
        list, "fulltrace",
        sigs({{"float fulltrace(point pos; vector dir; output color hitcolor; output float hitdist; output point Phit; output "
               "vector Nhit; output point Pmiss; output vector Rmiss; pairs)"}}),
        "Traces a ray from pos along dir. On a hit 1, with the colour, the distance, the point and the normal of the hit; else "
        "0, with Pmiss = pos and Rmiss = dir, "
        "the ray that saw nothing, hitcolor the light from there and hitdist above 1e30. What does not apply stays as it is.",
        "BMRT", R"(
float fulltrace(point pos; vector dir; output color hitcolor; output float hitdist; output point Phit; output vector Nhit;
                output point Pmiss; output vector Rmiss; string label; string subset; string excludesubset; string hitmode;
                string hitsides; float bias; float maxdist) {
    float dist = 1e38;
    vector n = 0;
    vector d = normalize(dir);
    float found = 0;
    hitcolor = trace(pos, d, dist, "hitnormal", n, "label", label, "subset", subset, "excludesubset", excludesubset,
                     "hitmode", hitmode, "hitsides", hitsides, "bias", bias, "maxdist", maxdist);
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
    list.back().examples = {{"fulltrace(P, N, c, d, p, n, m, r)", "0",
                             "color c = 0; float d = 0; point p = 0, m = 0; vector n = 0, r = 0;", kNothing}};
}

/// Of those so far: BMRT had no optional parameters.
void addRayOptions(std::vector<Shadeop>& list) {
    const Type text{Base::String, 0}, real{Base::Float, 0};
    for (Shadeop& op : list) // those of trace() are as good here. The texts take them in this order
        op.optional = {{text, "label", false, "\"\"", "label of the ray, for rayinfo"},
                       {text, "subset", false, "\"\"", "groups of objects considered"},
                       {text, "excludesubset", false, "\"\"", "groups of objects left out"},
                       {text, "hitmode", false, "\"default\"", "primitive, shader or default"},
                       {text, "hitsides", false, "", "front, back, both or reversed"},
                       {real, "bias", false, "-1", "offset of the ray's start"},
                       {real, "maxdist", false, "1e38", "no intersections beyond this distance"}};
}

void addBump(std::vector<Shadeop>& list) {
    Shadeop& bump =
        addRayTest(list, "bump", sigs({{"point bump(string name; normal norm; vector dPds, vector dPdt; pairs)"}}),
                   "Displacement of the normal by a bump map, for N = normalize(bump(...) + N): the height in the first "
                   "channel of the texture "
                   "is read at s, t (or at ss, tt) and next to them, and its slopes along dPds and dPdt tilt the normal.",
                   "RISpec 3.0 (bump maps); the formula is ours", R"(
point bump(string name; normal norm; vector dPds; vector dPdt; float ss; float tt; float blur; float width) {
    float d = 1 / 1024;
    float h(float x; float y) {
        extern string name;
        extern float blur, width;
        return float texture(name, x, y, "blur", blur, "width", width);
    }
    float hs = (h(ss + d, tt) - h(ss - d, tt)) / (2 * d);
    float ht = (h(ss, tt + d) - h(ss, tt - d)) / (2 * d);
    vector n = normalize(vector norm);
    vector turn = hs * (n ^ dPdt) - ht * (n ^ dPds);
    return point(xcomp(turn), ycomp(turn), zcomp(turn));
}
point bump(string name; normal norm; vector dPds; vector dPdt; float blur; float width) {
    extern float s, t;
    return bump(name, norm, dPds, dPdt, s, t, blur, width);
}
)");
    list.back().examples = {{"bump(\"bumps.tex\", N, dPdu, dPdv)", "0 0 0", "", "the map is the same everywhere"}};
    bump.signatures =
        bump.signatures + sigs({{"point bump(string name; normal norm; vector dPds, vector dPdt; float ss, float tt; pairs)"}});
    bump.optional = {{{Base::Float, 0}, "blur", false, "0", "added to the filter size, fraction of the map"},
                     {{Base::Float, 0}, "width", false, "1", "multiplies the filter size"}};
    bump.section = "Texture";
    bump.contexts = kAnyContext;
    bump.bias = Bias::Biased;
    bump.biasReason = "values are filtered over the footprint before they are used";
}

} // namespace

std::vector<Shadeop> rayTestShadeops() {
    std::vector<Shadeop> list;
    addVisibility(list);
    addHitTests(list);
    addRayOptions(list);
    addBump(list);
    return list;
}

} // namespace alpenglow::shadeops
