// User functions that are called instead of inlined. A function is built once, with its parameters and the variables that it
// reads from outside as region parameters; passes/outline.h then decides whether its calls stay calls. Constant strings (names of
// spaces, bases of splines) are bound, not passed: what they mean is decided here. A function that needs services, rays or lights
// is inlined: those belong to places in the shader.
#include "rsl/front/visit.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <unordered_set>

namespace alpenglow::rsl::ir {

void Builder::include(const Function& f, Scan& to) {
    const Scan& s = scan(f);
    to.callFacts.size += s.callFacts.size;
    to.callFacts.possible = to.callFacts.possible && s.callFacts.possible;
    to.used.insert(s.used.begin(), s.used.end());
    to.own.insert(s.own.begin(), s.own.end());
}

void Builder::scan(const Expr& e, Scan& to) {
    to.callFacts.size += 1;
    if (e.symbol) to.used.insert(e.symbol);
    if (e.function) include(*e.function, to);
    if (e.shadeop && (e.shadeop->name == "outputchannel" || e.shadeop->name == "writeaov" || e.shadeop->name == "readaov" ||
                      e.shadeop->name == "evalparam"))
        to.callFacts.possible = false;
    if (e.kind == ExprKind::Method || e.kind == ExprKind::Member) to.callFacts.possible = false;
    if (e.shadeop && !e.function) {
        const Lowering l = e.shadeop->lowering;
        to.callFacts.possible =
            to.callFacts.possible && (l == Lowering::Runtime || l == Lowering::Special) && e.shadeop->name != "random";
    }
    front::eachPart(e, [&](const Expr& x) { scan(x, to); });
}

void Builder::scan(const Stmt& s, Scan& to) {
    to.callFacts.size += 1;
    if (s.kind == StmtKind::Illuminance || s.kind == StmtKind::Illuminate || s.kind == StmtKind::Solar ||
        s.kind == StmtKind::Gather)
        to.callFacts.possible = false;
    for (const Stmt::Declarator& d : s.declarators) to.own.insert(d.symbol);
    front::eachPart(s, [&](const Expr& x) { scan(x, to); });
    front::eachBody(s, [&](const StmtPtr& b) { scan(*b, to); });
}

const Builder::Scan& Builder::scan(const Function& f) {
    const auto [it, fresh] = scans_.try_emplace(&f);
    Scan& s = it->second; // a function that calls itself (an error elsewhere) finds itself empty
    if (!fresh) return s;
    for (const Symbol* p : f.parameters) s.own.insert(p);
    if (f.body) scan(*f.body, s);
    return s;
}

const Builder::CallFacts& Builder::callFacts(const Function& f) {
    const auto [it, fresh] = callFacts_.try_emplace(&f);
    CallFacts& v = it->second;
    if (!fresh) return v;
    const Scan& s = scan(f);
    v = s.callFacts;
    std::set<int> assigned;
    std::set<const Function*> seen;
    if (f.body) scanAssigned(*f.body, assigned, seen);
    for (const Symbol* x : s.used) {
        if (s.own.count(x)) continue;
        const int n = slot(x);
        // What no one sets is the same everywhere. L, Cl and Ol change from light to light.
        const bool fromShader = std::any_of(shader_.parameters.begin(), shader_.parameters.end(),
                                            [&](const ShaderParameter& p) { return p.symbol == x; });
        const bool fixed = !assignedAnywhere_.count(n) && (x->origin == Symbol::Origin::Global || fromShader) && x->name != "L" &&
                           x->name != "Cl" && x->name != "Ol";
        if (!fixed) v.free.insert(n);
        if (assigned.count(n)) v.assigned.insert(n);
    }
    // filterstep() reads these without naming them.
    for (const char* name : {"du", "dv"})
        if (const auto g = globals_.find(name); g != globals_.end() && assignedAnywhere_.count(g->second)) v.possible = false;
    return v;
}

/// Nothing but leaves and functions is used from outside, and nothing has an effect.
bool Builder::selfContained(const Region& region) const {
    std::unordered_set<const Inst*> own;
    bool good = true;
    const std::function<void(const Region&)> walk = [&](const Region& r) {
        const auto use = [&](const Inst* x) { good = good && (own.count(x) || isLeaf(x) || x->op == Op::Function); };
        own.insert(r.params.begin(), r.params.end());
        for (const Inst* i : r.body) {
            for (const Inst* a : i->args) use(a);
            good = good && i->op != Op::Service && i->op != Op::Request && i->op != Op::LightLoop && i->op != Op::Output;
            for (const Region& sub : i->regions) walk(sub);
            own.insert(i);
        }
        for (const Inst* y : r.yields) use(y);
    };
    walk(region);
    return good;
}

bool Builder::makeFunction(const Function& f, const std::vector<Inst*>& values, const CallFacts& about, Outlined& out) {
    const Environment around = environment();
    const size_t sites = k_.sites.size();
    Inst* function = k_.make(Op::Function, Kind::None);
    function->text = f.name;
    function->place = keptPlace(f.place);
    function->regions.resize(1);
    Region& body = function->regions[0];
    region_ = &body;
    bool good = true;
    const auto bind = [&](int n, Inst* v) {
        if (v->op == Op::ConstString) {
            value(n) = v;
            return false;
        }
        Inst* p = parameter(body, v->kind);
        p->place = keptPlace(f.place);
        value(n) = p;
        return true;
    };
    for (size_t i = 0; i < values.size(); ++i) bind(slot(f.parameters[i]), values[i]);
    for (int n : about.free) {
        Inst* v = get(n);
        if (v->kind == Kind::Array) good = good && v->op == Op::ArrayInput; // known everywhere, and never stored to
        else if (bind(n, v)) out.inputs.push_back(n);
    }
    if (good) {
        Frame frame;
        frame.function = &f;
        frame.type = f.result;
        frame.returned = newSlot(boolean(false));
        if (f.result.base != Base::Void) frame.result = newSlot(zero(kindOf(f.result)));
        frames_.push_back(frame);
        const bool uniform = uniformContext_;
        uniformContext_ = false;
        if (f.body) statement(*f.body);
        uniformContext_ = uniform;
        frames_.pop_back();
        if (frame.result >= 0) body.yields.push_back(get(frame.result));
        for (const Symbol* p : f.parameters)
            if (p->output) body.yields.push_back(get(slot(p)));
        for (int n : about.assigned) {
            out.assigned.push_back(n);
            body.yields.push_back(get(n));
        }
    }
    goBackTo(around);
    for (const Inst* y : body.yields) good = good && y->kind != Kind::Array;
    if (!good || failed_ || body.yields.empty() || !selfContained(body)) {
        k_.sites.resize(sites);
        out = {};
        return false;
    }
    out.function = function;
    functions_.push_back(function);
    return true;
}

/// The call as a Call; false when the function must, or had better, be inlined.
bool Builder::outlined(const Function& f, const std::vector<Inst*>& values, Inst*& result, std::vector<Inst*>& outputs) {
    if (handleDepth_ > 0) return false; // its variables are those of one co-shader among several
    const CallFacts& about = callFacts(f);
    if (!about.possible || about.size <= options_.outline || kindOf(f.result) == Kind::Array) return false;
    std::string key;
    const auto string = [&](const Inst* v) {
        key += v->op == Op::ConstString ? v->text : "\1";
        key += '\0';
    };
    for (const Inst* v : values) {
        if (v->kind == Kind::Array) return false;
        if (v->kind == Kind::String) string(v);
    }
    for (int n : about.free)
        if (const Inst* v = get(n); v->kind == Kind::String) string(v);
    const auto [it, fresh] = outlined_.try_emplace({&f, key});
    if (fresh) {
        Outlined made;
        makeFunction(f, values, about, made);
        outlined_[{&f, key}] = std::move(made);
    }
    const Outlined& o = outlined_[{&f, key}];
    if (!o.function || failed_) return false;
    std::vector<Inst*> args = {o.function};
    for (Inst* v : values)
        if (v->op != Op::ConstString) args.push_back(v);
    for (int n : o.inputs) args.push_back(get(n));
    Inst* call = k_.make(Op::Call, Kind::None, std::move(args));
    call->place = keptPlace(place_);
    for (const Inst* y : o.function->regions[0].yields) call->results.push_back(y->kind);
    region_->body.push_back(call);
    std::vector<Inst*> r;
    for (size_t n = 0; n < call->results.size(); ++n)
        r.push_back(emit(Op::Result, call->results[n], {call}, static_cast<int>(n)));
    size_t next = 0;
    result = f.result.base != Base::Void ? r[next++] : constant(0);
    for (const Symbol* p : f.parameters)
        if (p->output) outputs.push_back(r[next++]);
    for (int n : o.assigned) set(n, r[next++]);
    return true;
}

} // namespace alpenglow::rsl::ir
