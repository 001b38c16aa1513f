// "token" value pairs to typed parameters: declarations, type and count checks, ColorSamples.
#include "ri/interpreter.h"
#include <cmath>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

/// Type by value: numbers are floats, strings are strings (docs/design/ri.md, "Reading").
void guess(scene::Param& p, const Value& v) {
    p.declared = false;
    bool text = v.kind == Value::Kind::Strings;
    p.type = text ? scene::Type::String : scene::Type::Float;
    size_t n = text ? v.strings.size() : v.numbers.size();
    p.arrayLength = n == 1 ? 0 : int(std::min<size_t>(n, 1u << 30));
}

} // namespace

std::vector<float> Interpreter::toRgb(const std::vector<double>& c) const {
    std::vector<float> out;
    if (nRGB.empty()) {
        for (double d : c) out.push_back(toFloat(d));
        return out;
    }
    size_t n = nRGB.size() / 3;
    for (size_t i = 0; i + n <= c.size(); i += n)
        for (size_t k = 0; k < 3; ++k) {
            double s = 0;
            for (size_t j = 0; j < n; ++j) s += c[i + j] * nRGB[j * 3 + k];
            out.push_back(toFloat(s));
        }
    return out;
}

void Interpreter::sayOtherType(const OtherType& o, const SourcePlace& place) {
    reporter.once("ri:type:" + std::string(o.written), Severity::Warning, Rie::BadToken, place,
                  fmt::format("there is no type \"{}\"; it is read as {}", o.written, o.meant), std::string(o.hint));
}

scene::Param Interpreter::bindOne(const Call& call, const RawParam& raw, Use use, const std::string& category, bool* keep) {
    scene::Param p;
    p.place = call.at(raw);
    const Value& v = raw.value;
    std::string_view request = call.request->name;
    *keep = false;
    const Resolved& r = declarations.resolve(raw.token, category);
    p.name = r.name;
    if (r.malformed) {
        reporter.error(Rie::Syntax, p.place, fmt::format("{}: \"{}\" is not a declaration", request, raw.token.substr(0, 80)),
                       declarationHint(raw.token.substr(0, 80), true, "class type[n] name, for example \"varying color Cs\""));
        return p;
    }
    if (r.otherType) sayOtherType(*r.otherType, p.place);
    bool effect = true; // a bad value of what does nothing is no failure
    if (use == Use::Option || use == Use::Attribute) effect = sayUnknown(use == Use::Option, category, p);
    if (use == Use::Hider || use == Use::Display) effect = sayUnknownParameter(use == Use::Hider, p);
    const auto refuse = [&](Rie code, std::string message) {
        reporter.report(effect ? Severity::Error : Severity::Warning, code, p.place, std::move(message));
        return p;
    };
    bool text = v.kind == Value::Kind::Strings;
    bool guessed = !r.declaration;
    if (r.declaration) {
        p.cls = r.declaration->cls;
        p.type = r.declaration->type;
        p.arrayLength = r.declaration->arrayLength;
        bool wantsText = p.type == scene::Type::String;
        if (wantsText != text && v.kind != Value::Kind::Empty) {
            // A shader may well declare a standard name otherwise ("background" as a file name): its own declaration decides.
            guessed = use == Use::Shader && !r.inlineForm;
            if (!guessed)
                return refuse(Rie::Consistency,
                              fmt::format("{}: \"{}\" is {}, not {}", request, p.name, wantsText ? "a string" : toString(p.type),
                                          text ? "a string" : "numbers"));
        }
    } else if (use == Use::Primitive) {
        reporter.once(fmt::format("ri:undeclared:{}", p.name), Severity::Warning, Rie::BadToken, p.place,
                      fmt::format("primitive variable \"{}\" is not declared: its type is guessed from the values", p.name));
    }
    if (guessed) guess(p, v);
    if (text) {
        p.strings = v.strings;
    } else {
        if (p.type == scene::Type::Color && !nRGB.empty()) {
            p.numbers = toRgb(v.numbers);
        } else {
            p.numbers = toFloats(v.numbers);
        }
        // x - x is 0 for finite x and NaN otherwise, in every order of summing.
        float sum = 0;
        for (float f : p.numbers) sum += f - f;
        if (sum != 0 || std::isnan(sum))
            return refuse(Rie::Range, fmt::format("{}: \"{}\" has a value that is not finite", request, p.name));
        if (p.type == scene::Type::Integer && use != Use::Shader)
            for (float f : p.numbers)
                if (f != std::floor(f))
                    return refuse(Rie::Syntax, fmt::format("{}: \"{}\" is an integer, not {}", request, p.name, f));
    }
    *keep = true;
    if (guessed || use == Use::Primitive) return p; // fitVariables counts those
    size_t have = text ? p.strings.size() : p.numbers.size();
    size_t per = size_t(scene::componentCount(p.type)), want = per * size_t(std::max(p.arrayLength, 1));
    if (have == want) return p;
    if (have > want && p.arrayLength == 0 && !r.inlineForm && have % per == 0) {
        // More than was declared: an array parameter of a shader, or of a renderer that knows more about this name.
        p.declared = false;
        p.arrayLength = int(have / per);
        return p;
    }
    *keep = false;
    return refuse(Rie::Consistency, fmt::format("{}: \"{}\" needs {} {}, not {}", request, p.name, want,
                                                std::string(text ? "string" : "number") + (want == 1 ? "" : "s"), have));
}

scene::ParamList Interpreter::bind(const Call& call, Use use, const std::string& category) {
    scene::ParamList list;
    list.reserve(call.params.size());
    for (const RawParam& raw : call.params) {
        bool keep = false;
        scene::Param p = bindOne(call, raw, use, category, &keep);
        if (keep) list.push_back(std::move(p));
    }
    return list;
}

scene::ShaderRef Interpreter::shader(const Call& call) {
    auto s = std::make_shared<scene::ShaderCall>();
    s->name = call.text(0);
    s->params = bind(call, Use::Shader);
    s->toWorld = state.ctm;
    s->place = call.place;
    return s;
}

} // namespace alpenglow::ri
