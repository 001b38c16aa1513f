#include "rsl/ir/edit.h"
#include <cstring>

namespace alpenglow::rsl::ir {

std::vector<Kind> resultKinds(const Inst& i) {
    if (!i.results.empty()) return i.results;
    if (i.kind == Kind::None) return {};
    return {i.kind};
}

static bool multi(Op op) {
    return op == Op::If || op == Op::Loop || op == Op::LightLoop || op == Op::Runtime || op == Op::Call || op == Op::Service ||
           op == Op::Request;
}

static void longForm(Kernel& k, Region& r, Replacements& rep) {
    std::vector<Inst*> body;
    body.reserve(r.body.size());
    for (Inst* i : r.body) {
        rep.apply(i);
        for (Region& sub : i->regions) longForm(k, sub, rep);
        body.push_back(i);
        if (multi(i->op) && i->kind != Kind::None) {
            Inst* result = k.make(Op::Result, i->kind, {i});
            result->place = i->place;
            result->order = i->order;
            i->results = {i->kind};
            i->kind = Kind::None;
            rep.set(i, result);
            body.push_back(result);
        }
    }
    for (Inst*& y : r.yields) y = rep(y);
    r.body = std::move(body);
}

void toLongForm(Kernel& k) {
    Replacements rep;
    // A Result's own argument must stay the instruction, so single results are only rewritten where they are used: the Result is
    // made after its instruction's arguments were replaced.
    longForm(k, k.body, rep);
}

static void shortForm(Region& r, Replacements& rep) {
    std::vector<Inst*> body;
    body.reserve(r.body.size());
    for (Inst* i : r.body) {
        if (i->op == Op::Result && i->args[0]->results.size() <= 1) {
            Inst* owner = i->args[0];
            owner->kind = i->kind;
            owner->results.clear();
            owner->order = std::max(owner->order, i->order);
            rep.set(i, owner);
            continue;
        }
        rep.apply(i);
        for (Region& sub : i->regions) shortForm(sub, rep);
        if (multi(i->op) && i->results.size() == 1) {
            i->kind = i->results[0];
            i->results.clear();
        }
        body.push_back(i);
    }
    for (Inst*& y : r.yields) y = rep(y);
    r.body = std::move(body);
}

void toShortForm(Kernel& k) {
    Replacements rep;
    shortForm(k.body, rep);
}

void forEach(Region& r, const std::function<void(Inst*)>& f) {
    for (Inst* i : r.body) {
        f(i);
        for (Region& sub : i->regions) forEach(sub, f);
    }
}

void forEach(const Region& r, const std::function<void(const Inst*)>& f) {
    for (const Inst* i : r.body) {
        f(i);
        for (const Region& sub : i->regions) forEach(sub, f);
    }
}

size_t instructionCount(const Region& r) {
    size_t n = r.body.size();
    for (const Inst* i : r.body)
        for (const Region& sub : i->regions) n += instructionCount(sub);
    return n;
}

bool isPure(const Kernel& k, const Inst& i) {
    switch (i.op) {
    case Op::Service:
        return k.sites[i.site].pure;
    case Op::Request:
        return k.sites[i.site].pure;
    case Op::Emit:
    case Op::Mark:
    case Op::Rescale:
    case Op::ArrayStore:
    case Op::Output:
        return false;
    default:
        break;
    }
    for (const Region& r : i.regions)
        for (const Inst* sub : r.body)
            if (!isPure(k, *sub)) return false;
    return true;
}

bool isMovable(const Kernel& k, const Inst& i) {
    if (!i.regions.empty() || i.op == Op::RegionParam || i.op == Op::ArrayNew || i.op == Op::ArrayStore) return false;
    if (i.op == Op::ArrayLoad) return i.args[0]->op == Op::ArrayInput;
    return isPure(k, i);
}

bool isConst(const Inst* inst, float value) {
    if (inst->op != Op::Const) return false;
    for (float f : inst->numbers)
        if (std::memcmp(&f, &value, sizeof f) != 0) return false;
    return true;
}

std::vector<uint32_t> countUses(const Kernel& k) {
    std::vector<uint32_t> n(k.pool.size());
    const std::function<void(const Region&)> walk = [&](const Region& r) {
        for (const Inst* i : r.body) {
            for (const Inst* a : i->args) ++n[a->id];
            for (const Region& sub : i->regions) walk(sub);
        }
        for (const Inst* y : r.yields) ++n[y->id];
    };
    walk(k.body);
    return n;
}

void Replacements::apply(Region& r) {
    for (Inst* i : r.body) {
        apply(i);
        for (Region& sub : i->regions) apply(sub);
    }
    for (Inst*& y : r.yields) y = (*this)(y);
}

Inst* copyInst(Kernel& k, const Inst* from, CopyMap& map) {
    Inst* to = k.make(from->op, from->kind);
    const uint32_t id = to->id;
    *to = *from;
    to->id = id;
    for (Inst*& a : to->args) a = mapped(map, a);
    for (size_t r = 0; r < from->regions.size(); ++r) {
        Region& region = to->regions[r];
        for (Inst*& p : region.params) {
            Inst* old = p;
            p = k.make(old->op, old->kind);
            const uint32_t pid = p->id;
            *p = *old;
            p->id = pid;
            map[old] = p;
        }
        region.body.clear();
        copyBody(k, from->regions[r], map, region.body);
        for (size_t y = 0; y < region.yields.size(); ++y) region.yields[y] = mapped(map, from->regions[r].yields[y]);
    }
    map[from] = to;
    return to;
}

void copyBody(Kernel& k, const Region& r, CopyMap& map, std::vector<Inst*>& out) {
    for (const Inst* i : r.body) out.push_back(copyInst(k, i, map));
}

Inst* Leaves::constant(Kind kind, float value) {
    return constant(kind, std::vector<float>(static_cast<size_t>(components(kind)), value));
}

Inst* Leaves::constant(Kind kind, const std::vector<float>& numbers) {
    std::string key(1, static_cast<char>(kind));
    key.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
    Inst*& c = known_[key];
    if (!c) {
        c = kernel_.make(Op::Const, kind);
        c->numbers = numbers;
        front_.push_back(c);
    }
    return c;
}

Inst* Leaves::string(const std::string& text) {
    Inst*& c = known_["s" + text];
    if (!c) {
        c = kernel_.make(Op::ConstString, Kind::String);
        c->text = text;
        front_.push_back(c);
    }
    return c;
}

void Leaves::flush() {
    kernel_.body.body.insert(kernel_.body.body.begin(), front_.begin(), front_.end());
    front_.clear();
    known_.clear();
}

} // namespace alpenglow::rsl::ir
