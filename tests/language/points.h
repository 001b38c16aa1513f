// Runs kernels on points of the test's choosing.
#pragma once
#include "../nightly.h"
#include "rsl/evaluate.h"
#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>

namespace alpenglow::rsl {

/// Value of component `component`, jet part `part`, of input `name` at point `point`.
using PointValue = std::function<float(const std::string& name, int component, int part, int point)>;

/// The point of rsl/evaluate.h.
inline PointValue evaluationPoint() {
    return [](const std::string& name, int component, int part, int) {
        float v = 0;
        EvaluationPoint::value(name, component, part, v);
        return v;
    };
}

/// The two lights that illuminance finds wherever it looks: L, Cl, Ol. One straight above the evaluation point, one aside.
inline constexpr float kTestLights[2][9] = {{0, 0, 2, 1, 0.5f, 0.25f, 1, 1, 1}, {3, 0, 4, 0.5f, 0.5f, 0.5f, 1, 1, 1}};

/// Whether a light of the test stands within the cone about `axis`; a cone without an axis holds all.
inline bool litBy(const float* L, const float* axis, float angle) {
    const double x = double(axis[0]), y = double(axis[1]), z = double(axis[2]);
    const double size = std::sqrt((x * x + y * y + z * z) * double(L[0] * L[0] + L[1] * L[1] + L[2] * L[2]));
    const double cosine = size > 0 ? (x * double(L[0]) + y * double(L[1]) + z * double(L[2])) / size : 1;
    return cosine > std::cos(double(angle));
}

/// What a kernel of the test calls.
struct PointCalls {
    const CompiledKernel* kernel;
    Diagnostics* diagnostics;
    std::vector<std::vector<float>> cones; ///< of the loops that run, outermost first

    /// rsl::ServiceFn
    static void service(KernelCall* c, int32_t site, int32_t, uint64_t mask, int32_t lanes, const float* a, float* r) {
        const auto& x = *static_cast<PointCalls*>(c->user);
        if (site < 0) return;
        const ir::Site& s = x.kernel->sites()[size_t(site)];
        if (basicService(s, mask, lanes, a, r, *x.diagnostics, [](int, const std::string&) {})) return;
        if (s.op.ends_with("transform")) { // every space is "current": names come first, then the value
            int row = 0;
            for (const ir::Kind k : s.argKinds) row += k == ir::Kind::String;
            std::copy_n(a + row * lanes, ir::components(s.resultKinds[0]) * lanes, r);
        }
    }
    /// rows: P, axis, angle
    static int32_t lightBegin(KernelCall* c, int32_t, int32_t, uint64_t, int32_t lanes, const float* rows) {
        static_cast<PointCalls*>(c->user)->cones.emplace_back(rows, rows + 7 * lanes);
        return 2;
    }
    /// L, Cl, Ol of a light
    static uint64_t lightFetch(KernelCall* c, int32_t, int32_t light, int32_t, uint64_t mask, int32_t lanes, float* out) {
        const std::vector<float>& cone = static_cast<PointCalls*>(c->user)->cones.back();
        uint64_t lit = 0;
        for (int l = 0; l < lanes; l++) {
            for (int r = 0; r < 9; r++) out[r * lanes + l] = kTestLights[light][r];
            const auto row = [&](int r) { return cone[size_t(r * lanes + l)]; };
            const float axis[3] = {row(3), row(4), row(5)};
            if (litBy(kTestLights[light], axis, row(6))) lit |= uint64_t(1) << l;
        }
        return lit & mask;
    }
    static void lightEnd(KernelCall* c, int32_t, int32_t, int32_t) { static_cast<PointCalls*>(c->user)->cones.pop_back(); }
};

/// out[output][component * n + point]. Uniform inputs of build S take the value of point 0. Spaces are identities; parameters
/// come from `defaults`. False when the kernel suspends. Services other than those of strings leave zeros.
inline bool runPoints(const CompiledKernel& k, bool mixed, int n, const PointValue& value,
                      const std::vector<ParameterValue>& defaults, std::vector<std::vector<float>>& out,
                      Diagnostics& diagnostics) {
    if (k.facts().suspends) return false;
    const size_t stride = size_t(n + 63) / 64 * 64;
    std::vector<std::unique_ptr<float, decltype(&std::free)>> blocks;
    const auto make = [&](size_t rows) {
        const size_t count = std::max<size_t>(1, rows) * stride;
        blocks.emplace_back(static_cast<float*>(std::aligned_alloc(64, count * sizeof(float))), &std::free);
        std::fill_n(blocks.back().get(), count, 0.0f);
        return blocks.back().get();
    };
    std::vector<const float*> in;
    for (const ir::Input& i : k.inputs()) {
        const size_t parts = size_t(inputParts(i)), components = size_t(ir::components(i.kind)),
                     elements = size_t(std::max(1, i.array));
        const ParameterValue* given = nullptr;
        for (const ParameterValue& d : defaults)
            if (i.name == "param:" + d.name) given = &d;
        float* rows = make(components * parts * elements);
        for (size_t e = 0; e < elements * components; e++)
            for (size_t part = 0; part < parts; part++)
                for (size_t p = 0; p < stride; p++) {
                    float v = 0;
                    if (given && part == 0) {
                        if (i.kind == ir::Kind::String)
                            v = std::bit_cast<float>(e < given->strings.size() ? internString(given->strings[e]) : 0);
                        else v = e < given->numbers.size() ? given->numbers[e] : 0;
                    } else if (!given && i.kind == ir::Kind::Matrix) {
                        v = e % 5 == 0 ? 1.0f : 0.0f;
                    } else if (!given) {
                        v = value(i.name, int(e), int(part), i.uniform && !mixed ? 0 : int(std::min<size_t>(p, size_t(n) - 1)));
                    }
                    if (i.uniform && !mixed) rows[e] = v;
                    else rows[(e * parts + part) * stride + p] = v;
                }
        in.push_back(rows);
    }
    std::vector<float*> results;
    for (const auto& o : k.outputs()) results.push_back(make(size_t(ir::components(o.kind))));
    PointCalls calls{&k, &diagnostics, {}};
    KernelCall call{};
    call.in = in.data();
    call.out = results.data();
    call.n = n;
    call.stride = int32_t(stride);
    call.strings = k.strings().data();
    call.user = &calls;
    call.service = PointCalls::service;
    call.lightBegin = PointCalls::lightBegin;
    call.lightFetch = PointCalls::lightFetch;
    call.lightEnd = PointCalls::lightEnd;
    k.run(&call);
    out.clear();
    for (size_t o = 0; o < results.size(); o++) {
        out.emplace_back();
        for (int c = 0; c < ir::components(k.outputs()[o].kind); c++)
            out.back().insert(out.back().end(), results[o] + size_t(c) * stride, results[o] + size_t(c) * stride + n);
    }
    return true;
}

/// 4, 8 and 16 lanes; uniform inputs as numbers and in lanes; optimised and not; functions inlined and called.
inline std::vector<KernelOptions> allConfigurations() {
    std::vector<KernelOptions> all;
    for (int lanes : {16, 8, 4})
        for (bool mixed : {false, true})
            for (int optimize : {2, 0}) {
                KernelOptions o;
                o.lanes = lanes;
                o.mixed = mixed;
                o.optimize = optimize;
                all.push_back(o);
                if ((lanes == 16) == (optimize == 2)) { // every function that can be is called, none inlined
                    o.outline = 0;
                    all.push_back(o);
                }
            }
    return all;
}

/// All of them nightly, else six in which every two of the choices (lanes, S or V, optimised or not, inlined or called) come
/// together: a mistake that two choices make together shows in both sets, one that needs three at night. The first is what the
/// others are compared with.
inline std::vector<KernelOptions> configurations() {
    if (nightly()) return allConfigurations();
    struct Choice {
        int lanes;
        bool mixed;
        int optimize;
        bool called;
    };
    std::vector<KernelOptions> six;
    for (const Choice& c : {Choice{16, false, 2, false},
                            {16, true, 0, true},
                            {8, false, 2, true},
                            {8, true, 0, false},
                            {4, false, 0, false},
                            {4, true, 2, true}}) {
        KernelOptions o;
        o.lanes = c.lanes;
        o.mixed = c.mixed;
        o.optimize = c.optimize;
        if (c.called) o.outline = 0;
        six.push_back(o);
    }
    return six;
}

inline std::string describe(const KernelOptions& o) {
    return std::to_string(o.lanes) + " lanes, " + (o.mixed ? "V" : "S") + ", O" + std::to_string(o.optimize) +
           (o.outline == 0 ? ", functions called" : "");
}

inline bool sameBits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (a != a && b != b); }

} // namespace alpenglow::rsl
