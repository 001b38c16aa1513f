#include "shading/batch.h"
#include <cstring>

namespace alpenglow::shading {

namespace {

using rsl::ir::Kind;

// Value and tangents of a float or triple predefined variable at a point: parts {v, du, dv, duu, duv, dvv}.
struct Jet { Vec3 part[6]; };

using Reader = void (*)(const ShadePoint&, Jet&);

// One line per predefined variable (rsl.md section 8). Floats use x. Second derivatives that the geometry does not know are zero.
struct Variable { const char* name; Reader read; };
constexpr Vec3 kZero{};
const Variable kVariables[] = {
    {"P", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{p.P, s.dPdu, s.dPdv, s.Puu, s.Puv, s.Pvv}}; }},
    {"dPdu", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{s.dPdu, s.Puu, s.Puv, kZero, kZero, kZero}}; }},
    {"dPdv", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{s.dPdv, s.Puv, s.Pvv, kZero, kZero, kZero}}; }},
    {"N", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{p.N, s.dNdu, s.dNdv, kZero, kZero, kZero}}; }},
    {"Ng", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{s.Ng, s.dNdu, s.dNdv, kZero, kZero, kZero}}; }},
    {"u", [](const ShadePoint& p, Jet& j) { j = {{Vec3(p.surface.u), Vec3(1), kZero, kZero, kZero, kZero}}; }},
    {"v", [](const ShadePoint& p, Jet& j) { j = {{Vec3(p.surface.v), kZero, Vec3(1), kZero, kZero, kZero}}; }},
    {"du", [](const ShadePoint& p, Jet& j) { j = {{Vec3(p.du), kZero, kZero, kZero, kZero, kZero}}; }},
    {"dv", [](const ShadePoint& p, Jet& j) { j = {{Vec3(p.dv), kZero, kZero, kZero, kZero, kZero}}; }},
    {"s", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{Vec3(s.s), Vec3(s.dsdu), Vec3(s.dsdv), kZero, kZero, kZero}}; }},
    {"t", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{Vec3(s.t), Vec3(s.dtdu), Vec3(s.dtdv), kZero, kZero, kZero}}; }},
    {"I", [](const ShadePoint& p, Jet& j) { auto& s = p.surface; j = {{p.I, s.dPdu, s.dPdv, s.Puu, s.Puv, s.Pvv}}; }},
    {"E", [](const ShadePoint& p, Jet& j) { j = {{p.E, kZero, kZero, kZero, kZero, kZero}}; }},
    {"Ci", [](const ShadePoint& p, Jet& j) { j = {{p.Ci, kZero, kZero, kZero, kZero, kZero}}; }},
    {"Oi", [](const ShadePoint& p, Jet& j) { j = {{p.Oi, kZero, kZero, kZero, kZero, kZero}}; }},
    {"alpha", [](const ShadePoint& p, Jet& j) { j = {{Vec3(p.alpha), kZero, kZero, kZero, kZero, kZero}}; }},
    {"Ps", [](const ShadePoint& p, Jet& j) { j = {{p.Ps, kZero, kZero, kZero, kZero, kZero}}; }},
    {"Ns", [](const ShadePoint& p, Jet& j) { j = {{p.Ns, kZero, kZero, kZero, kZero, kZero}}; }},
    {"ncomps", [](const ShadePoint&, Jet& j) { j = {{Vec3(3), kZero, kZero, kZero, kZero, kZero}}; }},
    {"time", [](const ShadePoint& p, Jet& j) { j = {{Vec3(p.time), kZero, kZero, kZero, kZero, kZero}}; }},
};

void readColour(const ShadePoint& p, const char* primvar, const Color& attribute, Jet& j) {
    j = {{attribute, kZero, kZero, kZero, kZero, kZero}};
    int v = p.shape ? p.shape->findPrimvar(primvar) : -1;
    if (v < 0) return;
    float value[16] = {}, du[16] = {}, dv[16] = {};
    p.shape->interpolate(v, p.surface, value, du, dv);
    j.part[0] = {value[0], value[1], value[2]};
    j.part[1] = {du[0], du[1], du[2]};
    j.part[2] = {dv[0], dv[1], dv[2]};
}

int parts(int order) { return order == 0 ? 1 : order == 1 ? 3 : 6; }

} // namespace

Batch::Batch(std::shared_ptr<const rsl::CompiledKernel> k, std::span<const ShadePoint> points, std::span<const InstanceView> views, bool mixed,
             const SpaceResolver& spaces)
    : kernel_(std::move(k)) {
    call_.n = int32_t(points.size());
    call_.stride = int32_t((points.size() + 63) / 64 * 64);
    call_.strings = kernel_->strings().data();
    auto rows = [&](size_t count) {
        // Vectors' own alignment is 16; the row block starts at the first 64-byte boundary.
        storage_.emplace_back(count * call_.stride + 16, 0.f);
        auto address = reinterpret_cast<uintptr_t>(storage_.back().data());
        return reinterpret_cast<float*>((address + 63) & ~uintptr_t(63));
    };
    storage_.reserve(kernel_->inputs().size() + kernel_->outputs().size());
    for (const auto& i : kernel_->inputs())
        in_.push_back(rows(size_t(rsl::ir::components(i.kind)) * std::max(1, i.array) * parts(i.order)));
    for (const auto& o : kernel_->outputs()) out_.push_back(rows(size_t(rsl::ir::components(o.kind))));
    call_.in = in_.data();
    call_.out = out_.data();
    for (size_t i = 0; i < in_.size(); ++i) fill(int(i), kernel_->inputs()[i], points, views, mixed, spaces);
}

int Batch::output(std::string_view name) const {
    const auto& o = kernel_->outputs();
    for (size_t i = 0; i < o.size(); ++i)
        if (o[i].name == name) return int(i);
    return -1;
}

int Batch::input(std::string_view name) const {
    const auto& o = kernel_->inputs();
    for (size_t i = 0; i < o.size(); ++i)
        if (o[i].name == name) return int(i);
    return -1;
}

void Batch::fill(int index, const rsl::ir::Input& input, std::span<const ShadePoint> points, std::span<const InstanceView> views, bool mixed,
                 const SpaceResolver& spaces) {
    float* row = in_[index];
    int n = int(points.size()), stride = call_.stride, np = parts(input.order), comps = rsl::ir::components(input.kind);
    if (n == 0) return;
    bool scalar = input.uniform && !mixed;
    auto at = [&](int component, int part, int point) -> float& {
        return scalar ? row[component] : row[(size_t(component) * np + part) * stride + point];
    };
    int count = scalar ? 1 : n;
    auto pad = [&] { // lanes past n repeat the last point, so that no garbage is computed on
        if (scalar) return;
        size_t total = size_t(comps) * std::max(1, input.array) * np;
        for (size_t r = 0; r < total; ++r)
            for (int i = n; i < stride; ++i) row[r * stride + i] = row[r * stride + n - 1];
    };

    if (input.name.rfind("space:", 0) == 0) {
        size_t arrow = input.name.find('>');
        std::string from = input.name.substr(6, arrow - 6), to = input.name.substr(arrow + 1);
        for (int i = 0; i < count; ++i) {
            Matrix m;
            auto own = [&](const std::string& space, Matrix& toCurrent) {
                if (space == "object" && points[i].shape) { toCurrent = points[i].shape->toCamera(); return true; }
                if (space == "shader" && views[i].shaderToCurrent) { toCurrent = *views[i].shaderToCurrent; return true; }
                return false;
            };
            if (!(to == "current" && own(from, m))) {
                if (from == "current" && own(to, m)) m = inverse(m);
                else spaces.matrix(from, to, m);
            }
            for (int c = 0; c < 16; ++c) at(c, 0, i) = float(m.m[c / 4][c % 4]);
        }
        return pad();
    }
    if (input.name.rfind("param:", 0) == 0) {
        std::string name = input.name.substr(6);
        int elements = std::max(1, input.array);
        for (int i = 0; i < count; ++i) {
            if (!input.uniform && points[i].shape) {
                int v = points[i].shape->findPrimvar(name);
                if (v >= 0) {
                    float value[16] = {}, du[16] = {}, dv[16] = {};
                    if (points[i].shape->primvars()[v].outWidth() <= 16) points[i].shape->interpolate(v, points[i].surface, value, du, dv);
                    for (int c = 0; c < std::min(comps * elements, 16); ++c) {
                        at(c, 0, i) = value[c];
                        if (np > 1) { at(c, 1, i) = du[c]; at(c, 2, i) = dv[c]; }
                    }
                    continue;
                }
            }
            auto found = views[i].parameters ? views[i].parameters->numbers.find(name) : decltype(views[i].parameters->numbers.end()){};
            if (!views[i].parameters || found == views[i].parameters->numbers.end()) continue;
            for (int c = 0; c < comps * elements && c < int(found->second.size()); ++c) at(c, 0, i) = found->second[c];
        }
        return pad();
    }
    const Variable* variable = nullptr;
    for (const auto& v : kVariables)
        if (input.name == v.name) variable = &v;
    bool cs = input.name == "Cs", os = input.name == "Os";
    for (int i = 0; i < count; ++i) {
        Jet j{};
        if (variable) variable->read(points[i], j);
        else if ((cs || os) && points[i].shape) readColour(points[i], cs ? "Cs" : "Os", cs ? points[i].shape->attributes().color : points[i].shape->attributes().opacity, j);
        else if (cs || os) j.part[0] = Vec3(1);
        for (int c = 0; c < comps; ++c)
            for (int p = 0; p < (scalar ? 1 : np); ++p) at(c, p, i) = j.part[p][c];
    }
    pad();
}

} // namespace alpenglow::shading
