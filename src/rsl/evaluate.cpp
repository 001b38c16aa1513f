#include "rsl/evaluate.h"
#include "rsl/front/protocol.h"
#include "rsl/kernelrunner.h"
#include "rsl/messages/messages.h"
#include "rsl/spilledarrays.h"
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>

namespace alpenglow::rsl {
namespace {

// Name, components, value, d/du, d/dv. Second derivatives are zero: the point lies in a plane.
struct Row {
    const char* name;
    int components;
    float v[3], du[3], dv[3];
};
constexpr Row kRows[] = {
    {"u", 1, {0.5f}, {1}, {0}},
    {"v", 1, {0.5f}, {0}, {1}},
    {"s", 1, {0.5f}, {1}, {0}},
    {"t", 1, {0.5f}, {0}, {1}},
    {"du", 1, {1}, {}, {}},
    {"dv", 1, {1}, {}, {}},
    {"time", 1, {0}, {}, {}},
    {"dtime", 1, {0}, {}, {}},
    {"ncomps", 1, {3}, {}, {}},
    {"alpha", 1, {1}, {}, {}},
    {"P", 3, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
    {"dPdu", 3, {1, 0, 0}, {}, {}},
    {"dPdv", 3, {0, 1, 0}, {}, {}},
    {"dPdtime", 3, {0, 0, 0}, {}, {}},
    {"N", 3, {0, 0, 1}, {}, {}},
    {"Ng", 3, {0, 0, 1}, {}, {}},
    {kSideNormal, 3, {0, 0, 1}, {}, {}},
    {"I", 3, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
    {"E", 3, {0, 0, -1}, {}, {}},
    {"Cs", 3, {1, 1, 1}, {}, {}},
    {"Os", 3, {1, 1, 1}, {}, {}},
    {"Ci", 3, {0, 0, 0}, {}, {}},
    {"Oi", 3, {1, 1, 1}, {}, {}},
};

struct PointContext {
    const CompiledKernel* kernel;
    std::string* printed;
    Diagnostics* diagnostics;
    int points = 0;
    const AnswerFn* answer = nullptr;
    SpilledArrays spilled{};
    bool answers(int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
        if (answer && *answer && (*answer)(*kernel, site, first, mask, lanes, in, out)) return true;
        return spilled.answer(kernel->sites()[size_t(site)], first, mask, lanes, in, out, *diagnostics, &kernel->files());
    }
    std::vector<int> draws{}; ///< by site and point: random numbers drawn so far
};

constexpr const char* kTypes[] = {"float", "color", "point", "vector", "normal", "matrix", "string"};
constexpr Base kBases[] = {Base::Float, Base::Color, Base::Point, Base::Vector, Base::Normal, Base::Matrix, Base::String};

} // namespace

bool EvaluationPoint::value(const std::string& name, int component, int part, float& out) {
    for (const Row& r : kRows) {
        if (name != r.name || component >= 3) continue;
        out = part == 0 ? r.v[component] : part == 1 ? r.du[component] : part == 2 ? r.dv[component] : 0.0f;
        return true;
    }
    out = 0;
    return false;
}

namespace {

/// Answers a call at such a point.
void answerAtPoint(PointContext& x, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
    if (x.answers(site, first, mask, lanes, in, out)) return;
    const ir::Site& s = x.kernel->sites()[size_t(site)];
    basicService(
        s, mask, lanes, in, out, *x.diagnostics,
        [&](int lane, const std::string& text) {
            if (x.printed && first + lane == 0) *x.printed += text;
        },
        &x.kernel->files());
    if (s.op == "random") { // one number for each call in the text, and each turn of a loop
        x.draws.resize(std::max(x.draws.size(), size_t(site + 1) * size_t(x.points)));
        for (int lane = 0; lane < lanes; lane++) {
            if (!(mask >> lane & 1) || first + lane >= x.points) continue;
            const int turn = x.draws[size_t(site) * size_t(x.points) + size_t(first + lane)]++;
            float h[3];
            hashText("random " + std::to_string(site) + " " + std::to_string(turn), h);
            for (int c = 0; c < std::min(3, s.resultKinds.empty() ? 1 : ir::components(s.resultKinds[0])); c++)
                out[c * lanes + lane] = h[c];
        }
    }
    if (s.op.ends_with("transform") && s.op != "ctransform") { // every space is "current": names come first, then the value
        int row = 0;
        for (const ir::Kind k : s.argKinds) row += k == ir::Kind::String;
        std::copy_n(in + row * lanes, ir::components(s.resultKinds[0]) * lanes, out);
    }
    if (s.op == "gridmin" || s.op == "gridmax") { // a grid of one point without extent
        for (int c = 0; c < ir::components(s.argKinds.empty() ? ir::Kind::Float : s.argKinds[0]); c++)
            std::copy_n(in + c * lanes, lanes, out + c * lanes);
    }
}

/// Sets an input to its value at the point, in all lanes.
void fillAtPoint(const ir::Input& i, bool scalar, float* rows, size_t stride) {
    const int parts = inputParts(i), components = ir::components(i.kind), elements = std::max(1, i.array);
    for (int e = 0; e < elements; e++)
        for (int c = 0; c < components; c++)
            for (int part = 0; part < parts; part++) {
                float v = 0;
                if (i.kind == ir::Kind::Matrix) v = c % 5 == 0 ? 1.0f : 0.0f; // every space is "current"
                else EvaluationPoint::value(i.name, c, part, v);
                const size_t row = size_t(e * components + c) * size_t(parts) + size_t(part);
                if (scalar) rows[row] = v;
                else std::fill_n(rows + row * stride, stride, v);
            }
}

} // namespace

bool runAtPoint(const CompiledKernel& k, bool mixed, int n, int at, std::vector<std::vector<float>>& out, std::string* printed,
                Diagnostics& diagnostics, const AnswerFn& answer) {
    if (k.facts().suspends) return false;
    KernelRunner runner(k, size_t(n));
    for (size_t i = 0; i < k.inputs().size(); ++i)
        fillAtPoint(k.inputs()[i], k.inputs()[i].uniform && !mixed, runner.input(i), runner.stride());
    PointContext context{&k, printed, &diagnostics, n, &answer};
    runner.run(size_t(n), [&](int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* results) {
        answerAtPoint(context, site, first, mask, lanes, in, results);
    });
    for (size_t o = 0; o < k.outputs().size(); o++) {
        out.emplace_back();
        for (int c = 0; c < ir::components(k.outputs()[o].kind); c++) out.back().push_back(runner.output(o, c)[at]);
    }
    return true;
}

std::string formatNumbers(const std::vector<float>& numbers) {
    std::string s;
    for (float f : numbers) {
        char text[40];
        std::snprintf(text, sizeof text, "%.7g", double(f));
        if (!s.empty()) s += ' ';
        s += text;
    }
    return s;
}

Evaluation evaluate(ShaderCompiler& compiler, const std::string& setup, const std::string& expression,
                    const KernelOptions& options, Diagnostics& diagnostics, const AnswerFn& answer) {
    Evaluation r;
    std::shared_ptr<const CompiledShader> shader;
    auto attempt = [&](const std::string& text) {
        Diagnostics local;
        auto s = compiler.loadText(text, "expression", local);
        if (s) {
            for (const auto& d : local.all()) diagnostics.report(d);
            return s;
        }
        return s;
    };
    auto source = [&](const char* type) {
        return std::string("surface eval(output varying ") + type +
               " result = " + (std::string(type) == "string" ? "\"\"" : "0") + ";) {\n" + setup + "\n; result = (\n" +
               expression + "\n); }\n";
    };
    for (size_t k = 0; k < std::size(kTypes) && !shader; k++) {
        shader = attempt(source(kTypes[k]));
        r.type = {kBases[k], 0};
    }
    if (!shader) {
        shader = attempt("surface eval() {\n" + setup + "\n;\n" + expression + "\n; }\n");
        r.type = {};
    }
    if (!shader) {
        // Compiled again with diagnostics, as float: errors in the expression itself do not depend on its type.
        compiler.loadText(source("float"), "expression", diagnostics);
        return r;
    }
    KernelOptions o = options;
    o.outputs = {r.type.base == Base::Void ? "Ci" : "result"};
    auto kernel = compiler.kernel(shader, o, diagnostics);
    if (!kernel) return r;
    std::vector<std::vector<float>> out;
    if (!runAtPoint(*kernel, o.mixed, 1, 0, out, &r.printed, diagnostics, answer)) {
        diagnostics.report(diagnostic(msg::kNoScene, Rie::IllState, {"expression", 0, 0}));
        return r;
    }
    r.ok = true;
    if (r.type.base == Base::Void || out.empty()) return r;
    r.numbers = out[0];
    r.text = r.type.base == Base::String ? internedString(std::bit_cast<int32_t>(out[0][0])) : formatNumbers(r.numbers);
    return r;
}

} // namespace alpenglow::rsl
