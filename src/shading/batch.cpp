#include "shading/batch.h"
#include <algorithm>
#include <cstddef>
#include <cstring>

namespace alpenglow::shading {

namespace {

constexpr int16_t kZero = -1, kOne = -2, kThree = -3;
constexpr float kConstants[3] = {0, 1, 3};

// One line per predefined variable (rsl.md section 8): where its parts {v, du, dv, duu, duv, dvv} lie in a ShadePoint. Second
// derivatives that the geometry does not know are zero.
struct Variable { const char* name; int16_t part[6]; };
#define AT(member) int16_t(offsetof(ShadePoint, member))
const Variable kVariables[] = {
    {"P", {AT(P), AT(surface.dPdu), AT(surface.dPdv), AT(surface.Puu), AT(surface.Puv), AT(surface.Pvv)}},
    {"dPdu", {AT(surface.dPdu), AT(surface.Puu), AT(surface.Puv), kZero, kZero, kZero}},
    {"dPdv", {AT(surface.dPdv), AT(surface.Puv), AT(surface.Pvv), kZero, kZero, kZero}},
    {"N", {AT(N), AT(surface.dNdu), AT(surface.dNdv), kZero, kZero, kZero}},
    {"Ng", {AT(surface.Ng), AT(surface.dNdu), AT(surface.dNdv), kZero, kZero, kZero}},
    {"u", {AT(surface.u), kOne, kZero, kZero, kZero, kZero}},
    {"v", {AT(surface.v), kZero, kOne, kZero, kZero, kZero}},
    {"du", {AT(du), kZero, kZero, kZero, kZero, kZero}},
    {"dv", {AT(dv), kZero, kZero, kZero, kZero, kZero}},
    {"s", {AT(surface.s), AT(surface.dsdu), AT(surface.dsdv), kZero, kZero, kZero}},
    {"t", {AT(surface.t), AT(surface.dtdu), AT(surface.dtdv), kZero, kZero, kZero}},
    {"I", {AT(I), AT(surface.dPdu), AT(surface.dPdv), AT(surface.Puu), AT(surface.Puv), AT(surface.Pvv)}},
    {"E", {AT(E), kZero, kZero, kZero, kZero, kZero}},
    {"Ci", {AT(Ci), kZero, kZero, kZero, kZero, kZero}},
    {"Oi", {AT(Oi), kZero, kZero, kZero, kZero, kZero}},
    {"alpha", {AT(alpha), kZero, kZero, kZero, kZero, kZero}},
    {"Ps", {AT(Ps), kZero, kZero, kZero, kZero, kZero}},
    {"Ns", {AT(Ns), kZero, kZero, kZero, kZero, kZero}},
    {"ncomps", {kThree, kZero, kZero, kZero, kZero, kZero}},
    {"time", {AT(time), kZero, kZero, kZero, kZero, kZero}},
};
#undef AT

} // namespace

BatchPlan::BatchPlan(const rsl::CompiledKernel& kernel, bool mixed) {
    for (const rsl::ir::Input& input : kernel.inputs()) {
        Source s;
        s.components = rsl::ir::components(input.kind);
        s.elements = std::max(1, input.array);
        s.parts = rsl::inputParts(input);
        s.scalar = input.uniform && !mixed;
        s.varying = !input.uniform;
        s.firstRow = rows_;
        s.rows = size_t(s.components) * s.elements * s.parts;
        rows_ += s.rows;
        if (input.name.rfind("space:", 0) == 0) {
            size_t arrow = input.name.find('>');
            s.from = From::Space;
            s.space = input.name.substr(6, arrow - 6);
            s.toSpace = input.name.substr(arrow + 1);
        } else if (input.name.rfind("param:", 0) == 0) {
            s.from = From::Parameter;
            s.name = input.name.substr(6);
        } else if (input.name == "Cs" || input.name == "Os") {
            s.from = input.name == "Cs" ? From::Cs : From::Os;
        } else {
            for (const Variable& v : kVariables)
                if (input.name == v.name) {
                    s.from = From::Variable;
                    std::copy(v.part, v.part + 6, s.offset);
                }
        }
        inputs_.push_back(std::move(s));
    }
    for (const rsl::ir::OutputSlot& o : kernel.outputs()) {
        outputRow_.push_back(rows_);
        outputs_.push_back(o.name);
        rows_ += size_t(rsl::ir::components(o.kind));
    }
    Ci = output("Ci");
    Oi = output("Oi");
    P = output("P");
    N = output("N");
}

int BatchPlan::output(std::string_view name) const {
    for (size_t i = 0; i < outputs_.size(); ++i)
        if (outputs_[i] == name) return int(i);
    return -1;
}

Batch::Batch(std::shared_ptr<const rsl::CompiledKernel> k, const BatchPlan& plan, std::span<const ShadePoint> points,
             std::span<const InstanceView> views, const SpaceResolver& spaces)
    : kernel_(std::move(k)), plan_(plan) {
    call_.n = int32_t(points.size());
    call_.stride = int32_t((points.size() + 63) / 64 * 64);
    call_.strings = kernel_->strings().data();
    size_t stride = size_t(call_.stride), total = std::max<size_t>(1, plan.rows_) * std::max<size_t>(stride, 64);
    storage_.reset(static_cast<float*>(::operator new[](total * sizeof(float), std::align_val_t(64))));
    in_.reserve(plan.inputs_.size());
    out_.reserve(plan.outputRow_.size());
    for (const BatchPlan::Source& s : plan.inputs_) {
        float* row = storage_.get() + s.firstRow * stride;
        in_.push_back(row);
        if (!points.empty()) fill(s, row, points, views, spaces);
    }
    for (size_t row : plan.outputRow_) out_.push_back(storage_.get() + row * stride);
    if (!plan.outputRow_.empty()) // what lanes leave unwritten must not be garbage
        std::fill(storage_.get() + plan.outputRow_[0] * stride, storage_.get() + plan.rows_ * stride, 0.f);
    call_.in = in_.data();
    call_.out = out_.data();
}

void Batch::fill(const BatchPlan::Source& s, float* row, std::span<const ShadePoint> points, std::span<const InstanceView> views,
                 const SpaceResolver& spaces) {
    using From = BatchPlan::From;
    int n = int(points.size()), np = s.parts, comps = s.components;
    size_t stride = size_t(call_.stride);
    auto at = [&](int component, int part, int point) -> float& {
        return s.scalar ? row[component] : row[(size_t(component) * np + part) * stride + point];
    };
    int count = s.scalar ? 1 : n;
    auto pad = [&] { // lanes past n repeat the last point, so that no garbage is computed on
        if (s.scalar) return;
        for (size_t r = 0; r < s.rows; ++r) std::fill(row + r * stride + n, row + (r + 1) * stride, row[r * stride + n - 1]);
    };
    switch (s.from) {
    case From::Variable: {
        int parts = s.scalar ? 1 : np;
        for (int c = 0; c < comps; ++c)
            for (int p = 0; p < parts; ++p) {
                float* to = s.scalar ? row + c : row + (size_t(c) * np + p) * stride;
                if (s.offset[p] < 0) {
                    std::fill_n(to, count, kConstants[-1 - s.offset[p]]);
                    continue;
                }
                const char* from = reinterpret_cast<const char*>(points.data()) + s.offset[p] + size_t(c) * sizeof(float);
                for (int i = 0; i < count; ++i) std::memcpy(to + i, from + size_t(i) * sizeof(ShadePoint), sizeof(float));
            }
        return pad();
    }
    case From::Cs:
    case From::Os: {
        const char* name = s.from == From::Cs ? "Cs" : "Os";
        const geometry::Shape* last = nullptr; // neighbours are mostly of one shape: its variables are searched once
        int v = -1;
        for (int i = 0; i < count; ++i) {
            float value[16] = {1, 1, 1}, du[16] = {}, dv[16] = {};
            if (const geometry::Shape* shape = points[i].shape) {
                const Color& c = s.from == From::Cs ? shape->attributes().color : shape->attributes().opacity;
                for (int k = 0; k < 3; ++k) value[k] = c[k];
                if (shape != last) {
                    v = shape->findPrimvar(name);
                    last = shape;
                }
                if (v >= 0) shape->interpolate(v, points[i].surface, value, du, dv);
            }
            for (int c = 0; c < comps; ++c) {
                at(c, 0, i) = value[c];
                if (np > 1 && !s.scalar) {
                    at(c, 1, i) = du[c];
                    at(c, 2, i) = dv[c];
                    for (int p = 3; p < np; ++p) at(c, p, i) = 0;
                }
            }
        }
        return pad();
    }
    case From::Space:
        for (int i = 0; i < count; ++i) {
            Matrix m;
            auto own = [&](const std::string& space, Matrix& toCurrent) {
                if (space == "object" && points[i].shape) { toCurrent = points[i].shape->toCamera(); return true; }
                if (space == "shader" && views[i].shaderToCurrent) { toCurrent = *views[i].shaderToCurrent; return true; }
                return false;
            };
            if (!(s.toSpace == "current" && own(s.space, m))) {
                if (s.space == "current" && own(s.toSpace, m)) m = inverse(m);
                else spaces.matrix(s.space, s.toSpace, m);
            }
            for (int c = 0; c < 16; ++c) at(c, 0, i) = float(m.m[c / 4][c % 4]);
        }
        return pad();
    case From::Parameter: {
        std::fill_n(row, s.scalar ? size_t(comps) * s.elements : s.rows * stride, 0.f);
        // A batch holds few instances: the last ones are remembered, so that names are searched once each.
        struct Known { const ParameterBlock* block = nullptr; const std::vector<float>* numbers = nullptr; } known[8];
        size_t replace = 0;
        const geometry::Shape* last = nullptr;
        int v = -1;
        for (int i = 0; i < count; ++i) {
            if (s.varying && points[i].shape) {
                if (points[i].shape != last) {
                    last = points[i].shape;
                    v = last->findPrimvar(s.name);
                }
                if (v >= 0) {
                    float value[16] = {}, du[16] = {}, dv[16] = {};
                    if (points[i].shape->primvars()[v].outWidth() <= 16) points[i].shape->interpolate(v, points[i].surface, value, du, dv);
                    for (int c = 0; c < std::min(comps * s.elements, 16); ++c) {
                        at(c, 0, i) = value[c];
                        if (np > 1) { at(c, 1, i) = du[c]; at(c, 2, i) = dv[c]; }
                    }
                    continue;
                }
            }
            const ParameterBlock* block = views[i].parameters;
            if (!block) continue;
            const Known* k = known;
            while (k < known + 8 && k->block != block) ++k;
            if (k == known + 8) {
                Known& fresh = known[replace++ % 8];
                auto found = block->numbers.find(s.name);
                fresh = {block, found != block->numbers.end() ? &found->second : nullptr};
                k = &fresh;
            }
            const std::vector<float>* numbers = k->numbers;
            if (!numbers) continue;
            for (int c = 0; c < comps * s.elements && c < int(numbers->size()); ++c) at(c, 0, i) = (*numbers)[c];
        }
        return pad();
    }
    case From::Nothing: std::fill_n(row, s.rows * stride, 0.f); return;
    }
}

} // namespace alpenglow::shading
