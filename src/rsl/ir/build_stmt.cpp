// Statements: assignments become values, jumps become guards.
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <limits>

namespace alpenglow::rsl::ir {

Inst* Builder::alive() {
    const Frame& f = frames_.back();
    Inst* dead = nullptr;
    if (!f.loops.empty()) dead = emit(Op::Or, Kind::Bool, {get(f.loops.back().broken), get(f.loops.back().continued)});
    else if (f.returned >= 0) dead = get(f.returned);
    return dead ? emit(Op::Not, Kind::Bool, {dead}) : boolean(true);
}

// Whether the variables that these statements declare can be carried out of a condition without a change of what is known about
// them.
static bool plainDeclarations(const std::vector<StmtPtr>& list, size_t from) {
    return std::all_of(list.begin() + static_cast<ptrdiff_t>(from), list.end(), [](const StmtPtr& s) {
        return !s->definition && std::all_of(s->declarators.begin(), s->declarators.end(), [](const Stmt::Declarator& d) {
            return d.symbol->type.array == 0 && !isStringLike(d.symbol->type.base) && d.symbol->storage != Storage::Uniform;
        });
    });
}

/// Behind a statement that may have left the function or the turn of the loop, the rest stands in a condition; behind the next
/// such statement in a condition inside of that. That deep nesting costs time that grows with its square, so after kGuards of
/// them all conditions are closed (`depth` counts them) and the next begins outside. Returns how far the list was built.
size_t Builder::statements(const std::vector<StmtPtr>& list, size_t from, int depth) {
    constexpr int kGuards = 128, kPart = 4;
    for (size_t n = from; n < list.size() && !failed_;) {
        Inst* live = alive();
        if (isConst(live)) {
            if (live->numbers[0] == 0) return list.size();
            statement(*list[n++]);
            continue;
        }
        if (depth == kPart) return n;
        const bool divides = depth == 0 && list.size() - n > kGuards && plainDeclarations(list, n);
        if (divides) // what one part declares the next one reads
            for (size_t later = n; later < list.size(); ++later)
                for (const Stmt::Declarator& d : list[later]->declarators) set(slot(d.symbol), zero(kindOf(d.symbol->type)));
        size_t reached = list.size();
        when(live, [&] {
            // Inside, the flags are known to be off: no further guards until one is set again.
            Frame& f = frames_.back();
            if (!f.loops.empty()) {
                set(f.loops.back().broken, boolean(false));
                set(f.loops.back().continued, boolean(false));
            } else {
                set(f.returned, boolean(false));
            }
            const int inside = divides ? 1 : depth == 0 ? std::numeric_limits<int>::min() : depth + 1;
            reached = statements(list, n, inside);
        });
        if (depth != 0) return reached;
        n = reached;
    }
    return list.size();
}

void Builder::declare(const Stmt& s) {
    for (const Stmt::Declarator& d : s.declarators) {
        const int n = slot(d.symbol);
        if (d.symbol->type.array) {
            int length = d.symbol->type.array;
            if (length < 0)
                length = d.init && d.init->kind == ExprKind::ArrayList ? static_cast<int>(d.init->args.size())
                         : d.init                                      ? d.init->type.array
                                                                       : 0;
            Inst* a;
            if (grows(d)) {
                a = newResizable(d.symbol->type.base, 0);
                if (d.init) copyResizable(a, *d.init);
            } else {
                a = newArray(d.symbol->type.base, std::max(length, 1));
                if (d.init) copyArray(a, *d.init);
            }
            set(n, a);
        } else {
            uniformContext_ = d.symbol->storage == Storage::Uniform;
            set(n, d.init ? expr(*d.init, kindOf(d.symbol->type)) : zero(kindOf(d.symbol->type)));
            uniformContext_ = false;
        }
    }
}

void Builder::statement(const Stmt& s) {
    if (failed_) return;
    if (s.place.line) place_ = s.place;
    Frame& f = frames_.back();
    switch (s.kind) {
    case StmtKind::Block:
        statements(s.body, 0);
        return;
    case StmtKind::Declare:
        declare(s);
        return;
    case StmtKind::Expression:
        if (s.value) expr(*s.value);
        return;
    case StmtKind::If: {
        Inst* c = condition(*s.condition);
        when(
            c, [&] { statements(s.body, 0); },
            [&] {
                if (s.elseBody) statement(*s.elseBody);
            });
        return;
    }
    case StmtKind::While:
        loop(s.condition.get(), nullptr, s.body.empty() ? nullptr : s.body[0].get(), s.place);
        return;
    case StmtKind::For:
        if (s.init) expr(*s.init);
        loop(s.condition.get(), s.step.get(), s.body.empty() ? nullptr : s.body[0].get(), s.place);
        return;
    case StmtKind::Break:
    case StmtKind::Continue: {
        const size_t depth = f.loops.size();
        const size_t levels = std::min<size_t>(static_cast<size_t>(std::max(s.levels, 1)), depth);
        for (size_t n = 0; n < levels; ++n) {
            const LoopFrame& l = f.loops[depth - 1 - n];
            set(s.kind == StmtKind::Continue && n + 1 == levels ? l.continued : l.broken, boolean(true));
        }
        return;
    }
    case StmtKind::Return:
        if (s.value && f.array && lengths(f.array)) copyResizable(f.array, *s.value);
        else if (s.value && f.array) copyArray(f.array, *s.value);
        else if (s.value && f.result >= 0) set(f.result, expr(*s.value, kindOf(f.type)));
        if (f.returned >= 0) set(f.returned, boolean(true));
        for (const LoopFrame& l : f.loops) set(l.broken, boolean(true));
        return;
    case StmtKind::Illuminance:
        illuminance(s);
        return;
    case StmtKind::Illuminate:
    case StmtKind::Solar:
        lightBlock(s);
        return;
    case StmtKind::Gather:
        gather(s);
        return;
    }
}

namespace {

/// Whether the statement may jump: any break, continue or return below it, functions excluded.
bool mayJump(const Stmt& s) {
    bool found = s.kind == StmtKind::Break || s.kind == StmtKind::Continue || s.kind == StmtKind::Return;
    front::eachBody(s, [&](const StmtPtr& b) { found = found || mayJump(*b); });
    return found;
}

} // namespace

void Builder::loop(const Expr* cond, const Expr* step, const Stmt* body, const Place& place) {
    std::set<int> assigned;
    std::set<const Function*> seen;
    if (body) scanAssigned(*body, assigned, seen);
    if (step) scanAssigned(*step, assigned, seen);
    bool simple = true;
    if (cond) {
        simple = !hasEffects(*cond);
        scanAssigned(*cond, assigned, seen);
    }
    Turns t;
    // Without a value of its own it lives in the branch around this loop only: what is first set here is no change to merge
    // there.
    const int go = simple ? -1 : newSlot(nullptr);
    t.begin = [&] {
        if (go >= 0) set(go, condition(*cond)), assigned.insert(go);
    };
    t.goesOn = [&] { return go >= 0 ? get(go) : cond ? condition(*cond) : boolean(true); };
    t.turn = [&] {
        if (body) statement(*body);
    };
    if (step || go >= 0)
        t.next = [&] {
            if (step) expr(*step);
            if (go >= 0) set(go, condition(*cond));
        };
    turns(assigned, body && mayJump(*body), t, place);
}

bool Builder::jumps(const Stmt& s) { return mayJump(s); }

void Builder::turns(std::set<int>& assigned, bool jumps, const Turns& t, const Place& place) {
    Frame& f = frames_.back();
    addLengths(assigned);
    if (jumps) { // flags of loops around, too: break 2, return
        for (const LoopFrame& l : f.loops) {
            assigned.insert(l.broken);
            assigned.insert(l.continued);
        }
        if (f.returned >= 0) assigned.insert(f.returned);
        if (f.result >= 0) assigned.insert(f.result);
    }
    const LoopFrame flags{newSlot(boolean(false)), newSlot(boolean(false))};
    if (t.begin) t.begin();
    if (jumps) assigned.insert(flags.broken);

    Inst* inst = k_.make(Op::Loop, Kind::None);
    inst->place = keptPlace(place);
    inst->regions.resize(2);
    const std::vector<int> carried = carry(inst, assigned);
    {
        Region& r = inst->regions[0];
        const Scope scope(*this, r);
        enterTurn(inst, r, carried);
        Inst* test = t.goesOn();
        r.yields.push_back(emit(Op::And, Kind::Bool, {emit(Op::Not, Kind::Bool, {get(flags.broken)}), test}));
    }
    {
        Region& r = inst->regions[1];
        const Scope scope(*this, r);
        enterTurn(inst, r, carried);
        frames_.back().loops.push_back(flags);
        set(flags.continued, boolean(false));
        t.turn();
        frames_.back().loops.pop_back();
        if (t.next) when(emit(Op::Not, Kind::Bool, {get(flags.broken)}), t.next);
        for (int n : carried) r.yields.push_back(get(n));
    }
    leaveLoop(inst, carried);
}

/// Outputs of the kernel that a call sets by their names.
void Builder::scanChannels(const Expr& call, std::set<int>& out) {
    const std::string& op = call.shadeop->name;
    if (op == "subsurface")
        for (const int n : enteringSlots()) out.insert(n);
    if (op != "outputchannel" && op != "writeaov") return;
    if (call.args[0]->kind == ExprKind::String) {
        if (const int n = channelSlot(call.args[0]->text, call.args[1]->type); n >= 0) out.insert(n);
        return;
    }
    // The name is known when the call is built: any of them.
    for (const auto& [name, channel] : channels_) out.insert(channel.first);
    for (const ShaderParameter& p : shader_.parameters)
        if (p.symbol->output && !p.symbol->type.array) out.insert(slot(p.symbol));
}

void Builder::scanAssigned(const Expr& e, std::set<int>& out, std::set<const Function*>& seen) {
    const auto written = [&](const Expr& place) {
        if (const Symbol* s = front::rootOf(place)) out.insert(slot(s));
    };
    if (e.kind == ExprKind::Method) {
        for (size_t n = 1; n < e.args.size(); ++n)
            if (mayFill(e, n)) written(*e.args[n]);
        scanMethod(e, out);
    } else {
        front::eachWritten(e, written);
    }
    if (e.kind == ExprKind::ShadeopCall && e.shadeop) scanChannels(e, out);
    if (e.function && seen.insert(e.function).second && e.function->body) scanAssigned(*e.function->body, out, seen);
    front::eachPart(e, [&](const Expr& x) { scanAssigned(x, out, seen); });
}

void Builder::scanAssigned(const Stmt& s, std::set<int>& out, std::set<const Function*>& seen) {
    // Inner statements first: slots are numbered in this order.
    front::eachBody(s, [&](const StmtPtr& b) { scanAssigned(*b, out, seen); });
    front::eachPart(s, [&](const Expr& e) { scanAssigned(e, out, seen); });
    front::eachWritten(s, [&](const Expr& place) {
        if (place.kind == ExprKind::Variable && place.symbol) out.insert(slot(place.symbol));
    });
    for (const LightBlock& b : lightBlocks_)
        if (b.stmt == &s) out.insert({b.L, b.Cl, b.Ol, b.lit});
}

bool Builder::hasEffects(const Expr& e) {
    if (e.kind == ExprKind::Assign || e.kind == ExprKind::FunctionCall || e.kind == ExprKind::Method || e.function) return true;
    if (e.kind == ExprKind::ShadeopCall && (!e.shadeop || e.shadeop->lowering != Lowering::Runtime)) return true;
    bool found = false;
    front::eachWritten(e, [&](const Expr&) { found = true; });
    front::eachPart(e, [&](const Expr& x) { found = found || hasEffects(x); });
    return found;
}

} // namespace alpenglow::rsl::ir
