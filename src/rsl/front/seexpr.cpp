#include "rsl/front/seexpr.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace alpenglow::rsl::front {
namespace {

constexpr int kSeExprDepth = 200;       // of brackets, conditions and signs
constexpr size_t kSeExprText = 1 << 20; // bytes of the translation

/// A part of an expression in RSL; `vec`: three numbers, a color there.
struct SeExprPart {
    std::string text;
    bool vec = false;
};

/// How a function is called. Result: 'f' a number, 'v' three, 'a' as its widest argument. Arguments: so each, 'p' a place.
struct SeExprFunction {
    std::string_view name, rsl;
    char result;
    std::string_view arguments;
    std::string_view defaults; ///< of those that may be missing at the end, separated by commas
};
constexpr SeExprFunction kSeExprFunctions[] = {
    {"noise", "se_noise", 'f', "p", ""},
    {"cnoise", "se_cnoise", 'v', "p", ""},
    {"snoise", "se_snoise", 'f', "p", ""},
    {"vnoise", "se_vnoise", 'v', "p", ""},
    {"cellnoise", "se_cellnoise", 'f', "p", ""},
    {"ccellnoise", "se_ccellnoise", 'v', "p", ""},
    {"turbulence", "se_turbulence", 'f', "pfff", "6,2,.5"},
    {"fbm", "se_fbm", 'f', "pfff", "6,2,.5"},
    {"vfbm", "se_vfbm", 'v', "pfff", "6,2,.5"},
    {"cfbm", "se_cfbm", 'v', "pfff", "6,2,.5"},
    {"voronoi", "se_voronoi", 'f', "pffffff", "1,.5,0,4,2,.5"},
    {"cvoronoi", "se_cvoronoi", 'v', "pffffff", "1,.5,0,4,2,.5"},
    {"pvoronoi", "se_pvoronoi", 'v', "pfffff", ".5,0,4,2,.5"},
    {"length", "se_length", 'f', "p", ""},
    {"dot", "se_dot", 'f', "pp", ""},
    {"dist", "se_dist", 'f', "pp", ""},
    {"norm", "se_norm", 'v', "p", ""},
    {"cross", "se_cross", 'v', "pp", ""},
    {"linearstep", "se_linear", 'f', "fff", ""},
    {"fit", "se_fit", 'f', "fffff", ""},
    {"hash", "se_hash", 'f', "fff", "0,0"},
    {"rand", "se_hash", 'f', "fff", "0,0"},
    {"bias", "se_bias", 'f', "ff", ""},
    {"gamma", "se_gamma", 'f', "ff", ""},
    {"contrast", "se_contrast", 'f', "ff", ""},
    {"invert", "se_invert", 'f', "f", ""},
    {"compress", "se_compress", 'f', "fff", ""},
    {"expand", "se_expand", 'f', "fff", ""},
    {"gaussstep", "se_gaussstep", 'f', "fff", ""},
    {"remap", "se_remap", 'f', "fffff", ""},
    {"fmod", "se_fmod", 'f', "ff", ""},
    {"hypot", "se_hypot", 'f', "ff", ""},
    {"angle", "se_angle", 'f', "pp", ""},
    {"ortho", "se_ortho", 'v', "pp", ""},
    {"saturate", "se_saturate", 'v', "pf", ""},
    {"rgbtohsl", "se_rgbtohsl", 'v', "p", ""},
    {"hsltorgb", "se_hsltorgb", 'v', "p", ""},
    {"hsi", "se_hsi", 'v', "pfff", ""},
    {"mix", "mix", 'a', "aaa", ""},
    {"clamp", "clamp", 'a', "aaa", ""},
    {"min", "min", 'a', "aa", ""},
    {"max", "max", 'a', "aa", ""},
    {"pow", "pow", 'f', "ff", ""},
    {"atan2", "atan", 'f', "ff", ""},
};
/// Functions of a number, which three numbers take one by one.
constexpr std::pair<std::string_view, std::string_view> kSeExprOfOne[] = {
    {"abs", "abs"},      {"floor", "floor"},    {"ceil", "ceil"},      {"sqrt", "sqrt"},      {"sin", "sin"},
    {"cos", "cos"},      {"tan", "tan"},        {"asin", "asin"},      {"acos", "acos"},      {"atan", "atan"},
    {"exp", "exp"},      {"log", "log"},        {"sign", "sign"},      {"round", "round"},    {"trunc", "se_trunc"},
    {"cbrt", "se_cbrt"}, {"log10", "se_log10"}, {"deg", "degrees"},    {"rad", "radians"},    {"sind", "se_sind"},
    {"cosd", "se_cosd"}, {"tand", "se_tand"},   {"asind", "se_asind"}, {"acosd", "se_acosd"}, {"atand", "se_atand"}};

class SeExprTranslator {
public:
    SeExprTranslator(const std::string& text, const std::vector<SeExprVariable>& given, SourcePlace place, Diagnostics& d)
        : text_(text), given_(given), place_(std::move(place)), diagnostics_(d) {}

    std::optional<std::string> run() {
        std::string body;
        SeExprPart result;
        for (int pass = 0; pass < 8; ++pass) { // until what each variable is does not change any more
            const auto before = variables_;
            at_ = 0;
            body = statements(0);
            result = condition(0);
            take(";");
            blank();
            if (!failed_ && at_ < text_.size()) fail("\"" + text_.substr(at_, 20) + "\" is not expected");
            if (failed_) return {};
            if (before == variables_) break;
        }
        std::string out = "#include \"seexpr.h\"\nsurface seexpr(";
        for (const SeExprVariable& v : given_)
            out += std::string("varying ") + (v.color ? "color " : "float ") + own(v.name) + " = 0; ";
        out += "output varying color resultRGB = 0; output varying float resultF = 0, resultR = 0, resultG = 0, resultB = 0) "
               "{\n";
        for (const auto& [name, vec] : variables_) out += std::string(vec ? "color " : "float ") + own(name) + " = 0;\n";
        return out + body + "resultRGB = " + color(result) + ";\nresultF = " + number(result) +
               ";\nresultR = comp(resultRGB, 0);\nresultG = comp(resultRGB, 1);\nresultB = comp(resultRGB, 2);\n}\n";
    }

private:
    /// As the scene may name it, too (docs/ris.md).
    static std::string own(const std::string& name) { return name + "_"; }
    static std::string color(const SeExprPart& p) { return p.vec ? p.text : "color(" + p.text + ")"; }
    static std::string number(const SeExprPart& p) { return p.vec ? "comp(" + p.text + ", 0)" : p.text; }
    static SeExprPart bracketed(std::string text, bool vec) { return {"(" + std::move(text) + ")", vec}; }

    void fail(const std::string& what) {
        if (!failed_) diagnostics_.report(diagnostic(msg::kSeExprNotRead(what, at_ + 1), Rie::Syntax, place_));
        failed_ = true;
    }
    void blank() {
        while (at_ < text_.size()) {
            if (std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
            else if (text_[at_] == '#')
                while (at_ < text_.size() && text_[at_] != '\n') ++at_;
            else break;
        }
    }
    bool peek(std::string_view s) {
        blank();
        return std::string_view(text_).substr(at_).starts_with(s);
    }
    bool take(std::string_view s) {
        if (!peek(s)) return false;
        at_ += s.size();
        return true;
    }
    void want(std::string_view s) {
        if (!take(s)) fail("\"" + std::string(s) + "\" is expected");
    }
    static bool letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
    /// A name, also with "$" before it; "" and nothing is taken where there is none.
    std::string name() {
        blank();
        size_t i = at_ + (at_ < text_.size() && text_[at_] == '$');
        const size_t from = i;
        while (i < text_.size() && letter(text_[i])) ++i;
        if (i == from || std::isdigit(static_cast<unsigned char>(text_[from]))) return {};
        at_ = i;
        return text_.substr(from, i - from);
    }
    bool isWord(std::string_view w) { return peek(w) && (at_ + w.size() >= text_.size() || !letter(text_[at_ + w.size()])); }

    /// Assignments and conditions, up to the expression that is the value, or to "}".
    std::string statements(int depth) {
        std::string out;
        while (!failed_) {
            if (isWord("if")) {
                at_ += 2;
                out += branch(depth + 1);
                continue;
            }
            const size_t start = at_;
            const std::string to = name();
            blank();
            static constexpr std::string_view kAssign[] = {"+=", "-=", "*=", "/=", "="};
            std::string_view op;
            for (std::string_view s : kAssign)
                if (op.empty() && !to.empty() && peek(s) && !peek("==")) op = s;
            if (op.empty()) {
                at_ = start;
                return out;
            }
            at_ += op.size();
            SeExprPart value = condition(depth + 1);
            const bool isGiven = std::any_of(given_.begin(), given_.end(), [&](const auto& v) { return v.name == to; });
            if (isGiven) return fail("\"" + to + "\" is given by the scene, and cannot be set"), out;
            bool& vec = variables_.try_emplace(to, value.vec).first->second;
            vec |= value.vec;
            out += own(to) + " " + std::string(op) + " " + (vec ? color(value) : value.text) + ";\n";
            want(";");
            if (out.size() > kSeExprText) fail("it is too long");
        }
        return out;
    }

    std::string branch(int depth) {
        if (depth > kSeExprDepth) return fail("it is nested too deeply"), "";
        want("(");
        std::string out = "if (" + number(condition(depth)) + " != 0) {\n";
        want(")");
        want("{");
        out += statements(depth) + "}";
        want("}");
        if (!failed_ && isWord("else")) {
            at_ += 4;
            if (isWord("if")) {
                at_ += 2;
                return out + " else {\n" + branch(depth + 1) + "}\n";
            }
            want("{");
            out += " else {\n" + statements(depth) + "}";
            want("}");
        }
        return out + "\n";
    }

    SeExprPart condition(int depth) {
        if (depth > kSeExprDepth) return fail("it is nested too deeply"), SeExprPart{"0"};
        SeExprPart c = binary(0, depth);
        if (failed_ || !take("?")) return c;
        const SeExprPart yes = condition(depth + 1);
        want(":");
        const SeExprPart no = condition(depth + 1);
        const bool vec = yes.vec || no.vec;
        const auto as = [&](const SeExprPart& p) { return vec ? color(p) : p.text; };
        return bracketed("(" + number(c) + " != 0) ? " + as(yes) + " : " + as(no), vec);
    }

    SeExprPart binary(int level, int depth) {
        static constexpr std::string_view kLevels[][4] = {{"||", "", "", ""},     {"&&", "", "", ""}, {"==", "!=", "", ""},
                                                          {"<=", ">=", "<", ">"}, {"+", "-", "", ""}, {"*", "/", "%", ""}};
        if (level == 6) return power(depth + 1);
        SeExprPart a = binary(level + 1, depth);
        while (!failed_) {
            std::string_view op;
            for (std::string_view s : kLevels[level])
                if (op.empty() && !s.empty() && peek(s)) op = s;
            if (op.empty()) return a;
            at_ += op.size();
            const SeExprPart b = binary(level + 1, depth);
            if (a.text.size() + b.text.size() > kSeExprText) return fail("it is too long"), a;
            if (level < 2)
                a = bracketed("(" + number(a) + " != 0 " + std::string(op) + " " + number(b) + " != 0) ? 1 : 0", false);
            else if (level < 4) {
                const bool vec = level == 2 && (a.vec || b.vec);
                const auto as = [&](const SeExprPart& p) { return vec ? color(p) : number(p); };
                a = bracketed("(" + as(a) + " " + std::string(op) + " " + as(b) + ") ? 1 : 0", false);
            } else if (op == "%") a = {"mod(" + number(a) + ", " + number(b) + ")", false};
            else {
                const bool vec = a.vec || b.vec;
                const auto as = [&](const SeExprPart& p) { return vec ? color(p) : p.text; };
                a = bracketed(as(a) + " " + std::string(op) + " " + as(b), vec);
            }
        }
        return a;
    }

    SeExprPart power(int depth) {
        if (depth > kSeExprDepth) return fail("it is nested too deeply"), SeExprPart{"0"};
        if (take("-")) {
            const SeExprPart p = power(depth + 1);
            return bracketed("-" + p.text, p.vec);
        }
        if (take("+")) return power(depth + 1);
        if (!peek("!=") && take("!")) return bracketed("(" + number(power(depth + 1)) + " != 0) ? 0 : 1", false);
        if (take("~")) {
            const SeExprPart p = power(depth + 1);
            return bracketed((p.vec ? "color(1) - " : "1 - ") + p.text, p.vec);
        }
        SeExprPart a = postfix(depth);
        if (!failed_ && take("^")) {
            const SeExprPart b = power(depth + 1);
            if (a.text.size() + b.text.size() > kSeExprText / 16) return fail("it is too long"), a;
            if (a.vec) return each(a, [&](const std::string& x) { return "pow(" + x + ", " + number(b) + ")"; });
            return {"pow(" + a.text + ", " + number(b) + ")", false};
        }
        return a;
    }

    template <class F> static SeExprPart each(const SeExprPart& p, F f) {
        std::string out = "color(";
        for (int n = 0; n < 3; ++n) out += (n ? ", " : "") + f("comp(" + p.text + ", " + std::to_string(n) + ")");
        return {out + ")", true};
    }

    SeExprPart postfix(int depth) {
        SeExprPart a = primary(depth);
        while (!failed_ && take("[")) {
            const SeExprPart i = condition(depth + 1);
            want("]");
            a = a.vec ? SeExprPart{"se_at(" + a.text + ", " + number(i) + ")", false} : a;
        }
        return a;
    }

    SeExprPart primary(int depth) {
        blank();
        if (at_ >= text_.size()) return fail("it ends too early"), SeExprPart{"0"};
        const char c = text_[at_];
        if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return literal();
        if (take("(")) {
            const SeExprPart p = condition(depth + 1);
            want(")");
            return bracketed(p.text, p.vec);
        }
        if (take("[")) {
            std::vector<SeExprPart> all = list("]", depth);
            if (all.size() > 3) return fail("vectors have three numbers"), SeExprPart{"0"};
            while (all.size() < 3) all.push_back({"0"});
            return {"color(" + number(all[0]) + ", " + number(all[1]) + ", " + number(all[2]) + ")", true};
        }
        const std::string n = name();
        if (n.empty()) return fail("\"" + text_.substr(at_, 10) + "\" is not expected"), SeExprPart{"0"};
        if (take("(")) return call(n, list(")", depth));
        return variable(n);
    }

    SeExprPart literal() {
        const size_t from = at_;
        while (at_ < text_.size() &&
               (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.' || text_[at_] == 'e' ||
                text_[at_] == 'E' ||
                ((text_[at_] == '-' || text_[at_] == '+') && at_ > from && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E'))))
            ++at_;
        return {text_.substr(from, at_ - from), false};
    }

    std::vector<SeExprPart> list(std::string_view end, int depth) {
        std::vector<SeExprPart> all;
        if (take(end)) return all;
        do all.push_back(condition(depth + 1));
        while (!failed_ && all.size() < 64 && take(","));
        want(end);
        return all;
    }

    SeExprPart variable(const std::string& n) {
        for (const SeExprVariable& v : given_)
            if (v.name == n) return {own(n), v.color};
        if (const auto v = variables_.find(n); v != variables_.end()) return {own(n), v->second};
        static const std::map<std::string, SeExprPart> kKnown{{"PI", {"PI"}},     {"E", {"2.718281828"}}, {"u", {"u"}},
                                                              {"v", {"v"}},       {"s", {"s"}},           {"t", {"t"}},
                                                              {"time", {"time"}}, {"Cs", {"Cs", true}},   {"Os", {"Os", true}}};
        if (const auto k = kKnown.find(n); k != kKnown.end()) return k->second;
        static const std::map<std::string, const char*> kPlaces{
            {"P", "P"}, {"Po", "P"},      {"N", "normalize(N)"}, {"Nn", "normalize(N)"},
            {"I", "I"}, {"dPdu", "dPdu"}, {"dPdv", "dPdv"}};
        const auto p = kPlaces.find(n);
        if (p == kPlaces.end()) return fail("there is no variable \"" + n + "\""), SeExprPart{"0"};
        const std::string v = p->second;
        return {"color(xcomp(" + v + "), ycomp(" + v + "), zcomp(" + v + "))", true};
    }

    SeExprPart call(const std::string& n, std::vector<SeExprPart> a) {
        if (failed_) return {"0"};
        for (const SeExprPart& p : a)
            if (p.text.size() > kSeExprText / 16) return fail("it is too long"), SeExprPart{"0"}; // some are written three times
        const auto one = std::find_if(std::begin(kSeExprOfOne), std::end(kSeExprOfOne), [&](auto& f) { return f.first == n; });
        if (one != std::end(kSeExprOfOne) && a.size() == 1) {
            const std::string f(one->second);
            if (a[0].vec) return each(a[0], [&](const std::string& x) { return f + "(" + x + ")"; });
            return {f + "(" + a[0].text + ")", false};
        }
        if (n == "smoothstep" && a.size() == 3) // SeExpr has the value first
            return {"smoothstep(" + number(a[1]) + ", " + number(a[2]) + ", " + number(a[0]) + ")", false};
        if (n == "boxstep" && a.size() == 2) return {"step(" + number(a[1]) + ", " + number(a[0]) + ")", false};
        for (const SeExprFunction& f : kSeExprFunctions) {
            if (f.name != n) continue;
            std::string_view rest = f.defaults;
            const size_t optional = rest.empty() ? 0 : size_t(std::count(rest.begin(), rest.end(), ',')) + 1;
            if (f.arguments[0] == 'p' && f.arguments.size() == 1 && a.size() > 1) { // places may be numbers
                SeExprPart place{"color(" + number(a[0]) + ", " + number(a[1]) + ", " + (a.size() > 2 ? number(a[2]) : "0") + ")",
                                 true};
                a = {place};
            }
            if (a.size() > f.arguments.size() || a.size() + optional < f.arguments.size())
                return fail("\"" + n + "\" has another number of arguments"), SeExprPart{"0"};
            const bool vec = f.result == 'v' ||
                             (f.result == 'a' && std::any_of(a.begin(), a.end(), [](const SeExprPart& p) { return p.vec; }));
            std::string out = std::string(f.rsl) + "(";
            for (size_t i = 0; i < f.arguments.size(); ++i) {
                const char kind = f.arguments[i];
                if (i) out += ", ";
                if (i < a.size()) {
                    out += kind == 'p' || (kind == 'a' && vec) ? color(a[i]) : number(a[i]);
                    continue;
                }
                std::string_view values = rest; // the defaults are those of the last arguments
                for (size_t skip = i + optional - f.arguments.size(); skip > 0; --skip)
                    values = values.substr(values.find(',') + 1);
                out += values.substr(0, values.find(','));
            }
            return {out + ")", vec};
        }
        return fail("there is no function \"" + n + "\" of so many arguments"), SeExprPart{"0"};
    }

    const std::string& text_;
    const std::vector<SeExprVariable>& given_;
    SourcePlace place_;
    Diagnostics& diagnostics_;
    size_t at_ = 0;
    std::map<std::string, bool> variables_; ///< set by the expression: whether they are three numbers
    bool failed_ = false;
};

} // namespace

std::optional<std::string> rslFromSeExpr(const std::string& expression, const std::vector<SeExprVariable>& variables,
                                         const SourcePlace& place, Diagnostics& d) {
    return SeExprTranslator(expression, variables, place, d).run();
}

} // namespace alpenglow::rsl::front
