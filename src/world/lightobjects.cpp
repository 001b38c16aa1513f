#include "world/lightobjects.h"
#include "rsl/front/visit.h"
#include <algorithm>
#include <locale>
#include <sstream>

namespace alpenglow::world {

namespace {
constexpr char kPlace[] = "shader@"; // not a space name of a scene: followed by sixteen numbers
constexpr shadeops::Type kColor{shadeops::Base::Color, 0};
} // namespace

std::set<std::string> calledOfLights(const rsl::Program& program) {
    std::set<std::string> names;
    bool lights = false;
    const auto look = [&](const rsl::Expr& e) {
        lights |= e.kind == rsl::ExprKind::ShadeopCall && e.shadeop &&
                  (e.shadeop->name == "getlights" || e.shadeop->name == "getlight");
        lights |= e.kind == rsl::ExprKind::String && e.handle && e.text == "(light)";
        const bool member = e.kind == rsl::ExprKind::Member, method = e.kind == rsl::ExprKind::Method;
        const bool plain = e.text == "light" && (e.args.size() == 3 || (e.args.size() == 4 && e.args[3]->type == kColor));
        if (member || (method && !plain)) names.insert(e.text);
    };
    const auto body = [&](const rsl::StmtPtr& b) {
        if (b) rsl::front::everyStmt(*b, [](const rsl::Stmt&) {}, look);
    };
    for (const auto& s : program.shaders) body(s->body);
    rsl::front::everyFunction(program, [&](const rsl::Function& f) { body(f.body); });
    return lights ? names : std::set<std::string>{};
}

bool answers(const rsl::CompiledShader& light, const std::set<std::string>& names) {
    const rsl::Shader& s = light.shader();
    if (!s.object) return false;
    return std::any_of(s.publics.begin(), s.publics.end(), [&](const auto& name) {
        if (!names.count(name)) return false;
        if (name != "light") return true;
        return std::any_of(s.nested.begin(), s.nested.end(), [](const auto& f) {
            return f->name == "light" &&
                   (f->parameters.size() > 3 || (f->parameters.size() == 3 && f->parameters[2]->type != kColor));
        });
    });
}

bool readsOwnPoint(const rsl::Shader& light) {
    bool reads = false;
    const auto expression = [&](const rsl::Expr& e) {
        reads |= e.kind == rsl::ExprKind::Variable && e.symbol && e.symbol->origin == rsl::Symbol::Origin::Global &&
                 e.symbol->name == "P";
    };
    const auto statement = [&](const rsl::Stmt& s) {
        if (s.kind != rsl::StmtKind::Illuminate && s.kind != rsl::StmtKind::Solar) return;
        for (const rsl::StmtPtr& b : s.body)
            if (b) rsl::front::everyStmt(*b, [](const rsl::Stmt&) {}, expression);
    };
    if (light.body) rsl::front::everyStmt(*light.body, statement, [](const rsl::Expr&) {});
    return reads;
}

std::string spaceAt(const Matrix& toCurrent) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(17); // enough digits to recover the number
    out << kPlace;
    for (int k = 0; k < 16; ++k) out << (k ? " " : "") << toCurrent.m[k / 4][k % 4];
    return out.str();
}

bool placeOf(const std::string& space, Matrix& toCurrent) {
    if (space.rfind(kPlace, 0) != 0) return false;
    std::istringstream in(space.substr(sizeof kPlace - 1));
    in.imbue(std::locale::classic());
    for (int k = 0; k < 16; ++k)
        if (!(in >> toCurrent.m[k / 4][k % 4])) return false;
    return true;
}

} // namespace alpenglow::world
