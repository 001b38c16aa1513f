// Class lights of PRMan that send their light through generateSamples(). Before anything is parsed they get a method light() that
// asks for the samples and puts each into two outputs, from which light loops take a turn for each (transport:
// BoundLight::sentL). And classes that say what they send by emit() in prelighting(): they get a light() that sends it from the
// surface of a primitive. What generatePhoton() gives is four more outputs, of which only kernels are made that send photons.
#include "base/limits.h"
#include "rsl/front/prelude.h"
#include <algorithm>
#include <array>
#include <iterator>
#include <string>

namespace alpenglow::rsl::front {

namespace {

constexpr const char* kSentOutputs = "output varying vector __sentL[MOST] = {0}; output varying color __sentCl[MOST] = {0};";
/// Where the class wants shadows and does not say how: shadowSamples() of PRMan without areashadow().
constexpr const char* kShadows = "uniform float __sentShadows = 1;";
/// Where its light() says zero: rsl::kSentOnly.
constexpr const char* kOnly = "uniform float __sentOnly = 1;";

// What a sample with radiance R and density pdf of n adds to the irradiance over pi that Cl means is R / (pi pdf n). A density of
// zero says that there is no sample. Those beyond MOST share the places of others: of two one is kept, in proportion to its
// luminance, for both.
constexpr const char* kLight = R"(
    public void light(output vector L; output color Cl) {
        PHOTON
        __radiancesample sent[];
        generateSamples("sphere", sent);
        SHADOWED
        uniform float i, n = arraylength(sent);
        float counted = 0;
        for (i = 0; i < n; i += 1)
            if (sent[i]->lightPdf != 0) counted += 1;
        color sum = 0;
        for (i = 0; i < n; i += 1) {
            uniform float place = mod(i, MOST);
            if (sent[i]->lightPdf > 0) {
                color c = sent[i]->radiance / (PI * sent[i]->lightPdf * counted);
                vector way = -min(sent[i]->distance, 1e15) * normalize(sent[i]->direction);
                float had = luminance(__sentCl[place]), comes = luminance(c);
                if (i < MOST || had <= 0) {
                    __sentL[place] = way;
                    __sentCl[place] = c;
                } else if (comes > 0) {
                    if (random() * (had + comes) < comes) {
                        __sentL[place] = way;
                        __sentCl[place] = c * ((had + comes) / comes);
                    } else {
                        __sentCl[place] *= (had + comes) / had;
                    }
                }
                sum += c;
            }
        }
        L = __sentL[0];
        Cl = sum;
    }
)";

// rsl::kPhotonFrom and its like
constexpr const char* kPhotonOutputs = "output varying point __photonFrom = 0; output varying vector __photonWay = 0; "
                                       "output varying color __photonPower = 0; output varying float __photonPdf = 0;";
constexpr const char* kPhoton = "generatePhoton(__photonFrom, __photonWay, __photonPower, __photonPdf);";

constexpr const char* kEmits = "uniform float __emits = 1;"; // rsl::kEmits
constexpr const char* kEmission = "varying color __emitted = 0;";
constexpr const char* kEmittingLight = R"(
    public void light(output vector L; output color Cl) {
        color c = 0, o = 1;
        __emitted = 0;
        prelighting(c, o);
        illuminate(P, N, PI / 2) Cl = __emitted;
    }
)";

/// Whether the method with parameters at `open` does nothing but set something to zero: it only says that the class is a light.
bool setsZero(const Tokens& t, size_t open) {
    const size_t body = behind(t, open);
    if (body >= t.size() || !t[body].is("{")) return false;
    const size_t end = behind(t, body);
    for (size_t i = body; i < end; ++i) {
        if (t[i].kind == Tok::Number && t[i].text.find_first_of("123456789") != std::string_view::npos) return false;
        if (t[i].kind != Tok::Identifier) continue;
        if (t[i].is("color") || t[i].is("vector") || t[i].is("point") || t[i].is("extern")) continue;
        if (!t[i + 1].is("=") && !t[i + 1].is(";")) return false;
    }
    return true;
}

/// What a class has of a light, as places among its tokens; 0: none.
struct Found {
    size_t light = 0;
    bool generates = false, surface = false;
    bool photons = false;                ///< generatePhoton() with four parameters
    bool shadows = false, casts = false; ///< it has shadowSamples(); that calls areashadow()
    std::vector<size_t> emits;           ///< calls of emit() in prelighting(), which has two parameters
    bool domain =
        false; ///< generateSamples() has a parameter that lights of PRMan call so; layers of materials call theirs otherwise
};

/// What stands between parameters or arguments from `begin` to the bracket before `end`.
int separators(const Tokens& t, size_t begin, size_t end) {
    int n = 0, depth = 0;
    for (size_t i = begin; i + 1 < end; ++i) {
        if (t[i].is("(") || t[i].is("[")) ++depth;
        if (t[i].is(")") || t[i].is("]")) --depth;
        n += depth == 0 && (t[i].is(";") || t[i].is(",")) && i + 2 < end;
    }
    return n;
}

Found methodsOf(const Tokens& t, size_t body, size_t end) {
    constexpr std::array<std::string_view, 8> kOthers = {"surface",      "lighting", "diffuselighting", "specularlighting",
                                                         "displacement", "volume",   "imager",          "opacity"};
    Found f;
    int depth = 0;
    for (size_t k = body + 1; k + 2 < end; ++k) {
        if (t[k].is("{")) ++depth;
        if (t[k].is("}")) --depth;
        if (depth != 0 || !t[k + 2].is("(")) continue;
        const size_t last = behind(t, k + 2);
        if (!t[k].is("void")) continue;
        if (t[k + 1].is("generateSamples")) { // (string; __radiancesample[])
            bool samples = false;
            for (size_t i = k + 3; i + 1 < last; ++i) {
                samples |= t[i].is("__radiancesample");
                f.domain |= t[i].is("integrationdomain");
            }
            f.generates |= samples && separators(t, k + 3, last) == 1;
        }
        if (t[k + 1].is("light")) f.light = k + 1;
        f.photons |= t[k + 1].is("generatePhoton") && separators(t, k + 3, last) == 3;
        const size_t close = last < end && t[last].is("{") ? behind(t, last) : last;
        if (t[k + 1].is("shadowSamples")) {
            f.shadows = true;
            for (size_t i = last; i < close; ++i) f.casts |= t[i].is("areashadow");
        }
        if (t[k + 1].is("prelighting") && separators(t, k + 3, last) == 1)
            for (size_t i = last; i + 1 < close; ++i)
                if (t[i].is("emit") && t[i + 1].is("(") && behind(t, i + 1) < close && t[behind(t, i + 1)].is(";"))
                    f.emits.push_back(i);
        for (std::string_view o : kOthers) f.surface |= t[k + 1].is(o);
    }
    return f;
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) text.replace(at, word.size(), by);
    return text;
}

/// The tokens of a text of our own.
Tokens tokensOf(SourceSet& sources, const std::string& text) {
    Preprocessed own = preprocess(
        sources, sources.add("<generateSamples>", replaced(text, "MOST", std::to_string(limits::kLightIterations))), {});
    own.tokens.pop_back(); // the end
    return std::move(own.tokens);
}

/// What a call of emit() at `call` adds up, as a statement before it: both stand in a block.
Tokens emission(const Tokens& t, size_t call) {
    const auto token = [&](Tok kind, std::string_view text) {
        Token x = t[call];
        x.kind = kind;
        x.text = text;
        return x;
    };
    size_t end = call + 2;
    for (int depth = 0; end < t.size(); ++end) {
        if (depth == 0 && (t[end].is(",") || t[end].is(")"))) break;
        if (t[end].is("(") || t[end].is("[") || t[end].is("{")) ++depth;
        if (t[end].is(")") || t[end].is("]") || t[end].is("}")) --depth;
    }
    Tokens out = {token(Tok::Punct, "{"), token(Tok::Identifier, "__emitted"), token(Tok::Punct, "+="),
                  token(Tok::Identifier, "color"), token(Tok::Punct, "(")};
    out.insert(out.end(), t.begin() + long(call) + 2, t.begin() + long(end));
    out.push_back(token(Tok::Punct, ")"));
    out.push_back(token(Tok::Punct, ";"));
    return out;
}

} // namespace

void readLitPoints(Preprocessed& p) {
    Tokens& t = p.tokens;
    for (size_t i = 0; i + 2 < t.size(); ++i) {
        if (!t[i].is("light") || t[i + 1].kind != Tok::Identifier || !t[i + 2].is("(")) continue;
        const size_t body = behind(t, i + 2);
        if (body >= t.size() || !t[body].is("{")) continue;
        const size_t end = behind(t, body);
        for (size_t k = i + 3; k < end; ++k)
            if (t[k].kind == Tok::Identifier && t[k].text == "P" && !t[k - 1].is("->")) t[k].text = "Ps";
        i = end - 1;
    }
}

void addSampledLights(SourceSet& sources, Preprocessed& p) {
    const auto means = [](const Token& t) { return t.is("generateSamples") || t.is("generatePhoton") || t.is("emit"); };
    if (std::none_of(p.tokens.begin(), p.tokens.end(), means)) return;
    Tokens& t = p.tokens;
    Tokens out;
    std::vector<std::pair<size_t, size_t>> moved; // from this token on, so many more: the places of annotations
    size_t done = 0;
    const auto insert = [&](size_t before, Tokens own) {
        out.insert(out.end(), t.begin() + long(done), t.begin() + long(before));
        done = before;
        out.insert(out.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
        moved.push_back({before, out.size() - done});
    };
    for (size_t i = 0; i + 2 < t.size(); ++i) {
        if (!t[i].is("class") || t[i + 1].kind != Tok::Identifier || !t[i + 2].is("(")) continue;
        const size_t body = behind(t, i + 2);
        if (body >= t.size() || !t[body].is("{")) continue;
        const size_t end = behind(t, body);
        if (end == t.size()) continue; // brackets that do not close, which the parser reports
        const Found f = methodsOf(t, body, end);
        if (!f.light && !f.generates && !f.emits.empty()) {
            insert(i + 3, tokensOf(sources, kEmits));
            insert(body + 1, tokensOf(sources, kEmission));
            for (const size_t call : f.emits) {
                insert(call, emission(t, call));
                Token closing = t[call];
                closing.kind = Tok::Punct;
                closing.text = "}";
                insert(behind(t, call + 1) + 1, {closing});
            }
            insert(end - 1, tokensOf(sources, kEmittingLight));
            i = end - 1;
            continue;
        }
        const std::string photons = f.photons ? kPhotonOutputs : "", photon = f.photons ? kPhoton : "";
        if (!f.generates || (f.light ? !setsZero(t, f.light + 1) : f.surface || !f.domain)) {
            if (!f.light || !f.photons || !t[behind(t, f.light + 1)].is("{")) continue;
            insert(i + 3, tokensOf(sources, photons));
            insert(behind(t, f.light + 1) + 1, tokensOf(sources, photon));
            i = end - 1;
            continue;
        }
        if (f.light) t[f.light].text = kReplacedLight;
        insert(i + 3,
               tokensOf(sources, kSentOutputs + photons + (f.shadows && !f.casts ? kShadows : "") + (f.light ? kOnly : "")));
        insert(end - 1, tokensOf(sources, replaced(replaced(kLight, "PHOTON", photon), "SHADOWED",
                                                   f.casts ? "shadowSamples(sent);" : "")));
        i = end - 1;
    }
    if (done == 0) return;
    out.insert(out.end(), t.begin() + long(done), t.end());
    for (Annotation& a : p.annotations) {
        size_t by = 0;
        for (const auto& [from, shift] : moved)
            if (a.token >= from) by = shift;
        a.token += by;
    }
    p.tokens = std::move(out);
}

} // namespace alpenglow::rsl::front
