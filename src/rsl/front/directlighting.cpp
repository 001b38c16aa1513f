// directlighting(this, lights, ...) and indirectspecular(this, ...) of PRMan's class surfaces. The first asks the lights, and the method
// evaluateSamples() of the class what the material makes of each; the second sends rays where the method generateSamples() wants them.
// Before anything is parsed they become methods of the class.
#include "rsl/front/prelude.h"
#include <array>
#include <iterator>
#include <string>

namespace alpenglow::rsl::front {

namespace {

// A light at a point or far away sends Cl as for diffuse(): a white surface that it stands straight over gives Cl. Materials answer per
// steradian, so a factor of pi stands between the two.
constexpr const char* kDirect = R"(
    varying color __direct_d = 0, __direct_s = 0, __direct_ud = 0, __direct_us = 0;
    color __direct(uniform float part; uniform float angle; output color d; output color s; output color ud; output color us) {
        extern point P;
        extern normal N;
        d = 0;
        s = 0;
        illuminance(P, shadingnormal(N), angle) {
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
        ud = d;
        us = s;
        return (part == 1) ? d : (part == 2) ? s : d + s;
    }
)";

constexpr const char* kIndirect = R"(
    color __indirect() {
        extern point P;
        __radiancesample samples[];
        generateSamples("specular", samples);
        uniform float i, n = arraylength(samples);
        color sum = 0;
        for (i = 0; i < n; i += 1)
            if (samples[i]->materialPdf > 0)
                sum += trace(P, samples[i]->direction) * samples[i]->materialResponse / (n * samples[i]->materialPdf);
        return sum;
    }
)";

struct Range { size_t begin, end; };

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

/// The call that stands for directlighting(...) at `call`, whose brackets end before `end`.
Tokens replacement(const Tokens& t, size_t call, size_t end, std::string_view method) {
    constexpr std::array<std::string_view, 4> kTokens = {"\"diffuseresult\"", "\"specularresult\"", "\"unshadoweddiffuseresult\"",
                                                         "\"unshadowedspecularresult\""};
    constexpr std::array<std::string_view, 4> kNobody = {"__direct_d", "__direct_s", "__direct_ud", "__direct_us"};
    const auto given = arguments(t, call + 1, end);
    const Token& at = t[call];
    Tokens out = {like(at, Tok::Identifier, "__direct"), like(at, Tok::Punct, "(")};
    out.push_back(like(at, Tok::Number, method == "diffuselighting" ? "1" : method == "specularlighting" ? "2" : "0"));
    out.push_back(like(at, Tok::Punct, ","));
    bool sphere = false;
    for (size_t i = 1; i + 1 < given.size(); ++i) // "integrationdomain", "sphere"
        if (t[given[i].begin].text == "\"integrationdomain\"") sphere = t[given[i + 1].begin].text.rfind("\"spher", 0) == 0;
    out.push_back(like(at, Tok::Identifier, "PI"));
    if (!sphere) {
        out.push_back(like(at, Tok::Punct, "/"));
        out.push_back(like(at, Tok::Number, "2"));
    }
    for (size_t k = 0; k < kTokens.size(); ++k) {
        out.push_back(like(at, Tok::Punct, ","));
        Range found{0, 0};
        for (size_t i = 1; i + 1 < given.size(); ++i)
            if (given[i].end == given[i].begin + 1 && t[given[i].begin].text == kTokens[k]) found = given[i + 1];
        if (found.begin == found.end) out.push_back(like(at, Tok::Identifier, kNobody[k]));
        out.insert(out.end(), t.begin() + long(found.begin), t.begin() + long(found.end));
    }
    out.push_back(like(at, Tok::Punct, ")"));
    return out;
}

} // namespace

void addDirectLighting(SourceSet& sources, Preprocessed& p) {
    bool called = false;
    for (const Token& t : p.tokens) called |= t.is("directlighting") || t.is("indirectspecular");
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
        const auto asks = [&](size_t k, std::string_view name) { return t[k].is(name) && t[k + 1].is("(") && t[k + 2].is("this"); };
        for (size_t k = body; k + 2 < end; ++k) {
            evaluates |= t[k].is("void") && t[k + 1].is("evaluateSamples");
            generates |= t[k].is("void") && t[k + 1].is("generateSamples");
            direct |= asks(k, "directlighting");
            indirect |= asks(k, "indirectspecular");
        }
        direct &= evaluates;
        indirect &= generates;
        if (!direct && !indirect) continue;
        copy(done, body + 1);
        const std::string methods = std::string(direct ? kDirect : "") + (indirect ? kIndirect : "");
        Preprocessed own = preprocess(sources, sources.add("<directlighting>", methods), {});
        own.tokens.pop_back(); // the end
        out.insert(out.end(), std::make_move_iterator(own.tokens.begin()), std::make_move_iterator(own.tokens.end()));
        done = body + 1;
        std::string_view method;
        int depth = 0;
        for (size_t k = body + 1; k + 2 < end; ++k) {
            if (depth == 0 && t[k].kind == Tok::Identifier && t[k + 1].is("(")) method = t[k].text;
            if (t[k].is("{")) ++depth;
            if (t[k].is("}")) --depth;
            const bool first = direct && asks(k, "directlighting");
            if (!first && !(indirect && asks(k, "indirectspecular"))) continue;
            const size_t last = behind(t, k + 1);
            if (last >= end) continue;
            moved.push_back({done, long(out.size()) - long(done)});
            copy(done, k);
            const Tokens call = first ? replacement(t, k, last, method)
                                      : Tokens{like(t[k], Tok::Identifier, "__indirect"), t[k + 1], like(t[k], Tok::Punct, ")")};
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
