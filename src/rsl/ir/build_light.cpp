// illuminate and solar in lights.
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include "rsl/ir/builder.h"
#include <functional>
#include <set>
#include <utility>

namespace alpenglow::rsl::ir {

int Builder::addBlock(const Stmt& s) {
    LightBlock b{&s, s.kind == StmtKind::Solar, 0, 0, 0, 0};
    b.L = newSlot(zero(Kind::Triple));
    b.Cl = newSlot(zero(Kind::Triple));
    b.Ol = newSlot(leaves_.constant(Kind::Triple, 1.0f));
    b.lit = newSlot(constant(0));
    lightBlocks_.push_back(b);
    return static_cast<int>(lightBlocks_.size()) - 1;
}

/// Blocks of a body and of the functions that it calls, once for each call, in order of the text, up to one more than there may
/// be. `without`: functions that have none, which are not looked into again.
static void blocksOf(const Stmt& s, std::vector<const Stmt*>& found, std::set<const Function*>& without) {
    const auto statement = [&](const Stmt& x) {
        if ((x.kind == StmtKind::Illuminate || x.kind == StmtKind::Solar) && found.size() <= limits::kLightBlocks)
            found.push_back(&x);
    };
    front::everyStmt(s, statement, [&](const Expr& e) {
        if (!e.function || !e.function->body || found.size() > limits::kLightBlocks || without.count(e.function)) return;
        const size_t before = found.size();
        blocksOf(*e.function->body, found, without);
        if (found.size() == before) without.insert(e.function);
    });
}

/// The blocks of the shader, before any is built, so that loops and conditions around them carry their slots.
void Builder::findBlocks(const Stmt& s) {
    std::vector<const Stmt*> found;
    std::set<const Function*> without;
    blocksOf(s, found, without);
    for (const Stmt* b : found) addBlock(*b);
}

/// The angle of a cone: beyond pi it has all directions.
Inst* Builder::within(Inst* angle) {
    Inst* most = constant(3.14159265f);
    return emit(Op::Select, Kind::Float, {emit(Op::Less, Kind::Bool, {most, angle}), most, angle});
}

/// A direction of the cone about `axis`, as long as it. The renderer's numbers (transport: coneNumbers) are three: how far from
/// the axis, evenly over the solid angle, and a unit vector that says which way; zero far is the axis itself.
Inst* Builder::inCone(Inst* axis, Inst* angle) {
    Inst* numbers = input("Ci", {Base::Color, 0}, false);
    const auto part = [&](Inst* v, int n) { return emit(Op::Extract, Kind::Float, {v}, n); };
    const auto times = [&](Inst* v, Inst* k) { return emit(Op::Mul, Kind::Triple, {v, coerce(k, Kind::Triple)}); };
    const auto minus = [&](Inst* a, Inst* b) { return emit(Op::Sub, Kind::Float, {a, b}); };
    const auto product = [&](Inst* a, Inst* b) { return emit(Op::Mul, Kind::Float, {a, b}); };
    Inst* n = runtime1("al_normalize_t", {axis}, Kind::Triple);
    Inst* steep = emit(Op::Less, Kind::Bool, {product(part(n, 0), part(n, 0)), constant(0.5f)});
    Inst* across = emit(Op::Select, Kind::Triple,
                        {steep, leaves_.constant(Kind::Triple, std::vector<float>{1, 0, 0}),
                         leaves_.constant(Kind::Triple, std::vector<float>{0, 1, 0})});
    Inst* t = runtime1("al_normalize_t", {cross(n, across)}, Kind::Triple);
    Inst* u = cross(n, t);
    Inst* half = runtime1("al_sin", {product(within(angle), constant(0.5f))}, Kind::Float);
    Inst* height = product(part(numbers, 0), product(constant(2), product(half, half))); // 1 - cos
    Inst* away = runtime1("al_sqrt", {product(height, minus(constant(2), height))}, Kind::Float);
    Inst* sideways = emit(Op::Add, Kind::Triple, {times(t, part(numbers, 1)), times(u, part(numbers, 2))});
    Inst* unit = emit(Op::Add, Kind::Triple, {times(n, minus(constant(1), height)), times(sideways, away)});
    return times(unit, runtime1("al_length", {axis}, Kind::Float));
}

void Builder::lightBlock(const Stmt& s) {
    int index = -1;
    for (size_t n = 0; n < lightBlocks_.size() && index < 0; ++n)
        if (lightBlocks_[n].stmt == &s && !lightBlocks_[n].built) index = static_cast<int>(n);
    if (lightBlocks_.size() > limits::kLightBlocks || (index < 0 && lightBlocks_.size() == limits::kLightBlocks)) {
        report(s.place, msg::kLightBlocks(limits::kLightBlocks));
        return;
    }
    if (index < 0) index = addBlock(s); // in a method of a co-shader
    lightBlocks_[static_cast<size_t>(index)].built = true;
    const LightBlock b = lightBlocks_[static_cast<size_t>(index)];
    Inst *L, *lit = boolean(true);
    if (s.kind == StmtKind::Solar) {
        // All directions, sampled by the renderer from P.
        L = s.exprs.empty() ? emit(Op::Sub, Kind::Triple, {global("Ps", Base::Point), global("P", Base::Point)})
                            : expr(*s.exprs[0], Kind::Triple);
        if (s.exprs.size() > 1)
            if (Inst* angle = expr(*s.exprs[1], Kind::Float); !isConst(angle) || angle->numbers[0] != 0) {
                place_ = s.place;
                L = inCone(L, angle);
                lightBlocks_[static_cast<size_t>(index)].cone = true;
            }
    } else {
        L = emit(Op::Sub, Kind::Triple,
                 {global("Ps", Base::Point), s.exprs.empty() ? global("P", Base::Point) : expr(*s.exprs[0], Kind::Triple)});
        if (s.exprs.size() > 2) {
            Inst* axis = expr(*s.exprs[1], Kind::Triple);
            Inst* angle = expr(*s.exprs[2], Kind::Float);
            place_ = s.place;
            Inst* lengths =
                emit(Op::Mul, Kind::Float, {runtime1("al_length", {L}, Kind::Float), runtime1("al_length", {axis}, Kind::Float)});
            // -2 for all directions: the product of lengths may round to less than -dot(L, axis).
            Inst* all = emit(Op::LessEqual, Kind::Bool, {constant(3.14159265f), angle});
            Inst* cosine = emit(Op::Select, Kind::Float, {all, constant(-2), runtime1("al_cos", {within(angle)}, Kind::Float)});
            Inst* limit = emit(Op::Mul, Kind::Float, {cosine, lengths});
            lit = emit(Op::LessEqual, Kind::Bool, {limit, dot(L, axis)});
        }
    }
    int slots[3];
    const char* const names[] = {"L", "Cl", "Ol"};
    for (int n = 0; n < 3; ++n) {
        const auto it = globals_.find(names[n]);
        slots[n] = it != globals_.end() ? it->second : (globals_[names[n]] = newSlot(nullptr));
        if (!value(slots[n])) value(slots[n]) = leaves_.constant(Kind::Triple, n == 2 ? 1.0f : 0.0f);
    }
    Inst* before[3];
    for (int n = 0; n < 3; ++n) before[n] = get(slots[n]);
    const int litSlot = newSlot(constant(0));
    set(b.L, L);
    const bool outer = std::exchange(inSolar_, s.kind == StmtKind::Solar);
    ++blockDepth_;
    when(lit, [&] {
        set(slots[0], L); // Cl and Ol are as the shader has left them: 0 and 1 at first
        statements(s.body, 0);
        set(litSlot, constant(1));
        set(b.Cl, get(slots[1]));
        set(b.Ol, get(slots[2]));
        set(b.L, get(slots[0])); // the block may have turned it: parallel rays of a projector
    });
    --blockDepth_;
    inSolar_ = outer;
    set(b.lit, get(litSlot));
    for (int n = 0; n < 3; ++n) set(slots[n], before[n]);
    set(blockRan_, boolean(true));
    if (lightBlocks_.size() == 1 && region_ == &k_.body && frames_.size() == 1) { // black outside of the cone
        lightBlocks_[0].only = true;
        set(slots[1], get(b.Cl));
        set(slots[2], get(b.Ol));
    }
}

} // namespace alpenglow::rsl::ir
