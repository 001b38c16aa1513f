#include "rsl/front/prelude.h"
#include <iterator>

namespace alpenglow::rsl::front {

namespace {

struct BuiltIn {
    const char* name;
    const char* text;
};

// filterregion: where a shader wants a map to be read, as four corners in s and t or as four directions or points; `blurred` is
// given to the map as its "blur", and spread is the half angle of the cone of directions.
// __radiancesample: a direction with what a light sends from there and what a surface makes of it.
// normalizeMaterialResponse: of samples of several lobes, so many of each, one mean is taken over all; each lobe counts in full
// then. accumulateMaterialResponse: the lobes of evaluateSamples() one after the other, each with a call of it, add up. What
// names another stands before it. raydepth, raylabel, clearlighting: of Pixie; nothing is kept of lights that could be cleared.
constexpr BuiltIn kBuiltIns[] = {{"sincos", R"(
void sincos(float angle; output float sine, cosine) {
    sine = sin(angle);
    cosine = cos(angle);
}
)"},
                                 {"raydepth", R"(
float raydepth() {
    float depth = 0;
    rayinfo("depth", depth);
    return depth;
}
)"},
                                 {"raylabel", R"(
string raylabel() {
    string label = "";
    rayinfo("label", label);
    return label;
}
)"},
                                 {"clearlighting", R"(
void clearlighting() {}
)"},
                                 {"normalizeMaterialResponse", R"(
void normalizeMaterialResponse(output __radiancesample samples[]; uniform float counts[]) {
    uniform float lobes = arraylength(counts), n = arraylength(samples), first = 0, lobe, i;
    for (lobe = 0; lobe < lobes; lobe += 1) {
        uniform float last = min(n, first + counts[lobe]);
        for (i = first; i < last; i += 1) samples[i]->materialResponse *= n / counts[lobe];
        first = last;
    }
}
)"},
                                 {"accumulateMaterialResponse", R"(
void accumulateMaterialResponse(output __radiancesample samples[]) {
    uniform float i, n = arraylength(samples);
    for (i = 0; i < n; i += 1) {
        samples[i]->summedResponse += samples[i]->materialResponse;
        samples[i]->summedPdf += samples[i]->materialPdf;
        samples[i]->materialResponse = samples[i]->summedResponse;
        samples[i]->materialPdf = samples[i]->summedPdf;
    }
}
)"},
                                 {"filterregion", R"(
struct filterregion {
    varying float s1 = 0, t1 = 0, s2 = 0, t2 = 0, s3 = 0, t3 = 0, s4 = 0, t4 = 0;
    varying vector v1 = 0, v2 = 0, v3 = 0, v4 = 0, centre = 0;
    varying float blurred = 0, spread = 0;
    public void calculate2d(varying float x, y) {
        extern float du, dv;
        calculate2d(x, y, Du(x) * du, Du(y) * du, Dv(x) * dv, Dv(y) * dv);
    }
    public void calculate2d(varying float x, y, x1, y1, x2, y2) {
        float ax = 0.5 * x1, ay = 0.5 * y1, bx = 0.5 * x2, by = 0.5 * y2;
        s1 = x - ax - bx; s2 = x + ax - bx; s3 = x - ax + bx; s4 = x + ax + bx;
        t1 = y - ay - by; t2 = y + ay - by; t3 = y - ay + by; t4 = y + ay + by;
        centre = vector(x, y, 0);
        blurred = 0;
    }
    public void calculate3d(varying vector x) {
        extern float du, dv;
        calculate3d(x, Du(x) * du, Dv(x) * dv);
    }
    public void calculate3d(varying vector x, side1, side2) {
        vector a = 0.5 * side1, b = 0.5 * side2;
        v1 = x - a - b; v2 = x + a - b; v3 = x - a + b; v4 = x + a + b;
        centre = x;
        spread = atan(max(length(a), length(b)), length(x));
        blurred = 0;
    }
    public void calculate3d(varying vector x; varying vector other) { calculate3d(x); }
    public void scale(float x, y) {
        float ms = 0.25 * (s1 + s2 + s3 + s4), mt = 0.25 * (t1 + t2 + t3 + t4);
        s1 = mix(ms, s1, x); s2 = mix(ms, s2, x); s3 = mix(ms, s3, x); s4 = mix(ms, s4, x);
        t1 = mix(mt, t1, y); t2 = mix(mt, t2, y); t3 = mix(mt, t3, y); t4 = mix(mt, t4, y);
        float k = max(x, y);
        v1 = centre + k * (v1 - centre); v2 = centre + k * (v2 - centre);
        v3 = centre + k * (v3 - centre); v4 = centre + k * (v4 - centre);
        spread *= k;
    }
    public void scale(float k) { scale(k, k); }
    public void blur(float b) { blurred += b; spread += b; }
    public void blur(float x, y) { blur(max(x, y)); }
}
)"},
                                 {"__radiancesample", R"(
struct __radiancesample {
    varying vector direction = 0;
    varying float distance = 1e38;
    varying color radiance = 0;
    varying color materialResponse = 0;
    varying float materialPdf = 0, lightPdf = 0;
    varying color summedResponse = 0;
    varying float summedPdf = 0;
    public void setMaterialResponse(varying color response; varying float pdf) { materialResponse = response; materialPdf = pdf; }
    public void setMaterialSample(varying color response; varying float pdf; varying vector dir; varying float dist) {
        setMaterialResponse(response, pdf);
        direction = dir;
        distance = dist;
    }
    public void setLightRadiance(varying color light; varying float pdf) { radiance = light; lightPdf = pdf; }
    public void setLightSample(varying color light; varying float pdf; varying vector dir; varying float dist) {
        setLightRadiance(light, pdf);
        direction = dir;
        distance = dist;
    }
}
)"}};

} // namespace

void addPrelude(SourceSet& sources, Preprocessed& p) {
    for (const BuiltIn& b : kBuiltIns) {
        bool named = false, defined = false;
        for (size_t i = 0; i < p.tokens.size(); ++i) {
            if (p.tokens[i].kind != Tok::Identifier || p.tokens[i].text != b.name) continue;
            const bool called = i + 1 < p.tokens.size() && p.tokens[i + 1].is("("); // or defined; variables may have the name
            const size_t next = called ? behind(p.tokens, i + 1) : p.tokens.size();
            named |= called || std::string_view(b.text).find("struct") != std::string_view::npos;
            defined |= next < p.tokens.size() && p.tokens[next].is("{");
            defined |= i > 0 && (p.tokens[i - 1].is("struct") || p.tokens[i - 1].is("void"));
        }
        if (!named || defined) continue;
        Preprocessed own = preprocess(sources, sources.add(std::string("<") + b.name + ">", b.text), {});
        own.tokens.pop_back(); // the end
        const size_t count = own.tokens.size();
        p.tokens.insert(p.tokens.begin(), std::make_move_iterator(own.tokens.begin()), std::make_move_iterator(own.tokens.end()));
        for (Annotation& a : p.annotations) a.token += count;
    }
}

/// Behind the bracket that closes the one at `open`; the end of the text if there is none.
size_t behind(const Tokens& t, size_t open) {
    int depth = 0;
    for (size_t i = open; i < t.size(); ++i) {
        if (t[i].is("(") || t[i].is("{") || t[i].is("[")) ++depth;
        if ((t[i].is(")") || t[i].is("}") || t[i].is("]")) && --depth == 0) return i + 1;
    }
    return t.size();
}

} // namespace alpenglow::rsl::front
