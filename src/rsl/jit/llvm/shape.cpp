#include "rsl/jit/llvm/shape.h"
#include <algorithm>
#include <functional>

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using ir::Op;

namespace {

int resultCount(const Inst* i) { return i->results.empty() ? 1 : int(i->results.size()); }

bool differentiable(Kind k) { return k == Kind::Float || k == Kind::Triple || k == Kind::Matrix || k == Kind::Array; }

// Parts of a product: first parts of either factor; second parts also where both factors have the first parts.
uint8_t productParts(uint8_t x, uint8_t y) {
    uint8_t p = x | y;
    if ((x & kDu) && (y & kDu)) p |= kDuu;
    if (((x & kDu) && (y & kDv)) || ((x & kDv) && (y & kDu))) p |= kDuv;
    if ((x & kDv) && (y & kDv)) p |= kDvv;
    return p;
}

} // namespace

Shapes::Shapes(const ir::Kernel& k, bool mixed, const std::set<std::string>* zero, Cache* cacheOfAll)
    : kernel_(k), mixed_(mixed), zero_(zero), cache_(cacheOfAll) {}

const Shapes& Shapes::function(const Inst* f, const std::vector<Shape>& arguments) const {
    std::vector<uint16_t> key;
    for (Shape s : arguments) key.push_back(uint16_t(s.parts | (s.varying ? 256 : 0)));
    if (const auto it = cache_->find({f, key}); it != cache_->end()) return *it->second;
    std::unique_ptr<Shapes> s(new Shapes(kernel_, mixed_, zero_, cache_));
    const ir::Region& body = f->regions[0];
    for (const Inst* i : kernel_.body.body) {
        if (i->op != Op::Const && i->op != Op::ConstString && i->op != Op::Input && i->op != Op::ArrayInput) break;
        s->inst(i, false);
    }
    s->collect(body);
    for (size_t p = 0; p < arguments.size(); p++) s->join(body.params[p], 0, arguments[p]);
    while (s->region(body, false)) {}
    return *(cache_->emplace(std::make_pair(f, key), std::move(s)).first->second);
}

Shapes::Shapes(const ir::Kernel& k, bool mixed, const std::set<std::string>* zero)
    : kernel_(k), mixed_(mixed), zero_(zero), own_(std::make_unique<Cache>()), cache_(own_.get()) {
    collect(k.body);
    while (region(k.body, false)) {}
}

std::vector<Shape>& Shapes::slots(const Inst* i) {
    auto& s = shapes_[i];
    if (s.empty()) s.resize(resultCount(i));
    return s;
}

bool Shapes::join(const Inst* i, int index, Shape s) {
    auto& v = slots(i);
    if (index >= int(v.size())) return false;
    s.parts &= partsOfOrder(order(i, index));
    return v[index].join(s);
}

Shape Shapes::of(const Inst* i, int index) const {
    auto it = shapes_.find(i);
    return it == shapes_.end() || index >= int(it->second.size()) ? Shape{} : it->second[index];
}

int Shapes::order(const Inst* i, int index) const {
    auto it = orders_.find(i);
    if (it == orders_.end() || index >= int(it->second.size())) return i->order;
    return std::max<int>(it->second[index], i->order);
}

void Shapes::collect(const ir::Region& r) {
    for (const Inst* i : r.body) {
        if (i->op == Op::Result && !i->args.empty()) {
            used_.insert({i->args[0], i->index});
            auto& o = orders_[i->args[0]];
            o.resize(std::max<size_t>(o.size(), size_t(std::max(i->index + 1, resultCount(i->args[0])))));
            if (i->index >= 0) o[i->index] = std::max(o[i->index], i->order);
        }
        if (i->op == Op::Request) requests_ = true;
        if (i->op == Op::Function) continue; // for each call's arguments: function()
        for (const auto& sub : i->regions) collect(sub);
    }
}

int Shapes::callOrder(const Inst* i) const {
    if (zero_ && zero_->count(i->text)) return 0;
    bool any = false;
    for (const Inst* a : i->args) any |= of(a).parts != 0;
    if (!any) return 0;
    int order = i->order;
    for (int k = 0; k < resultCount(i); k++) order = std::max(order, this->order(i, k));
    return std::min(order, 2);
}

bool Shapes::region(const ir::Region& r, bool varyingControl) {
    bool changed = false;
    for (const Inst* i : r.body) changed |= inst(i, varyingControl);
    return changed;
}

bool Shapes::loop(const Inst* i, bool varyingControl) {
    bool changed = false;
    const bool light = i->op == Op::LightLoop;
    const int skip = light ? 3 : 0, fixed = light ? 4 : 0;
    const ir::Region& body = i->regions[light ? 0 : 1];
    const int count = int(body.yields.size());
    const bool varyingExit = light || (!i->regions[0].yields.empty() && of(i->regions[0].yields[0]).varying);
    if (light)
        for (int k = 0; k < 3 && k < int(body.params.size()); k++) changed |= join(body.params[k], 0, {true, 0});
    for (int k = 0; k < count; k++) {
        Shape s = of(i->args[skip + k]);
        const Inst* next = body.yields[k];
        s.join(of(next));
        if (varyingExit && next != body.params[fixed + k]) s.varying = true;
        // One storage: the parameters of both regions and the result.
        int order = std::max<int>(body.params[fixed + k]->order, this->order(i, k));
        if (!light) order = std::max<int>(order, i->regions[0].params[k]->order);
        s.parts &= partsOfOrder(order);
        for (const Inst* p : {body.params[fixed + k], light ? body.params[fixed + k] : i->regions[0].params[k]}) {
            auto& o = orders_[p];
            if (o.empty()) o.resize(1);
            o[0] = std::max<uint8_t>(o[0], uint8_t(order));
            changed |= join(p, 0, s);
        }
        auto& o = orders_[i];
        o.resize(std::max<size_t>(o.size(), resultCount(i)));
        if (k < int(o.size())) o[k] = std::max<uint8_t>(o[k], uint8_t(order));
        changed |= join(i, k, s);
    }
    for (const auto& r : i->regions) changed |= region(r, varyingControl || varyingExit);
    return changed;
}

bool Shapes::input(const Inst* i) {
    const ir::Input& in = kernel_.inputs[i->index];
    const bool jets = !in.uniform && i->op == Op::Input && (in.kind == Kind::Float || in.kind == Kind::Triple);
    // Derivatives are taken by u and v: (1, 0) and (0, 1), second ones zero. Their footprints are inputs.
    uint8_t parts = jets ? partsOfOrder(in.order) : uint8_t(0);
    if (in.name == "u") parts &= kDu;
    else if (in.name == "v") parts &= kDv;
    else if (in.name == "du" || in.name == "dv") parts = 0;
    return join(i, 0, {!in.uniform || mixed_, parts});
}

bool Shapes::everyResult(const Inst* i, Shape s) {
    bool changed = false;
    for (int k = 0; k < resultCount(i); k++) changed |= join(i, k, s);
    return changed;
}

bool Shapes::call(const Inst* i) {
    std::vector<Shape> arguments;
    for (size_t a = 1; a < i->args.size(); a++) {
        Shape x = of(i->args[a]);
        x.parts &= partsOfOrder(i->args[0]->regions[0].params[a - 1]->order);
        arguments.push_back(x);
    }
    const Shapes& body = function(i->args[0], arguments);
    bool changed = false;
    for (int k = 0; k < resultCount(i); k++) changed |= join(i, k, body.of(i->args[0]->regions[0].yields[size_t(k)]));
    return changed;
}

bool Shapes::branch(const Inst* i, bool varyingControl) {
    const bool varying = of(i->args[0]).varying;
    bool changed = false;
    for (const auto& r : i->regions) changed |= region(r, varyingControl || varying);
    for (int k = 0; k < int(i->regions[0].yields.size()); k++) {
        Shape y{varying, 0};
        y.join(of(i->regions[0].yields[k]));
        if (i->regions.size() > 1 && k < int(i->regions[1].yields.size())) y.join(of(i->regions[1].yields[k]));
        changed |= join(i, k, y);
    }
    return changed;
}

bool Shapes::inst(const Inst* i, bool varyingControl) {
    Shape s;
    auto arg = [&](int k) { return of(i->args[k]); };
    for (const Inst* a : i->args) s.join(of(a));
    switch (i->op) {
    case Op::Const:
    case Op::ConstString:
    case Op::RegionParam:
        return false;
    case Op::Input:
    case Op::ArrayInput:
        return input(i);
    case Op::Result:
        return join(i, 0, of(i->args[0], i->index));
    case Op::Mul:
        s.parts = productParts(arg(0).parts, arg(1).parts);
        return join(i, 0, s);
    case Op::Div:
        s.parts = productParts(productParts(arg(0).parts, arg(1).parts), arg(1).parts);
        return join(i, 0, s);
    case Op::Select:
        s.parts = arg(1).parts | arg(2).parts;
        return join(i, 0, s);
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
    case Op::And:
    case Op::Or:
    case Op::Not:
    case Op::ToFloat:
        s.parts = 0;
        return join(i, 0, s);
    case Op::Runtime:
        return everyResult(i, {s.varying, partsOfOrder(callOrder(i))});
    case Op::Function:
        return false;
    case Op::Call:
        return call(i);
    case Op::Service:
    case Op::Request:
    case Op::Mark:
        return everyResult(i, {true, 0});
    case Op::Du: {
        const uint8_t p = arg(0).parts;
        s.parts = uint8_t(((p & kDuu) ? kDu : 0) | ((p & kDuv) ? kDv : 0));
        return join(i, 0, s);
    }
    case Op::Dv: {
        const uint8_t p = arg(0).parts;
        s.parts = uint8_t(((p & kDuv) ? kDu : 0) | ((p & kDvv) ? kDv : 0));
        return join(i, 0, s);
    }
    case Op::ArrayNew:
        return false;
    case Op::ArrayLoad:
        s.parts = arg(0).parts;
        return join(i, 0, s);
    case Op::ArrayStore: {
        Shape v = arg(2);
        v.varying |= arg(1).varying | varyingControl;
        auto& slot = slots(i->args[0]);
        return slot[0].join(v); // the array keeps every part that is stored
    }
    case Op::If:
        return branch(i, varyingControl);
    case Op::Loop:
    case Op::LightLoop:
        return loop(i, varyingControl);
    case Op::Emit:
    case Op::Rescale:
    case Op::Output:
        return false;
    default: // Add, Sub, Neg, Splat, Triple, Extract, MatrixOf: linear
        return join(i, 0, s);
    }
}

Pressure measure(const ir::Kernel& k, const Shapes& shapes, const std::map<std::string, int>* outOfLine) {
    Pressure p;
    std::unordered_map<const Inst*, int> born, lastUse;
    std::vector<const Inst*> all;
    int time = 0;
    // A use inside a loop of a value born outside keeps it alive to the loop's end.
    std::function<void(const ir::Region&)> walk = [&](const ir::Region& r) {
        auto use = [&](const Inst* a) { lastUse[a] = std::max(lastUse[a], time); };
        for (const Inst* x : r.params) {
            born[x] = time;
            all.push_back(x);
        }
        for (const Inst* i : r.body) {
            time++;
            for (const Inst* a : i->args) use(a);
            if (i->op != Op::Const && i->op != Op::ConstString) {
                p.instructions++;
                born[i] = time;
                all.push_back(i);
            }
            if (i->op == Op::Runtime) {
                p.runtimeCalls++;
                const int order = shapes.callOrder(i);
                const auto large = outOfLine ? outOfLine->find(i->text) : std::map<std::string, int>::const_iterator();
                if (outOfLine && large != outOfLine->end()) {
                    p.widest = std::min(p.widest, large->second);
                    p.outOfLineCalls += order == 0 ? 1 : order == 1 ? 3 : 6;
                    p.wideCalls += order > 0;
                }
            }
            if (i->op == Op::Service || i->op == Op::Emit || i->op == Op::LightLoop || i->op == Op::Request ||
                i->op == Op::ArrayNew)
                p.effects = true;
            if (i->op == Op::Loop || i->op == Op::LightLoop) {
                p.loops = true;
                const int start = time;
                const size_t before = all.size();
                for (const auto& s : i->regions) walk(s);
                time++;
                for (size_t n = 0; n < before; n++)
                    if (auto it = lastUse.find(all[n]); it != lastUse.end() && it->second > start) it->second = time;
            } else {
                for (const auto& s : i->regions) walk(s);
            }
        }
        time++;
        for (const Inst* y : r.yields) use(y);
    };
    walk(k.body);
    std::vector<int> delta(size_t(time) + 2, 0);
    for (const Inst* i : all) {
        auto it = lastUse.find(i);
        if (it == lastUse.end() || i->op == Op::ArrayNew || i->op == Op::ArrayInput) continue;
        const Shape s = shapes.of(i);
        if (!s.varying || !differentiable(i->kind)) continue;
        const int weight = (i->kind == Kind::Triple ? 3 : i->kind == Kind::Matrix ? 16 : 1) * (1 + __builtin_popcount(s.parts));
        // A Triple is usually made of values that are already counted: count it, but do not count its use as an operand twice.
        if (i->op == Op::Triple || i->op == Op::Splat || i->op == Op::Extract || i->op == Op::Result) continue;
        delta[size_t(born[i])] += weight;
        delta[size_t(it->second) + 1] -= weight;
    }
    int live = 0;
    for (int d : delta) p.live = std::max(p.live, live += d);
    return p;
}

} // namespace alpenglow::rsl::jit
