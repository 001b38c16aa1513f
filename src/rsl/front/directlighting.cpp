// directlighting(this, lights, ...) and indirectspecular(this, ...) of PRMan's class surfaces. The first asks the lights, and the
// method evaluateSamples() of the class what the material makes of each; the second sends rays where the method generateSamples()
// wants them. Before anything is parsed they become methods of the class.
#include "base/limits.h"
#include "rsl/front/prelude.h"
#include "rsl/front/sentlights.h"
#include <array>
#include <iterator>
#include <string>

namespace alpenglow::rsl::front {

namespace {

// A light at a point or far away sends Cl as for diffuse(): a white surface that it stands straight over gives Cl. Materials
// answer per steradian, so a factor of pi stands between the two. LIST: the parameter of the form that has a list of lights.
constexpr const char* kDirectOutputs = "    varying color __direct_d = 0, __direct_s = 0, __direct_ud = 0, __direct_us = 0;\n";
constexpr const char* kDirect = R"(
    color NAME(uniform float part; uniform float angle;LIST output color d; output color s; output color ud; output color us) {
        extern point P;
        extern normal N;
        d = 0;
        s = 0;
        illuminance("LOOP", P, shadingnormal(N), angle) {
            float asked = 1;
            LISTED
            if (asked != 0) {
                __radiancesample one[1];
                one[0]->direction = normalize(L);
                one[0]->distance = length(L);
                one[0]->radiance = Cl;
                one[0]->lightPdf = 1;
                evaluateSamples("diffuse", one);
                d += PI * Cl * one[0]->materialResponse;
                one[0]->materialResponse = 0;
                one[0]->materialPdf = 0;
                one[0]->summedResponse = 0;
                one[0]->summedPdf = 0;
                evaluateSamples("specular", one);
                s += PI * Cl * one[0]->materialResponse;
            }
        }
        ud = d;
        us = s;
        return (part == 1) ? d : (part == 2) ? s : d + s;
    }
)";
// A list that is full need not be of all lights.
constexpr const char* kListed = R"(
            uniform float k, count = arraylength(lights);
            if (count < MOST) asked = 0;
            for (k = 0; k < count && asked == 0; k += 1) if (lights[k] == light) asked = 1;
)";

constexpr const char* kIndirect = R"(
    color __indirect(float bias; float maxdist; uniform string label; uniform string subset; uniform string hitmode;
                     uniform string hitsides; point position) {
        extern point P;
        point from = position[0] < 1e38 ? position : P;
        __radiancesample samples[];
        generateSamples("specular", samples);
        uniform float i, n = arraylength(samples);
        color sum = 0;
        for (i = 0; i < n; i += 1)
            if (samples[i]->materialPdf > 0)
                sum += trace(from, samples[i]->direction, "bias", bias, "maxdist", maxdist, "label", label, "subset", subset,
                             "hitmode", hitmode, "hitsides", hitsides)
                    * samples[i]->materialResponse / (n * samples[i]->materialPdf);
        return sum;
    }
)";

std::string replaced(std::string text, std::string_view word, const std::string& by) {
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += by.size()) text.replace(at, word.size(), by);
    return text;
}

/// What a class without such a method answers: a material that nothing is known of gives back no light.
constexpr const char* kNoAnswer = "    void evaluateSamples(string which; output __radiancesample samples[]) {}\n";
constexpr const char* kNoSamples = "    void generateSamples(string which; output __radiancesample samples[]) {}\n";

/// The methods that calls of the class become. `directs`, `indirect`: which it calls; `evaluates`, `generates`: it has what they
/// ask.
std::string methods(bool directs, bool indirect, bool evaluates, bool generates) {
    std::string all = std::string(directs && !evaluates ? kNoAnswer : "") + (indirect && !generates ? kNoSamples : "");
    if (directs) {
        const std::string direct = replaced(kDirect, "LOOP", kSampleLoop);
        const std::string listed = replaced(kListed, "MOST", std::to_string(limits::kLightHandles));
        all += kDirectOutputs;
        all += replaced(replaced(replaced(direct, "NAME", "__direct"), "LISTED", ""), "LIST", "");
        all += replaced(replaced(replaced(direct, "NAME", "__directof"), "LISTED", listed), "LIST", " shader lights[];");
    }
    return indirect ? all + kIndirect : all;
}

struct Range {
    size_t begin, end;
};

std::vector<Range> arguments(const Tokens& t, size_t open, size_t end) {
    std::vector<Range> all = {{open + 1, open + 1}};
    int depth = 0;
    for (size_t i = open + 1; i + 1 < end; ++i) {
        if (t[i].is("(") || t[i].is("{") || t[i].is("[")) ++depth;
        if (t[i].is(")") || t[i].is("}") || t[i].is("]")) --depth;
        if (depth == 0 && t[i].is(",")) all.push_back({i + 1, i + 1});
        else all.back().end = i + 1;
    }
    return all;
}

Token like(const Token& at, Tok kind, std::string_view text) {
    Token t = at;
    t.kind = kind;
    t.text = text;
    return t;
}

using Arguments = std::vector<Range>;

/// The value of the token `name`; empty: it is not given.
Range valueOf(const Tokens& t, const Arguments& given, std::string_view name) {
    for (size_t i = 1; i + 1 < given.size(); ++i)
        if (given[i].end == given[i].begin + 1 && t[given[i].begin].text == name) return given[i + 1];
    return {0, 0};
}

void append(Tokens& out, const Tokens& t, Range r) { out.insert(out.end(), t.begin() + long(r.begin), t.begin() + long(r.end)); }

/// The call that stands for directlighting(this, ...) at `call`, whose brackets end before `end`. `part`: "0" all, "1" the
/// diffuse part, "2" the specular one.
Tokens replacement(const Tokens& t, size_t call, size_t end, const char* part) {
    constexpr std::array<std::string_view, 4> kTokens = {"\"diffuseresult\"", "\"specularresult\"", "\"unshadoweddiffuseresult\"",
                                                         "\"unshadowedspecularresult\""};
    constexpr std::array<std::string_view, 4> kNobody = {"__direct_d", "__direct_s", "__direct_ud", "__direct_us"};
    const Arguments given = arguments(t, call + 1, end);
    const Token& at = t[call];
    const bool lists = given.size() > 1 && given[1].begin < given[1].end && t[given[1].begin].kind != Tok::String;
    Tokens out = {like(at, Tok::Identifier, lists ? "__directof" : "__direct"), like(at, Tok::Punct, "(")};
    out.push_back(like(at, Tok::Number, part));
    out.push_back(like(at, Tok::Punct, ","));
    const Range domain = valueOf(t, given, "\"integrationdomain\"");
    const bool sphere = domain.begin < domain.end && t[domain.begin].text.rfind("\"spher", 0) == 0;
    out.push_back(like(at, Tok::Identifier, "PI"));
    if (!sphere) {
        out.push_back(like(at, Tok::Punct, "/"));
        out.push_back(like(at, Tok::Number, "2"));
    }
    if (lists) {
        out.push_back(like(at, Tok::Punct, ","));
        append(out, t, given[1]);
    }
    for (size_t k = 0; k < kTokens.size(); ++k) {
        out.push_back(like(at, Tok::Punct, ","));
        const Range found = valueOf(t, given, kTokens[k]);
        if (found.begin == found.end) out.push_back(like(at, Tok::Identifier, kNobody[k]));
        else append(out, t, found);
    }
    out.push_back(like(at, Tok::Punct, ")"));
    return out;
}

/// The call that stands for indirectspecular(this, ...).
Tokens indirectReplacement(const Tokens& t, size_t call, size_t end) {
    struct Optional {
        std::string_view name;
        Tok kind;
        std::string_view otherwise;
    };
    constexpr std::array<Optional, 7> kOptional = {{{"\"bias\"", Tok::Number, "-1"},
                                                    {"\"maxdist\"", Tok::Number, "1e38"},
                                                    {"\"label\"", Tok::String, "\"\""},
                                                    {"\"subset\"", Tok::String, "\"\""},
                                                    {"\"hitmode\"", Tok::String, "\"\""},
                                                    {"\"hitsides\"", Tok::String, "\"\""},
                                                    {"\"position\"", Tok::Number, "1e38"}}};
    const Arguments given = arguments(t, call + 1, end);
    Tokens out = {like(t[call], Tok::Identifier, "__indirect"), t[call + 1]};
    for (const Optional& o : kOptional) {
        if (out.size() > 2) out.push_back(like(t[call], Tok::Punct, ","));
        if (const Range found = valueOf(t, given, o.name); found.begin < found.end) append(out, t, found);
        else {
            if (o.otherwise[0] == '-') out.push_back(like(t[call], Tok::Punct, "-"));
            out.push_back(like(t[call], o.kind, o.otherwise.substr(o.otherwise[0] == '-')));
        }
    }
    out.push_back(like(t[call], Tok::Punct, ")"));
    return out;
}

/// Which part of the light a name asks for; null: it asks for none.
const char* partOf(std::string_view name, std::string_view method) {
    if (name == "diffuselighting") return "1";
    if (name == "specularlighting") return "2";
    if (name != "directlighting") return nullptr;
    return method == "diffuselighting" ? "1" : method == "specularlighting" ? "2" : "0";
}

} // namespace

void addDirectLighting(SourceSet& sources, Preprocessed& p) {
    bool called = false;
    for (const Token& t : p.tokens) called |= partOf(t.text, "") || t.is("indirectspecular");
    if (!called) return;
    const Tokens& t = p.tokens;
    Tokens out;
    std::vector<std::pair<size_t, long>> moved; // from this token on, so many more: the places of annotations
    const auto copy = [&](size_t begin, size_t end) { out.insert(out.end(), t.begin() + long(begin), t.begin() + long(end)); };
    size_t done = 0;
    for (size_t i = 0; i + 2 < t.size(); ++i) {
        if (!t[i].is("class") || t[i + 1].kind != Tok::Identifier || !t[i + 2].is("(")) continue;
        const size_t body = behind(t, i + 2);
        if (body >= t.size() || !t[body].is("{")) continue;
        const size_t end = behind(t, body);
        if (end == t.size()) continue; // brackets that do not close, which the parser reports
        bool evaluates = false, generates = false, direct = false, indirect = false;
        const auto ofThis = [&](size_t k) { return t[k].kind == Tok::Identifier && t[k + 1].is("(") && t[k + 2].is("this"); };
        for (size_t k = body; k + 2 < end; ++k) {
            evaluates |= t[k].is("void") && t[k + 1].is("evaluateSamples");
            generates |= t[k].is("void") && t[k + 1].is("generateSamples");
            direct |= ofThis(k) && partOf(t[k].text, "");
            indirect |= ofThis(k) && t[k].is("indirectspecular");
        }
        if (!direct && !indirect) continue;
        copy(done, body + 1);
        Preprocessed own =
            preprocess(sources, sources.add("<directlighting>", methods(direct, indirect, evaluates, generates)), {});
        own.tokens.pop_back(); // the end
        out.insert(out.end(), std::make_move_iterator(own.tokens.begin()), std::make_move_iterator(own.tokens.end()));
        done = body + 1;
        std::string_view method;
        int depth = 0;
        for (size_t k = body + 1; k + 2 < end; ++k) {
            if (depth == 0 && t[k].kind == Tok::Identifier && t[k + 1].is("(")) method = t[k].text;
            if (t[k].is("{")) ++depth;
            if (t[k].is("}")) --depth;
            const char* const part = direct && ofThis(k) ? partOf(t[k].text, method) : nullptr;
            if (!part && !(indirect && ofThis(k) && t[k].is("indirectspecular"))) continue;
            const size_t last = behind(t, k + 1);
            if (last >= end) continue;
            moved.push_back({done, long(out.size()) - long(done)});
            copy(done, k);
            const Tokens call = part ? replacement(t, k, last, part) : indirectReplacement(t, k, last);
            out.insert(out.end(), call.begin(), call.end());
            done = last;
            k = last - 1;
        }
        moved.push_back({done, long(out.size()) - long(done)});
        i = end - 1;
    }
    if (done == 0) return;
    copy(done, t.size());
    for (Annotation& a : p.annotations) {
        long by = 0;
        for (const auto& [from, shift] : moved)
            if (a.token >= from) by = shift;
        a.token = size_t(long(a.token) + by);
    }
    p.tokens = std::move(out);
}

} // namespace alpenglow::rsl::front
