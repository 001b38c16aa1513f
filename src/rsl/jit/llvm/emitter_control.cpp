// Conditions and loops: which lanes run, and when a branch is worth skipping.
#include "rsl/jit/llvm/emitter.h"
#include "rsl/kernel.h"
#include <algorithm>
#include <cstddef>

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using ir::Op;
using llvm::BasicBlock;
using llvm::Value;

namespace {

constexpr int kSpeculate = 40;

// Carried values whose truth ends a loop with this condition.
void leavingFlags(const ir::Region& test, const Inst* condition, std::vector<size_t>& flags) {
    if (condition->op == Op::And)
        for (const Inst* a : condition->args) leavingFlags(test, a, flags);
    if (condition->op == Op::Not)
        for (size_t k = 0; k < test.params.size(); k++)
            if (test.params[k] == condition->args[0]) flags.push_back(k);
}

/// Whether other loops may turn inside of a loop.
bool nests(const Inst* loop) {
    for (const ir::Region& r : loop->regions)
        for (const Inst* i : r.body)
            if (i->op == Op::Loop || i->op == Op::Call || nests(i)) return true;
    return false;
}

Kind resultKind(const Inst* i, int index) { return i->results.empty() ? i->kind : i->results[size_t(index)]; }

} // namespace

// Vector instructions, about, of a region that may run for lanes that do not want it; a large number when it may not.
int Emitter::cost(const ir::Region& r) const {
    constexpr int kNever = 1 << 20;
    int sum = 0;
    for (const Inst* i : r.body) {
        switch (i->op) {
        case Op::Const:
        case Op::ConstString:
        case Op::Input:
        case Op::Result:
        case Op::Splat:
        case Op::Triple:
        case Op::Extract:
        case Op::MatrixOf:
        case Op::Du:
        case Op::Dv:
            break;
        case Op::Service:
        case Op::Request:
        case Op::Emit:
        case Op::Mark:
        case Op::Rescale:
        case Op::Loop:
        case Op::LightLoop:
        case Op::Output:
        case Op::ArrayNew:
        case Op::ArrayStore:
        case Op::ArrayLoad:
        case Op::ArrayInput:
        case Op::Call:
            return kNever;
        case Op::Runtime: {
            // The runtime's functions are from one instruction to a few dozen; the large ones are marked.
            if (request_.outOfLine && request_.outOfLine->count(i->text)) return kNever;
            static const char* const kCheap[] = {"al_abs",  "al_min_f",  "al_max_f",   "al_floor", "al_ceil",
                                                 "al_sqrt", "al_step_f", "al_clamp_f", "al_mix_f"};
            const bool cheap = std::any_of(std::begin(kCheap), std::end(kCheap), [&](const char* n) { return i->text == n; });
            sum += (cheap ? 2 : 20) * (shapes_.callOrder(i) == 0 ? 1 : 3);
            break;
        }
        case Op::If:
            for (const auto& sub : i->regions) sum += cost(sub);
            sum += int(i->regions[0].yields.size());
            break;
        default:
            sum += (i->kind == Kind::Triple ? 3 : 1) * (1 + __builtin_popcount(shapes_.of(i).parts));
        }
        if (sum >= kNever) return kNever;
    }
    return sum;
}

void Emitter::emitIf(const Inst* i) {
    Value* cond = value(i->args[0])[0].v;
    const bool varying = cond->getType()->isVectorTy();
    const ir::Region& thenRegion = i->regions[0];
    static const ir::Region kEmpty;
    const ir::Region& elseRegion = i->regions.size() > 1 ? i->regions[1] : kEmpty;
    const size_t count = thenRegion.yields.size();
    auto shapeOf = [&](size_t k) { return shapes_.of(i, int(k)); };
    auto yields = [&](const ir::Region& r) {
        std::vector<Val> v;
        for (size_t k = 0; k < count; k++) v.push_back(conform(value(r.yields[k]), resultKind(i, int(k)), shapeOf(k)));
        return v;
    };
    if (!varying) {
        BasicBlock *t = block("then"), *e = block("else"), *join = block("endif");
        b_.CreateCondBr(cond, t, e);
        b_.SetInsertPoint(t);
        region(thenRegion);
        std::vector<Val> a = yields(thenRegion);
        BasicBlock* tEnd = b_.GetInsertBlock();
        b_.CreateBr(join);
        b_.SetInsertPoint(e);
        region(elseRegion);
        std::vector<Val> c = count ? yields(elseRegion) : std::vector<Val>{};
        BasicBlock* eEnd = b_.GetInsertBlock();
        b_.CreateBr(join);
        b_.SetInsertPoint(join);
        for (size_t k = 0; k < count; k++) {
            Val p = phis(resultKind(i, int(k)), shapeOf(k));
            addIncoming(p, a[k], tEnd);
            addIncoming(p, c[k], eEnd);
            define(i, int(k), std::move(p));
        }
        return;
    }
    // Varying: each side runs when some lane takes it, under its mask. Values of lanes outside never matter, so the results need
    // only the condition; the skipped side gives zeros, not poison, because masks are made of such values.
    Value* outer = mask_;
    const bool outerRoot = rootMask_;
    rootMask_ = false;
    auto side = [&](const ir::Region& r, Value* mask) {
        std::vector<Val> result;
        mask_ = mask;
        // A test and a jump that the processor guesses wrong cost as much as forty instructions.
        if (r.body.empty() || cost(r) <= kSpeculate) {
            region(r);
            return count ? yields(r) : result;
        }
        BasicBlock* from = b_.GetInsertBlock();
        BasicBlock *body = block("side"), *join = block("joined");
        b_.CreateCondBr(any(mask), body, join);
        from = b_.GetInsertBlock();
        b_.SetInsertPoint(body);
        region(r);
        std::vector<Val> v = count ? yields(r) : result;
        BasicBlock* end = b_.GetInsertBlock();
        b_.CreateBr(join);
        b_.SetInsertPoint(join);
        for (size_t k = 0; k < count; k++) {
            // A value from before the branch needs no phi.
            Val p = phis(resultKind(i, int(k)), shapeOf(k));
            addIncoming(p, v[k], end);
            addIncoming(p, zero(resultKind(i, int(k)), shapeOf(k)), from);
            result.push_back(std::move(p));
        }
        return result;
    };
    std::vector<Val> a = side(thenRegion, b_.CreateAnd(outer, cond));
    std::vector<Val> c = side(elseRegion, b_.CreateAnd(outer, b_.CreateNot(cond)));
    mask_ = outer;
    rootMask_ = outerRoot;
    for (size_t k = 0; k < count; k++) define(i, int(k), selectLanes(cond, a[k], c[k]));
}

/// The lanes whose loops have made all the turns that one run of a shader may make.
Value* Emitter::spent() {
    return b_.CreateICmpUGE(b_.CreateLoad(vi_, turns_), lanes(b_.getInt32(limits::kLoopIterations)), "spent");
}

void Emitter::spend(Value* turns, Value* mask) {
    Value* more = b_.CreateSelect(mask, lanes(turns), llvm::Constant::getNullValue(vi_));
    b_.CreateStore(b_.CreateAdd(b_.CreateLoad(vi_, turns_), more), turns_);
}

/// Before a turn of a loop that has loops inside: lanes that have turned too often leave it, from a loop whose control is uniform
/// all at once when each has. The outermost loop says so. Gives the lanes that go on, to which the mask is set.
Value* Emitter::withinTurns(const Inst* loop, bool varying, BasicBlock* exit) {
    Value* before = mask_;
    Value* over = b_.CreateAnd(before, spent());
    Value* left = b_.CreateAnd(before, b_.CreateNot(over));
    BasicBlock *from = b_.GetInsertBlock(), *some = block("spent"), *on = block("within");
    b_.CreateCondBr(varying ? any(over) : b_.CreateNot(any(left)), some, on);
    b_.SetInsertPoint(some);
    if (loops_ == 0) {
        mask_ = over;
        callService(loop->site, nullptr, nullptr);
    }
    BasicBlock* reported = b_.GetInsertBlock();
    if (varying) b_.CreateCondBr(any(left), on, exit);
    else b_.CreateBr(exit);
    b_.SetInsertPoint(on);
    mask_ = before;
    if (varying) {
        auto* going = b_.CreatePHI(vm_, 2, "going");
        going->addIncoming(before, from);
        going->addIncoming(left, reported);
        mask_ = going;
    }
    spend(b_.getInt32(1), mask_);
    return mask_;
}

/// The limit of one loop by itself.
void Emitter::allowTurn(const Inst* loop, Value* turn, BasicBlock* inside, BasicBlock* exit) {
    BasicBlock* endless = block("endless");
    b_.CreateCondBr(b_.CreateICmpULT(turn, b_.getInt32(limits::kLoopIterations)), inside, endless);
    b_.SetInsertPoint(endless);
    callService(loop->site, nullptr, nullptr);
    b_.CreateBr(exit);
}

/// Lanes that left keep their values if these are read later; otherwise the values are undefined.
void Emitter::keepLeft(const Inst* loop, Value* running, const std::vector<Val>& before, std::vector<Val>& next) {
    const ir::Region &test = loop->regions[0], &body = loop->regions[1];
    std::vector<size_t> flags; // set in lanes that leave: `while (!flag && ...)`
    leavingFlags(test, test.yields[0], flags);
    for (size_t k = 0; k < next.size(); k++) {
        if (!shapes_.used(loop, int(k))) {
            for (size_t f : flags)
                if (f != k) next[k] = dropDead(next[k], before[k], next[f][0].v);
        } else if (body.yields[k] != body.params[k]) next[k] = keepLanes(running, next[k], before[k]);
    }
}

void Emitter::emitLoop(const Inst* i) {
    const ir::Region &test = i->regions[0], &body = i->regions[1];
    const size_t count = test.params.size();
    const bool varying = shapes_.of(test.yields[0]).varying;
    std::vector<Shape> shape(count);
    std::vector<Kind> kind(count);
    std::vector<Val> init(count), phi(count);
    for (size_t k = 0; k < count; k++) {
        kind[k] = test.params[k]->kind;
        shape[k] = shapes_.of(test.params[k]);
        init[k] = conform(value(i->args[k]), kind[k], shape[k]);
    }
    BasicBlock* before = b_.GetInsertBlock();
    BasicBlock *head = block("loop"), *inside = block("body"), *exit = block("exit");
    // A loop with loops inside counts each of its turns, the innermost one what it has made when it is left.
    const bool nest = i->site >= 0 && nests(i), counts = i->site >= 0 && !nest && loops_ > 0;
    Value* start = counts && varying ? b_.CreateAnd(mask_, b_.CreateNot(spent())) : mask_;
    b_.CreateBr(head);
    b_.SetInsertPoint(head);
    Value* outer = mask_;
    const bool outerRoot = rootMask_;
    llvm::PHINode* made = counts && varying ? b_.CreatePHI(vi_, 2, "made") : nullptr;
    if (made) made->addIncoming(llvm::Constant::getNullValue(vi_), before);
    llvm::PHINode* live = varying ? b_.CreatePHI(vm_, 2, "live") : nullptr;
    for (size_t k = 0; k < count; k++) {
        phi[k] = phis(kind[k], shape[k]);
        addIncoming(phi[k], init[k], before);
        define(test.params[k], 0, phi[k]);
        define(body.params[k], 0, phi[k]);
    }
    // Who is still inside has made every turn, so that one count is that of all lanes.
    llvm::PHINode* turn = i->site >= 0 ? b_.CreatePHI(i32_, 2, "turn") : nullptr;
    if (turn) turn->addIncoming(b_.getInt32(0), before);
    if (varying) {
        live->addIncoming(start, before);
        mask_ = live;
        rootMask_ = false;
    }
    ++loops_;
    region(test);
    --loops_;
    Value* go = value(test.yields[0])[0].v;
    Value* running = nullptr;
    if (varying) {
        running = b_.CreateAnd(live, lanes(go), "running");
        go = any(running);
    }
    // Two jumps: each is one test of memory or of masks, their conjunction would be made of bytes.
    BasicBlock* ask = block("goon");
    b_.CreateCondBr(go, ask, exit);
    b_.SetInsertPoint(ask);
    if (varying) mask_ = running;
    BasicBlock* allowed = turn ? block("allowed") : inside;
    b_.CreateCondBr(stopped(), exit, allowed);
    b_.SetInsertPoint(allowed);
    if (turn) allowTurn(i, turn, inside, exit);
    b_.SetInsertPoint(inside);
    if (nest) {
        Value* going = withinTurns(i, varying, exit);
        if (varying) running = going;
    }
    ++loops_;
    region(body);
    --loops_;
    std::vector<Val> next(count);
    for (size_t k = 0; k < count; k++) { next[k] = conform(value(body.yields[k]), kind[k], shape[k]); }
    if (varying) keepLeft(i, running, phi, next);
    BasicBlock* latch = b_.GetInsertBlock();
    if (turn) turn->addIncoming(b_.CreateAdd(turn, b_.getInt32(1)), latch);
    if (made) made->addIncoming(b_.CreateSub(made, b_.CreateSExt(running, vi_)), latch);
    b_.CreateBr(head);
    for (size_t k = 0; k < count; k++) addIncoming(phi[k], next[k], latch);
    if (varying) live->addIncoming(running, latch);
    b_.SetInsertPoint(exit);
    if (counts) spend(made ? (Value*)made : (Value*)turn, outer);
    mask_ = outer;
    rootMask_ = outerRoot;
    for (size_t k = 0; k < count; k++) define(i, int(k), phi[k]);
}

void Emitter::emitLightLoop(const Inst* i) {
    const ir::Region& body = i->regions[0];
    const size_t count = body.yields.size();
    // P, axis, angle: seven rows; the lights of the strip.
    std::vector<Value*> rows;
    for (int k = 0; k < 3; k++) flatten(i->args[size_t(k)], rows);
    Value* in = scratch(2, int(rows.size()));
    storeRows(in, rows);
    auto* i32 = i32_;
    Value* begin = field(offsetof(KernelCall, lightBegin), ptr_, "lightBegin");
    Value* fetch = field(offsetof(KernelCall, lightFetch), ptr_, "lightFetch");
    Value* end = field(offsetof(KernelCall, lightEnd), ptr_, "lightEnd");
    Value* site = b_.getInt32(uint32_t(i->site));
    Value* lanesValue = b_.getInt32(uint32_t(width_));
    auto* beginType = llvm::FunctionType::get(i32, {ptr_, i32, i32, i64_, i32, ptr_}, false);
    Value* lights = b_.CreateCall(beginType, begin, {call_, site, first_, maskBits(), lanesValue, in}, "lights");
    std::vector<Shape> shape(count);
    std::vector<Kind> kind(count);
    std::vector<Val> init(count), phi(count);
    for (size_t k = 0; k < count; k++) {
        kind[k] = body.params[4 + k]->kind;
        shape[k] = shapes_.of(body.params[4 + k]);
        init[k] = conform(value(i->args[3 + k]), kind[k], shape[k]);
    }
    BasicBlock* before = b_.GetInsertBlock();
    BasicBlock *head = block("lightloop"), *get = block("light"), *inside = block("lit"), *step = block("nextlight"),
               *exit = block("exit");
    b_.CreateBr(head);
    b_.SetInsertPoint(head);
    auto* index = b_.CreatePHI(i32, 2, "light");
    index->addIncoming(b_.getInt32(0), before);
    for (size_t k = 0; k < count; k++) {
        phi[k] = phis(kind[k], shape[k]);
        addIncoming(phi[k], init[k], before);
    }
    b_.CreateCondBr(b_.CreateAnd(b_.CreateICmpSLT(index, lights), b_.CreateNot(stopped())), get, exit);
    b_.SetInsertPoint(get);
    Value* out = scratch(3, 9);
    auto* fetchType = llvm::FunctionType::get(i64_, {ptr_, i32, i32, i32, i64_, i32, ptr_}, false);
    Value* bits = b_.CreateCall(fetchType, fetch, {call_, site, index, first_, maskBits(), lanesValue, out});
    Value* bitsW = width_ == 64 ? bits : b_.CreateTrunc(bits, b_.getIntNTy(unsigned(width_)));
    Value* mask = b_.CreateAnd(mask_, b_.CreateBitCast(bitsW, vm_), "lit");
    int at = 0;
    for (size_t k = 0; k < 3; k++) define(body.params[k], 0, fromRows(Kind::Triple, out, at));
    define(body.params[3], 0, {Jet{b_.CreateSIToFP(index, f32_)}});
    for (size_t k = 0; k < count; k++) define(body.params[4 + k], 0, phi[k]);
    b_.CreateCondBr(any(mask), inside, step);
    BasicBlock* skipped = b_.GetInsertBlock();
    Value* outer = mask_;
    const bool outerRoot = rootMask_;
    b_.SetInsertPoint(inside);
    mask_ = mask;
    rootMask_ = false;
    region(body);
    std::vector<Val> next(count);
    for (size_t k = 0; k < count; k++) {
        next[k] = conform(value(body.yields[k]), kind[k], shape[k]);
        if (body.yields[k] != body.params[4 + k]) next[k] = selectLanes(mask, next[k], phi[k]);
    }
    BasicBlock* ran = b_.GetInsertBlock();
    b_.CreateBr(step);
    b_.SetInsertPoint(step);
    std::vector<Val> joined(count);
    for (size_t k = 0; k < count; k++) {
        joined[k] = phis(kind[k], shape[k]);
        addIncoming(joined[k], phi[k], skipped);
        addIncoming(joined[k], next[k], ran);
    }
    Value* following = b_.CreateAdd(index, b_.getInt32(1));
    BasicBlock* latch = b_.GetInsertBlock();
    b_.CreateBr(head);
    index->addIncoming(following, latch);
    for (size_t k = 0; k < count; k++) addIncoming(phi[k], joined[k], latch);
    b_.SetInsertPoint(exit);
    b_.CreateCall(llvm::FunctionType::get(b_.getVoidTy(), {ptr_, i32, i32, i32}, false), end, {call_, site, first_, lanesValue});
    mask_ = outer;
    rootMask_ = outerRoot;
    for (size_t k = 0; k < count; k++) define(i, int(k), phi[k]);
}

} // namespace alpenglow::rsl::jit
