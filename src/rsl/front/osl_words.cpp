#include "rsl/front/osl_words.h"
#include "rsl/front/ast.h"
#include "shadeops/descriptor.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <set>

namespace alpenglow::rsl::front {
namespace {

bool oslLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class OslReader {
public:
    explicit OslReader(std::string_view text) : text_(text) {}

    std::vector<OslWord> all() {
        std::vector<OslWord> words;
        while (skipBlank(), at_ < text_.size()) {
            if (rest().starts_with("[[")) {
                const bool bound = skipMetadata();
                if (bound && !words.empty()) words.back().bound = true;
                continue;
            }
            OslWord w{OslWord::Kind::Sign, {}, line_ - before_, line_, int(at_ - lineBegin_) + 1};
            before_ = line_;
            take(w, words.empty() || w.lines > 0);
            words.push_back(std::move(w));
        }
        return words;
    }

private:
    std::string_view rest() const { return text_.substr(at_); }
    void step() {
        if (text_[at_++] == '\n') ++line_, lineBegin_ = at_;
    }
    void skipBehind(std::string_view end) {
        while (at_ < text_.size() && !rest().starts_with(end)) step();
        for (size_t n = 0; n < end.size() && at_ < text_.size(); ++n) step();
    }
    void skipBlank() {
        while (at_ < text_.size()) {
            if (std::isspace(static_cast<unsigned char>(text_[at_]))) step();
            else if (rest().starts_with("//")) skipBehind("\n");
            else if (rest().starts_with("/*")) skipBehind("*/");
            else break;
        }
    }
    /// Skips metadata in [[ ]]. True if they have lockgeom = 0.
    bool skipMetadata() {
        std::string reported;
        for (int depth = 0; at_ < text_.size();) {
            if (text_[at_] == '"') {
                step();
                skipBehind("\"");
                continue;
            }
            depth += text_[at_] == '[' ? 1 : text_[at_] == ']' ? -1 : 0;
            if (!std::isspace(static_cast<unsigned char>(text_[at_]))) reported += text_[at_];
            step();
            if (depth == 0) break;
        }
        return reported.find("lockgeom=0") != std::string::npos;
    }
    void take(OslWord& w, bool first) {
        static constexpr std::array<std::string_view, 19> kSigns{
            "<<=", ">>=", "==", "!=", "<=", ">=", "&&", "||", "+=", "-=", "*=", "/=", "++", "--", "<<", ">>", "&=", "|=", "^="};
        const size_t from = at_;
        const char c = text_[at_];
        const bool number = std::isdigit(static_cast<unsigned char>(c)) ||
                            (c == '.' && at_ + 1 < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_ + 1])));
        if (c == '#' && first) {
            w.kind = OslWord::Kind::Directive;
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        } else if (c == '"') {
            w.kind = OslWord::Kind::String;
            ++at_;
            while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n')
                at_ += text_[at_] == '\\' && at_ + 1 < text_.size() ? 2 : 1;
            at_ = std::min(at_ + 1, text_.size());
        } else if (number) {
            w.kind = OslWord::Kind::Number;
            while (at_ < text_.size() &&
                   (oslLetter(text_[at_]) || text_[at_] == '.' ||
                    ((text_[at_] == '-' || text_[at_] == '+') && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E'))))
                ++at_;
        } else if (oslLetter(c)) {
            w.kind = OslWord::Kind::Name;
            while (at_ < text_.size() && oslLetter(text_[at_])) ++at_;
        } else {
            const auto sign = std::find_if(kSigns.begin(), kSigns.end(), [&](auto s) { return rest().starts_with(s); });
            at_ += sign == kSigns.end() ? 1 : sign->size();
        }
        w.text = std::string(text_.substr(from, at_ - from));
        if (w.kind == OslWord::Kind::Number && (w.text.back() == 'f' || w.text.back() == 'F') && !w.text.starts_with("0x"))
            w.text.pop_back();
    }

    std::string_view text_;
    size_t at_ = 0, lineBegin_ = 0;
    int line_ = 1, before_ = 1;
};

} // namespace

std::vector<OslWord> oslWords(std::string_view text) { return OslReader(text).all(); }

bool isOslType(std::string_view w) {
    return w == "float" || w == "int" || w == "color" || w == "point" || w == "vector" || w == "normal" || w == "matrix" ||
           w == "string";
}

bool isRslGlobal(const std::string& name, const std::string& type) {
    const auto all = globalVariables(ShaderKind::Surface);
    return std::any_of(all.begin(), all.end(),
                       [&](const GlobalVariable& g) { return g.name == name && toString(g.type) == type; });
}

bool isRslWord(const std::string& name) {
    static const std::set<std::string, std::less<>> words = [] {
        std::set<std::string, std::less<>> all{
            "uniform",    "varying", "output", "extern",         "light",       "surface", "volume", "imager", "displacement",
            "class",      "struct",  "public", "constant",       "plugin",      "shader",  "solar",  "gather", "illuminance",
            "illuminate", "this",    "PI",     "transformation", "constructor", "caller",  "null"};
        for (const ShaderKind k : {ShaderKind::Surface, ShaderKind::Displacement, ShaderKind::Light})
            for (const GlobalVariable& g : globalVariables(k)) all.insert(g.name);
        return all;
    }();
    return words.count(name) || findShadeop(name);
}

} // namespace alpenglow::rsl::front
