#include "rsl/ir/print.h"
#include <fmt/format.h>
#include <unordered_map>

namespace alpenglow::rsl::ir {
namespace {

const char* text(Kind k) {
    static const char* const names[] = {"none", "bool", "float", "triple", "matrix", "string", "array"};
    return names[static_cast<int>(k)];
}

struct Printer {
    const Kernel& k;
    std::string out;
    std::unordered_map<const Inst*, int> numbers;

    std::string ref(const Inst* i) {
        const auto [it, fresh] = numbers.try_emplace(i, static_cast<int>(numbers.size()) + 1);
        return fmt::format("%{}", it->second);
    }

    std::string list(const std::vector<Inst*>& v) {
        std::string s;
        for (const Inst* i : v) s += (s.empty() ? "" : ", ") + ref(i);
        return s;
    }

    static std::string flags(const Inst* i) { return i->order == 0 ? "" : i->order == 1 ? "'" : "''"; }

    void line(int depth, const std::string& s) { out += std::string(static_cast<size_t>(depth) * 4, ' ') + s + "\n"; }

    void region(const Region& r, int depth, const char* label) {
        if (*label || !r.params.empty()) {
            std::string params;
            for (const Inst* p : r.params) params += (params.empty() ? "" : ", ") + ref(p) + " " + text(p->kind) + flags(p);
            line(depth, fmt::format("{}({}) {{", label, params));
            ++depth;
        }
        for (const Inst* i : r.body) inst(i, depth);
        if (!r.yields.empty()) line(depth, "yield " + list(r.yields));
        if (*label || !r.params.empty()) line(depth - 1, "}");
    }

    void inst(const Inst* i, int depth) {
        std::string s;
        if (i->kind != Kind::None) s = fmt::format("{} {}{} = ", ref(i), text(i->kind), flags(i));
        else if (!i->results.empty()) {
            s = ref(i) + " (";
            for (size_t r = 0; r < i->results.size(); ++r) s += std::string(r ? ", " : "") + text(i->results[r]);
            s += ") = ";
        }
        s += name(i->op);
        switch (i->op) {
        case Op::Const:
            for (float f : i->numbers) s += fmt::format(" {}", f);
            break;
        case Op::ConstString:
            s += fmt::format(" \"{}\"", i->text);
            break;
        case Op::Input:
        case Op::ArrayInput:
            s += " " + k.inputs[static_cast<size_t>(i->index)].name;
            break;
        case Op::Output:
            s += " " + k.outputs[static_cast<size_t>(i->index)].name;
            break;
        case Op::Runtime:
        case Op::Function:
            s += " " + i->text;
            break;
        case Op::Service:
        case Op::Request:
        case Op::Emit:
        case Op::LightLoop:
            s += fmt::format(" {}#{}", k.sites[static_cast<size_t>(i->site)].op, i->site);
            break;
        case Op::Result:
        case Op::Extract:
            s += fmt::format("[{}]", i->index);
            break;
        case Op::ArrayNew:
            s += fmt::format("[{}] of {}", i->index, text(i->element));
            break;
        default:
            break;
        }
        if (!i->args.empty()) s += " " + list(i->args);
        line(depth, s);
        static const char* const labels[][2] = {{"then", "else"}, {"while", "do"}, {"do", ""}, {"body", ""}};
        for (size_t r = 0; r < i->regions.size(); ++r)
            region(i->regions[r], depth + 1,
                   labels[i->op == Op::If         ? 0
                          : i->op == Op::Loop     ? 1
                          : i->op == Op::Function ? 3
                                                  : 2][r]);
    }
};

} // namespace

std::string print(const Kernel& k) {
    Printer p{k, {}, {}};
    p.out = fmt::format("kernel {} {}\n", toString(k.kind), k.name);
    for (const Input& i : k.inputs)
        p.out += fmt::format("input {} {}{}{}{}\n", i.name, text(i.kind), i.array ? fmt::format("[{}]", i.array) : "",
                             i.uniform ? " uniform" : "", i.order ? fmt::format(" order {}", i.order) : "");
    p.region(k.body, 0, "");
    return p.out;
}

} // namespace alpenglow::rsl::ir
