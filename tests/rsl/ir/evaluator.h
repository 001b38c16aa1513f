// A slow interpreter of the IR for one point: the oracle for the passes and for generated code. It shares nothing with either but
// the runtime's scalar entry. Rays, lights and services are faked: their results are a hash of their arguments. No derivatives:
// Du and Dv give 0.
#pragma once
#include "rsl/ir/ir.h"
#include "shadeops/descriptor.h"
#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

namespace alpenglow::rsl::ir {

struct Value {
    std::vector<float> n;
    std::string s;
    std::vector<std::vector<float>>* array = nullptr;
};

class Evaluator {
public:
    explicit Evaluator(const Kernel& k) : k_(k) {}
    /// Value of an input, by name: what tests set, else a hash of the name in [0,1).
    std::map<std::string, std::vector<float>> inputs;
    std::map<std::string, std::vector<float>> outputs;
    int steps = 0;

    void run() {
        region(k_.body);
        for (const Pair& p : pairs_)
            for (size_t c = 0; c < 3; ++c) outputs["Ci"][c] += p.weight[c] * p.result[p.result.size() == 3 ? c : 0];
    }

private:
    struct Pair {
        float weight[3];
        std::vector<float> result;
    };
    const Kernel& k_;
    std::unordered_map<const Inst*, std::vector<Value>> values_;
    std::vector<Pair> pairs_;
    std::vector<std::unique_ptr<std::vector<std::vector<float>>>> arrays_;

    static uint64_t mix(uint64_t h, uint64_t x) {
        h = (h ^ x) * 0x9e3779b97f4a7c15ull;
        return h ^ (h >> 29);
    }
    static float unit(uint64_t h) { return static_cast<float>(mix(h, 77) >> 40) / 16777216.0f; }
    static uint64_t hashText(const std::string& s, uint64_t h = 1) {
        for (char c : s) h = mix(h, static_cast<unsigned char>(c));
        return h;
    }

    const Value& get(const Inst* i) {
        return i->op == Op::Result ? values_.at(i->args[0]).at(static_cast<size_t>(i->index)) : values_.at(i).at(0);
    }
    float f(const Inst* i) { return get(i).n.at(0); }
    void set(const Inst* i, std::vector<float> v) { values_[i] = {Value{std::move(v), {}, nullptr}}; }

    /// The faked answer of a site: results one after the other.
    std::vector<Value> fake(const Inst* i, size_t from) {
        const Site& s = k_.sites[static_cast<size_t>(i->site)];
        uint64_t h = hashText(s.op);
        h = mix(mix(h, static_cast<uint64_t>(s.place.line)), static_cast<uint64_t>(s.place.column));
        for (size_t a = from; a < i->args.size(); ++a) {
            for (float x : get(i->args[a]).n) {
                uint32_t bits;
                std::memcpy(&bits, &x, 4);
                h = mix(h, bits);
            }
            h = hashText(get(i->args[a]).s, h);
        }
        std::vector<Value> out;
        for (size_t r = 0; r < s.resultKinds.size(); ++r) {
            Value v;
            for (int c = 0; c < components(s.resultKinds[r]); ++c) v.n.push_back(unit(mix(h, r * 16 + static_cast<uint64_t>(c))));
            if (s.resultKinds[r] == Kind::String) v.s = "faked";
            out.push_back(v);
        }
        return out;
    }

    void region(const Region& r) {
        for (const Inst* i : r.body) inst(i);
    }

    std::vector<Value> yields(const Region& r) {
        std::vector<Value> v;
        for (const Inst* y : r.yields) v.push_back(get(y));
        return v;
    }

    template <class F> void each(const Inst* i, F&& fn) {
        std::vector<float> out;
        const size_t n = get(i->args[0]).n.size();
        for (size_t c = 0; c < n; ++c) out.push_back(fn(get(i->args[0]).n[c], i->args.size() > 1 ? get(i->args[1]).n[c] : 0));
        set(i, out);
    }

    size_t element(const Inst* i) {
        const float x = f(i->args[1]);
        const auto n = static_cast<float>(get(i->args[0]).array->size());
        return static_cast<size_t>(x >= 0 ? (x < n ? x : n - 1) : 0);
    }

    void input(const Inst* i) {
        const Input& in = k_.inputs[static_cast<size_t>(i->index)];
        std::vector<float>& v = inputs[in.name];
        const int count = components(in.kind) * std::max(1, in.array);
        for (int c = static_cast<int>(v.size()); c < count; ++c)
            v.push_back(unit(mix(hashText(in.name), static_cast<uint64_t>(c))));
        if (i->op == Op::Input) {
            set(i, v);
            return;
        }
        arrays_.push_back(std::make_unique<std::vector<std::vector<float>>>());
        const size_t w = static_cast<size_t>(components(in.kind));
        for (size_t e = 0; e < static_cast<size_t>(in.array); ++e)
            arrays_.back()->emplace_back(v.begin() + static_cast<long>(e * w), v.begin() + static_cast<long>((e + 1) * w));
        values_[i] = {Value{{}, {}, arrays_.back().get()}};
    }

    /// Numbers, tuples and matrices.
    void arithmetic(const Inst* i) {
        const auto arg = [&](size_t a) -> const Value& { return get(i->args[a]); };
        switch (i->op) {
        case Op::Add:
            each(i, [](float a, float b) { return a + b; });
            break;
        case Op::Sub:
            each(i, [](float a, float b) { return a - b; });
            break;
        case Op::Mul:
            each(i, [](float a, float b) { return a * b; });
            break;
        case Op::Div:
            each(i, [](float a, float b) { return b == 0 ? 0 : a / b; });
            break;
        case Op::Neg:
            each(i, [](float a, float) { return -a; });
            break;
        case Op::Du:
        case Op::Dv:
            each(i, [](float, float) { return 0.0f; });
            break;
        case Op::Splat:
            set(i, std::vector<float>(3, f(i->args[0])));
            break;
        case Op::Triple:
        case Op::MatrixOf: {
            std::vector<float> v;
            for (const Inst* a : i->args) v.push_back(f(a));
            set(i, v);
            break;
        }
        case Op::Extract:
            set(i, {arg(0).n.at(static_cast<size_t>(i->index))});
            break;
        default:
            break;
        }
    }

    /// Comparisons and truth values.
    void truth(const Inst* i) {
        const auto arg = [&](size_t a) -> const Value& { return get(i->args[a]); };
        switch (i->op) {
        case Op::Less:
            set(i, {f(i->args[0]) < f(i->args[1]) ? 1.0f : 0.0f});
            break;
        case Op::LessEqual:
            set(i, {f(i->args[0]) <= f(i->args[1]) ? 1.0f : 0.0f});
            break;
        case Op::Equal:
        case Op::NotEqual: {
            const bool same = i->args[0]->kind == Kind::String ? arg(0).s == arg(1).s : f(i->args[0]) == f(i->args[1]);
            set(i, {same == (i->op == Op::Equal) ? 1.0f : 0.0f});
            break;
        }
        case Op::And:
            set(i, {f(i->args[0]) != 0 && f(i->args[1]) != 0 ? 1.0f : 0.0f});
            break;
        case Op::Or:
            set(i, {f(i->args[0]) != 0 || f(i->args[1]) != 0 ? 1.0f : 0.0f});
            break;
        case Op::Not:
            set(i, {f(i->args[0]) != 0 ? 0.0f : 1.0f});
            break;
        case Op::ToFloat:
            set(i, {f(i->args[0])});
            break;
        default:
            break;
        }
    }

    void runtime(const Inst* i) {
        std::vector<float> in;
        for (const Inst* a : i->args) in.insert(in.end(), get(a).n.begin(), get(a).n.end());
        const std::vector<Kind> kinds = i->results.empty() ? std::vector<Kind>{i->kind} : i->results;
        int total = 0;
        for (Kind kd : kinds) total += components(kd);
        std::vector<float> out(static_cast<size_t>(total));
        if (!evaluateRuntime(i->text, in.data(), static_cast<int>(in.size()), out.data(), total))
            throw std::runtime_error("no runtime " + i->text);
        std::vector<Value> results;
        size_t at = 0;
        for (Kind kd : kinds) {
            const size_t n = static_cast<size_t>(components(kd));
            results.push_back({{out.begin() + static_cast<long>(at), out.begin() + static_cast<long>(at + n)}, {}, nullptr});
            at += n;
        }
        values_[i] = results;
    }

    /// What is sent to lights and rays, and arrays.
    void memory(const Inst* i) {
        const auto arg = [&](size_t a) -> const Value& { return get(i->args[a]); };
        switch (i->op) {
        case Op::Emit: {
            Pair p;
            std::copy_n(arg(0).n.begin(), 3, p.weight);
            p.result = fake(i, 1).at(0).n;
            pairs_.push_back(p);
            break;
        }
        case Op::Mark:
            set(i, {static_cast<float>(pairs_.size())});
            break;
        case Op::Rescale:
            for (size_t p = static_cast<size_t>(f(i->args[0])); p < static_cast<size_t>(f(i->args[2])); ++p)
                for (size_t c = 0; c < 3; ++c) pairs_[p].weight[c] *= arg(1).n[c];
            break;
        case Op::ArrayNew:
            arrays_.push_back(std::make_unique<std::vector<std::vector<float>>>(
                static_cast<size_t>(i->index), std::vector<float>(static_cast<size_t>(components(i->element)))));
            values_[i] = {Value{{}, {}, arrays_.back().get()}};
            break;
        case Op::ArrayLoad:
            set(i, (*arg(0).array)[element(i)]);
            break;
        case Op::ArrayStore:
            (*arg(0).array)[element(i)] = arg(2).n;
            break;
        default:
            break;
        }
    }

    void loop(const Inst* i) {
        std::vector<Value> v;
        for (const Inst* a : i->args) v.push_back(get(a));
        for (;;) {
            for (const Region& r : i->regions)
                for (size_t p = 0; p < v.size(); ++p) values_[r.params[p]] = {v[p]};
            region(i->regions[0]);
            if (f(i->regions[0].yields[0]) == 0) break;
            region(i->regions[1]);
            v = yields(i->regions[1]);
        }
        values_[i] = v;
    }

    void lightLoop(const Inst* i) {
        std::vector<Value> v;
        for (size_t a = 3; a < i->args.size(); ++a) v.push_back(get(i->args[a]));
        const Region& r = i->regions[0];
        for (int light = 0; light < 3; ++light) {
            for (size_t p = 0; p < 3; ++p) {
                std::vector<float> t;
                for (uint64_t c = 0; c < 3; ++c) t.push_back(unit(mix(mix(static_cast<uint64_t>(light), p), c)));
                set(r.params[p], t);
            }
            set(r.params[3], {static_cast<float>(light)});
            for (size_t p = 0; p < v.size(); ++p) values_[r.params[4 + p]] = {v[p]};
            region(r);
            v = yields(r);
        }
        values_[i] = v;
    }

    void inst(const Inst* i) {
        if (++steps > 200000) throw std::runtime_error("too many steps");
        const auto arg = [&](size_t a) -> const Value& { return get(i->args[a]); };
        switch (i->op) {
        case Op::Const:
            set(i, i->numbers);
            break;
        case Op::ConstString:
            values_[i] = {Value{{}, i->text, nullptr}};
            break;
        case Op::Input:
        case Op::ArrayInput:
            input(i);
            break;
        case Op::RegionParam:
        case Op::Result:
            break;
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
        case Op::Neg:
        case Op::Du:
        case Op::Dv:
        case Op::Splat:
        case Op::Triple:
        case Op::MatrixOf:
        case Op::Extract:
            arithmetic(i);
            break;
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
        case Op::NotEqual:
        case Op::And:
        case Op::Or:
        case Op::Not:
        case Op::ToFloat:
            truth(i);
            break;
        case Op::Select:
            values_[i] = {f(i->args[0]) != 0 ? arg(1) : arg(2)};
            break;
        case Op::Runtime:
            runtime(i);
            break;
        case Op::Service:
        case Op::Request:
            values_[i] = fake(i, 0);
            break;
        case Op::Emit:
        case Op::Mark:
        case Op::Rescale:
        case Op::ArrayNew:
        case Op::ArrayLoad:
        case Op::ArrayStore:
            memory(i);
            break;
        case Op::If: {
            const Region& r = i->regions[f(i->args[0]) != 0 ? 0 : 1];
            region(r);
            values_[i] = yields(r);
            break;
        }
        case Op::Loop:
            loop(i);
            break;
        case Op::LightLoop:
            lightLoop(i);
            break;
        case Op::Function: // this evaluator runs kernels whose functions are inlined
        case Op::Call:
            throw std::runtime_error("an outlined function");
        case Op::Output:
            outputs[k_.outputs[static_cast<size_t>(i->index)].name] = arg(0).n;
            break;
        }
    }
};

} // namespace alpenglow::rsl::ir
