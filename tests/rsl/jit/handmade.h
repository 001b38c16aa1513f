// Kernels made by hand, and a caller for them.
#pragma once
#include "rsl/jit/jit.h"
#include <cstdlib>
#include <functional>
#include <gtest/gtest.h>
#include <map>

namespace alpenglow::rsl::test {

using ir::Inst;
using ir::Kind;
using ir::Op;

/// Builds a kernel instruction by instruction.
struct Made {
    ir::Kernel k;
    std::vector<ir::Region*> regions{&k.body};
    Inst* put(Op op, Kind kind, std::vector<Inst*> args = {}, int index = 0) {
        Inst* i = k.make(op, kind, std::move(args));
        i->index = index;
        regions.back()->body.push_back(i);
        return i;
    }
    Inst* number(float f) {
        Inst* i = put(Op::Const, Kind::Float);
        i->numbers = {f};
        return i;
    }
    Inst* input(const char* name, Kind kind = Kind::Float, bool uniform = false, int order = 0) {
        ir::Input in;
        in.name = name;
        in.kind = kind;
        in.uniform = uniform;
        in.order = uint8_t(order);
        k.inputs.push_back(in);
        Inst* i = put(Op::Input, kind, {}, int(k.inputs.size()) - 1);
        i->order = uint8_t(order);
        return i;
    }
    Inst* call(const char* symbol, Kind kind, std::vector<Inst*> args) {
        Inst* i = put(Op::Runtime, kind, std::move(args));
        i->text = symbol;
        return i;
    }
    void output(const char* name, Inst* v) {
        k.outputs.push_back({name, v->kind, {}});
        put(Op::Output, Kind::None, {v}, int(k.outputs.size()) - 1);
    }
    Inst* param(ir::Region& r, Kind kind) {
        Inst* i = k.make(Op::RegionParam, kind);
        i->index = int(r.params.size());
        r.params.push_back(i);
        return i;
    }
    int site(const char* op) {
        ir::Site s;
        s.op = op;
        k.sites.push_back(s);
        return int(k.sites.size()) - 1;
    }
};

/// Rows of a batch of n points.
struct Rows {
    int n, stride;
    explicit Rows(int points) : n(points), stride((points + 63) / 64 * 64) {}
    std::vector<float*> blocks;
    float* make(int rows) {
        auto* p = static_cast<float*>(std::aligned_alloc(64, size_t(rows) * size_t(stride) * 4));
        std::fill(p, p + rows * stride, 0.0f);
        blocks.push_back(p);
        return p;
    }
    ~Rows() {
        for (float* p : blocks) std::free(p);
    }
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;
};

inline std::shared_ptr<const CompiledKernel> compile(const Made& m, const KernelOptions& o, std::string* text = nullptr) {
    jit::KernelFile file;
    std::string error;
    if (!jit::generate(m.k, o, file, error, text)) {
        ADD_FAILURE() << error;
        return nullptr;
    }
    auto unpacked = jit::unpack(jit::pack(file));
    if (!unpacked) {
        ADD_FAILURE() << "the kernel file does not survive packing";
        return nullptr;
    }
    auto k = jit::load(*unpacked, false, error);
    if (!k) ADD_FAILURE() << error;
    return k;
}

/// Every width, vector count, build and level.
inline std::vector<KernelOptions> configurations() {
    std::vector<KernelOptions> all;
    for (int lanes : {4, 8, 16})
        for (int vectors : {1, 2, 4})
            for (bool mixed : {false, true})
                for (int optimize : {0, 2}) {
                    KernelOptions o;
                    o.lanes = lanes;
                    o.vectors = vectors;
                    o.mixed = mixed;
                    o.optimize = optimize;
                    all.push_back(o);
                }
    return all;
}

inline std::string describe(const KernelOptions& o) {
    return std::to_string(o.lanes) + "x" + std::to_string(o.vectors) + (o.mixed ? " V" : " S") + " O" +
           std::to_string(o.optimize);
}

inline constexpr int kPoints = 150; // not a multiple of any strip

/// Runs a kernel over kPoints points.
struct Batch {
    Rows rows{kPoints};
    std::vector<const float*> in;
    std::vector<float*> out;
    KernelCall call{};
    /// Inputs: values[i](point, row); uniform inputs are given by point 0, in lanes when mixed.
    void operator()(const CompiledKernel& k, const KernelOptions& o, const std::function<float(int, int, int)>& value) {
        for (size_t i = 0; i < k.inputs().size(); i++) {
            const ir::Input& x = k.inputs()[i];
            const int count = ir::components(x.kind) * inputParts(x) * std::max(1, x.array);
            float* p = rows.make(count);
            if (x.uniform && !o.mixed)
                for (int r = 0; r < count; r++) p[r] = value(int(i), 0, r);
            else
                for (int r = 0; r < count; r++)
                    for (int n = 0; n < kPoints; n++) p[r * rows.stride + n] = value(int(i), x.uniform ? 0 : n, r);
            in.push_back(p);
        }
        for (const auto& x : k.outputs()) out.push_back(rows.make(ir::components(x.kind)));
        call.in = in.data();
        call.out = out.data();
        call.n = kPoints;
        call.stride = rows.stride;
        call.strings = k.strings().data();
        k.run(&call);
    }
    float operator()(int output, int row, int point) const { return out[size_t(output)][row * rows.stride + point]; }
};

} // namespace alpenglow::rsl::test
