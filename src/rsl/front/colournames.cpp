#include "rsl/front/colournames.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <cctype>
#include <set>

namespace alpenglow::rsl::front {

namespace {

const std::vector<std::string>& spaces() {
    static const std::vector<std::string> all = {"rgb", "hsv", "hsl", "yiq", "xyz"};
    return all;
}

class ColourNameCheck {
public:
    explicit ColourNameCheck(SourceSet& sources) : sources_(sources) {}

    void call(const Expr& e) {
        if (e.space && e.type.base == Base::Color) name(*e.space);
        if (!e.shadeop || e.shadeop->name != "ctransform") return;
        for (size_t i = 0; i + 1 < e.args.size(); ++i)
            if (e.args[i]) name(*e.args[i]);
    }

private:
    void name(const Expr& e) {
        if (e.kind != ExprKind::String || e.text.empty()) return;
        std::string lower = e.text;
        std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
        if (std::find(spaces().begin(), spaces().end(), lower) != spaces().end() || !reported_.insert(e.text).second) return;
        const std::string near = nearestName(lower, spaces());
        std::string hint = near.empty() ? "there are:" : "did you mean \"" + near + "\"?";
        for (const std::string& s : spaces())
            if (near.empty()) hint += (hint.back() == ':' ? " " : ", ") + s;
        sources_.report(e.place, msg::kUnknownColourSpace(e.text), hint);
    }

    SourceSet& sources_;
    std::set<std::string> reported_;
};

} // namespace

void checkColourNames(const Program& program, SourceSet& sources) {
    ColourNameCheck names(sources);
    const auto expression = [&](const Expr& e) { names.call(e); };
    for (const auto& s : program.shaders) {
        for (const auto& p : s->parameters)
            if (p.defaultValue) everyExpr(*p.defaultValue, expression);
        if (s->body) everyExpr(*s->body, expression);
    }
    everyFunctionBody(program, [&](const Stmt& body) { everyExpr(body, expression); });
}

} // namespace alpenglow::rsl::front
