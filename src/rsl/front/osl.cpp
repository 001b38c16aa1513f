#include "rsl/front/osl.h"
#include "rsl/front/osl_words.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <map>
#include <set>

namespace alpenglow::rsl::front {
namespace {

using OslKind = OslWord::Kind;

constexpr int kOslDepth = 200; // of brackets: each is a call of text()

class OslTranslator {
public:
    OslTranslator(std::vector<OslWord> words, std::string path, Diagnostics& d)
        : w_(std::move(words)), path_(std::move(path)), diagnostics_(d) {}

    std::optional<std::string> run() {
        if (!pairBrackets()) return {};
        findNames();
        std::string out = "#include \"osl.h\"\n#line 1\n";
        for (size_t i = 0; i < w_.size() && !failed_;) i = declaration(i, out);
        if (!failed_ && !shaders_) fail(0, "there is no shader in it");
        if (failed_) return {};
        return out;
    }

private:
    void fail(size_t at, const std::string& what, const std::string& hint = {}) {
        const OslWord* w = at < w_.size() ? &w_[at] : nullptr;
        if (!failed_)
            diagnostics_.report(
                diagnostic(msg::kOslNotRead(what), Rie::Unimplement, {path_, w ? w->line : 0, w ? w->column : 0}, hint));
        failed_ = true;
    }
    bool is(size_t i, std::string_view text) const {
        return i < w_.size() && w_[i].text == text && w_[i].kind != OslKind::String;
    }
    bool isType(size_t i) const { return i < w_.size() && w_[i].kind == OslKind::Name && isOslType(w_[i].text); }
    bool isName(size_t i) const { return i < w_.size() && w_[i].kind == OslKind::Name; }
    static bool opens(const OslWord& w) { return w.kind == OslKind::Sign && (w.text == "(" || w.text == "[" || w.text == "{"); }

    bool pairBrackets() {
        std::vector<size_t> open;
        for (size_t i = 0; i < w_.size(); ++i) {
            if (opens(w_[i])) {
                if (open.size() > size_t(kOslDepth)) return fail(i, "its brackets are nested too deeply"), false;
                open.push_back(i);
            }
            if (w_[i].kind == OslKind::Sign && (w_[i].text == ")" || w_[i].text == "]" || w_[i].text == "}")) {
                if (open.empty()) return fail(i, "a bracket closes that was not opened"), false;
                close_[open.back()] = i;
                open.pop_back();
            }
        }
        if (!open.empty()) fail(open.back(), "a bracket is not closed");
        return open.empty();
    }
    size_t closing(size_t open) const { return close_.at(open); }

    /// Behind the comma or the end at the outermost level, from i on.
    size_t itemEnd(size_t i, size_t end) const {
        for (; i < end && !is(i, ",") && !is(i, ";"); ++i)
            if (opens(w_[i])) i = closing(i);
        return i;
    }

    /// Variables that RSL could not call so, and those that are whole numbers.
    void findNames() {
        for (size_t i = 0; i + 1 < w_.size(); ++i) {
            if (!isType(i) || !isName(i + 1)) continue;
            const bool whole = w_[i].text == "int";
            for (size_t n = i + 1; isName(n);) {
                if (isRslWord(w_[n].text) && !is(n + 1, "(")) renamed_.insert(w_[n].text);
                if (whole) whole_.insert(w_[n].text);
                size_t e = n + 1;
                while (e < w_.size() && !is(e, ",") && !is(e, ";") && !is(e, ")")) e = opens(w_[e]) ? closing(e) + 1 : e + 1;
                if (!is(e, ",") || isType(e + 1) || is(e + 1, "output")) break;
                n = e + 1;
            }
        }
    }

    std::string name(const std::string& n) const { return renamed_.count(n) ? n + "_" : n; }
    static std::string type(const std::string& t) { return t == "int" ? "float" : t; }
    static std::string lines(const OslWord& w) { return std::string(size_t(std::max(w.lines, 0)), '\n'); }

    // --- file level: shaders, functions ---

    size_t declaration(size_t i, std::string& out) {
        if (w_[i].kind == OslKind::Directive) {
            const bool standard = w_[i].text.find("include") != std::string::npos && w_[i].text.find("osl") != std::string::npos;
            out += lines(w_[i]) + (standard ? "" : w_[i].text);
            return i + 1;
        }
        static const std::set<std::string> kKinds{"shader", "surface", "displacement", "volume", "light"};
        if (kKinds.count(w_[i].text) && isName(i + 1) && is(i + 2, "(")) return shader(i, out);
        if (is(i, "struct")) return fail(i, "structures are not translated"), w_.size();
        if (is(i, "public")) return i + 1;
        if ((isType(i) || is(i, "void")) && isName(i + 1) && is(i + 2, "(")) {
            out += lines(w_[i]) + type(w_[i].text) + " " + name(w_[i + 1].text) + "(" + parameters(i + 3, closing(i + 2), false) +
                   ")";
            return body(closing(i + 2) + 1, out);
        }
        fail(i, "\"" + w_[i].text + "\" is not expected here", "shaders and functions are");
        return w_.size();
    }

    size_t shader(size_t i, std::string& out) {
        ++shaders_;
        out += lines(w_[i]) + "surface osl_" + w_[i + 1].text + "(" + parameters(i + 3, closing(i + 2), true) + ")";
        return body(closing(i + 2) + 1, out);
    }

    size_t body(size_t open, std::string& out) {
        if (!is(open, "{")) return fail(open, "\"{\" is expected here"), w_.size();
        const size_t end = closing(open);
        out += " {" + statements(open + 1, end) + lines(w_[end]) + "}";
        return is(end + 1, ";") ? end + 2 : end + 1;
    }

    /// Where another parameter begins in one from its type at i up to e; e: nowhere. No value has a type with a name behind it.
    size_t parameterInside(size_t i, size_t e) const {
        for (size_t k = i + 1; k < e; k = opens(w_[k]) ? closing(k) + 1 : k + 1)
            if (is(k, "output") || (isType(k) && isName(k + 1) && k + 1 < e)) return k;
        return e;
    }

    /// "output color c = 0, float x" as RSL has it; parameters of shaders can be connected.
    std::string parameters(size_t i, size_t end, bool ofShader) {
        std::string out;
        while (i < end && !failed_) {
            const size_t e = itemEnd(i, end);
            const bool output = is(i, "output");
            out += lines(w_[i]);
            i += output;
            if (is(i, "closure")) return fail(i, "closures are not translated: materials are Bxdf here"), out;
            if (const size_t next = parameterInside(i, e); next < e)
                return fail(next, "a comma is missing before this parameter", "parameters are separated by commas"), out;
            if (!isType(i) || !isName(i + 1)) return fail(i, "a parameter of a type that RSL has is expected here"), out;
            const std::string t = type(w_[i].text);
            if (output) out += "output ";
            if (ofShader && t != "string") out += "varying ";
            out += t + " " + name(w_[i + 1].text);
            size_t at = i + 2;
            if (is(at, "[")) out += text(at, closing(at) + 1), at = closing(at) + 1;
            const bool bound = ofShader && std::any_of(&w_[i], &w_[e], [](const OslWord& w) { return w.bound; });
            if (bound && renamed_.count(w_[i + 1].text) && isRslGlobal(w_[i + 1].text, t)) out += " = " + w_[i + 1].text;
            else if (at < e) out += text(at, e);
            else if (ofShader) out += t == "string" ? " = \"\"" : " = 0";
            out += e < end ? "; " : "";
            i = e + 1;
        }
        return out;
    }

    // --- statements ---

    std::string statements(size_t i, size_t end) {
        std::string out;
        while (i < end && !failed_) {
            if (is(i, "{")) {
                out += lines(w_[i]) + "{" + statements(i + 1, closing(i)) + lines(w_[closing(i)]) + "}";
                i = closing(i) + 1;
                continue;
            }
            size_t e = i; // behind the statement, or behind the bracket of if, for and while
            const bool head = is(i, "if") || is(i, "for") || is(i, "while");
            if (head && is(i + 1, "(")) e = closing(i + 1) + 1;
            else if (is(i, "else") || is(i, "do")) e = i + 1;
            else {
                while (e < end && !is(e, ";")) e = opens(w_[e]) ? closing(e) + 1 : e + 1;
                e = std::min(e + 1, end);
            }
            before_.clear();
            std::string s = is(i, "for") && head ? loop(i, e) : text(i, e);
            out += before_ + s;
            before_.clear();
            i = e;
        }
        return out;
    }

    /// for (int i = 0; ...): RSL declares the variable before it.
    std::string loop(size_t i, size_t end) {
        if (!isType(i + 2) || !isName(i + 3)) return text(i, end);
        before_ += " " + type(w_[i + 2].text) + " " + name(w_[i + 3].text) + ";";
        return lines(w_[i]) + "for (" + text(i + 3, end);
    }

    // --- expressions ---

    /// Words [i, end) in RSL.
    std::string text(size_t i, size_t end) {
        std::string out;
        size_t left = std::string::npos; // where the operand before stands in `out`, if it is a whole number
        while (i < end && !failed_) {
            const size_t from = out.size();
            const bool whole = isWhole(i) && !is(i + 1, "(") && !is(i + 1, "[") && !is(i + 1, ".");
            if (is(i, "/") && left != std::string::npos && isWhole(i + 1) && !is(i + 2, "(")) {
                out = out.substr(0, left) + " osl_int(" + out.substr(left) + " / " + name(w_[i + 1].text) + ")";
                i += 2;
                continue;
            }
            out += lines(w_[i]);
            i = one(i, end, out);
            left = whole ? from : std::string::npos;
        }
        return out;
    }
    bool isWhole(size_t i) const {
        if (i >= w_.size()) return false;
        if (w_[i].kind == OslKind::Number) return w_[i].text.find_first_of(".eE") == std::string::npos;
        return isName(i) && whole_.count(w_[i].text);
    }

    size_t one(size_t i, size_t end, std::string& out) {
        const OslWord& w = w_[i];
        if (w.kind == OslKind::Directive) return out += w.text + "\n", i + 1;
        if (is(i, "(") && isType(i + 1) && is(i + 2, ")")) { // a cast
            out += " " + (w_[i + 1].text == "int" ? "osl_int" : w_[i + 1].text) + " ";
            if (w_[i + 1].text != "int") return i + 3;
            size_t e = i + 3 < end && opens(w_[i + 3]) ? closing(i + 3) + 1 : i + 4;
            while (e < end && (is(e, "(") || is(e, "["))) e = closing(e) + 1;
            out += "(" + text(i + 3, std::min(e, end)) + ")";
            return e;
        }
        if (is(i, ".") && isName(i + 1)) {
            static const std::map<std::string, const char*> kParts{{"x", "[0]"}, {"r", "[0]"}, {"y", "[1]"},
                                                                   {"g", "[1]"}, {"z", "[2]"}, {"b", "[2]"}};
            const auto part = kParts.find(w_[i + 1].text);
            if (part == kParts.end()) return fail(i, "structures are not translated"), end;
            return out += part->second, i + 2;
        }
        if (w.kind == OslKind::Sign &&
            (w.text == "<<" || w.text == ">>" || w.text == "&" || w.text == "|" || w.text == "^" || w.text == "~" ||
             w.text.ends_with("&=") || w.text == "|=" || w.text == "^=" || w.text == "<<=" || w.text == ">>="))
            return fail(i, "operators on bits are not translated"), end;
        if (w.kind != OslKind::Name) {
            out += (w.kind == OslKind::Sign ? "" : " ") + w.text;
            return i + 1;
        }
        if (is(i, "and") || is(i, "or") || is(i, "not")) return out += is(i, "and") ? " && " : is(i, "or") ? " || " : "!", i + 1;
        if (is(i, "closure")) return fail(i, "closures are not translated: materials are Bxdf here"), end;
        if (is(i + 1, "(") && i + 1 < end) return call(i, out);
        if (w.text == "N" && !renamed_.count("N") && !is(i + 1, "=")) return out += " normalize(N)", i + 1;
        out += " " + (isType(i) ? type(w.text) : name(w.text));
        return i + 1;
    }

    std::vector<std::string> arguments(size_t open) {
        std::vector<std::string> all;
        const size_t end = closing(open);
        for (size_t i = open + 1; i < end && !failed_;) {
            const size_t e = itemEnd(i, end);
            all.push_back(text(i, e));
            i = e + 1;
        }
        return all;
    }

    static std::string joined(const std::vector<std::string>& all, size_t from) {
        std::string out;
        for (size_t n = from; n < all.size(); ++n) out += (n > from ? ", " : "") + all[n];
        return out;
    }

    size_t call(size_t i, std::string& out) {
        const std::string& f = w_[i].text;
        const size_t open = i + 1, end = closing(open) + 1;
        const bool named = w_[open + 1].kind == OslKind::String;
        const std::vector<std::string> a = arguments(open);
        if (failed_) return end;
        if (isType(i) && named && a.size() > 1) { // color("hsv", ...)
            out += " " + f + " " + a[0] + " (" + joined(a, 1) + ")";
        } else if (f == "int") out += " osl_int(" + joined(a, 0) + ")";
        else if (f == "fmod") out += " osl_fmod(" + joined(a, 0) + ")";
        else if (f == "noise" || f == "pnoise") noise(i, a, named, out);
        else if (f == "texture" && !a.empty()) texture(i, a, out);
        else if (f == "getattribute" && !a.empty()) attribute(i, a, out);
        else if (f == "error" || f == "warning" || f == "fprintf") out += " printf(" + joined(a, f == "fprintf") + ")";
        else if (f == "if" || f == "while" || f == "for" || f == "return") out += " " + f + " " + text(open, end);
        else if (isClosure(f)) fail(i, "\"" + f + "\" is a closure: materials are Bxdf here");
        else out += " " + f + "(" + joined(a, 0) + ")";
        return end;
    }
    static bool isClosure(const std::string& f) {
        static const std::set<std::string> kClosures{"diffuse",    "oren_nayar", "phong",       "ward",        "microfacet",
                                                     "reflection", "refraction", "transparent", "translucent", "emission",
                                                     "background", "holdout",    "subsurface"};
        return kClosures.count(f) > 0;
    }

    /// noise("uperlin", x, y): the kinds that RSL has; "gabor" and "simplex" are Perlin's here.
    void noise(size_t i, const std::vector<std::string>& a, bool named, std::string& out) {
        const std::string kind = named ? w_[i + 2].text : "\"uperlin\"";
        const bool twoSided = kind == "\"perlin\"" || kind == "\"snoise\"" || kind == "\"simplex\"" || kind == "\"gabor\"";
        const char* f = kind == "\"cell\"" || kind == "\"hash\"" ? "cellnoise" : twoSided ? "snoise" : "noise";
        out += std::string(" ") + (w_[i].text == "pnoise" && !twoSided ? "pnoise" : f) + "(" + joined(a, named ? 1 : 0) + ")";
    }

    /// texture(file, s, t, ...): "firstchannel" and "alpha" by channels, "blur" and "width" as they are.
    void texture(size_t i, const std::vector<std::string>& a, std::string& out) {
        std::string channel, alpha, pairs;
        size_t n = 3;
        while (n < a.size() && !a[n].starts_with(" \"")) ++n; // derivatives
        for (; n + 1 < a.size(); n += 2) {
            if (a[n] == " \"firstchannel\"") channel = "[" + a[n + 1] + "]";
            else if (a[n] == " \"alpha\"") alpha = a[n + 1];
            else if (a[n] == " \"blur\"" || a[n] == " \"width\"" || a[n] == " \"sblur\"" || a[n] == " \"tblur\"")
                pairs += "," + a[n] + ", " + a[n + 1];
        }
        if (a.size() < 3) return fail(i, "texture() needs a file and two coordinates");
        const std::string at = ", " + a[1] + ", " + a[2] + pairs + ")";
        if (!alpha.empty()) before_ += alpha + " = float texture(" + a[0] + "[3]" + at + ";";
        out += " texture(" + a[0] + channel + at;
    }

    /// getattribute([object,] name, variable): of the primitive, or of its attributes.
    void attribute(size_t i, const std::vector<std::string>& a, std::string& out) {
        const std::string& to = a.back();
        std::string name = a.size() > 2 ? a[1] : a[0];
        if (a[0] == " \"builtin\"") name = name == " \"id\"" ? " \"identifier:id\"" : " \"identifier:id2\"";
        if (a.size() < 2) return fail(i, "getattribute() needs a name and a variable");
        out += " max(getvar(null," + name + "," + to + "), attribute(" + name + "," + to + "))";
    }

    std::vector<OslWord> w_;
    std::string path_;
    Diagnostics& diagnostics_;
    std::map<size_t, size_t> close_;
    std::set<std::string> renamed_, whole_;
    std::string before_; ///< text to insert before the current statement
    int shaders_ = 0;
    bool failed_ = false;
};

} // namespace

std::optional<std::string> rslFromOsl(const std::string& osl, const std::string& path, Diagnostics& d) {
    return OslTranslator(oslWords(osl), path, d).run();
}

} // namespace alpenglow::rsl::front
