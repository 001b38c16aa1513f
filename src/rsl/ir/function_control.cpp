// Branches and loops: what is assigned in a region leaves it as a result.
#include "rsl/ir/function_builder.h"

namespace alpenglow::rsl::ir {

FunctionBuilder::Scope::Scope(FunctionBuilder& b, Region& r) : builder_(b), around_(b.region_), mark_(b.log_.size()) {
    b.region_ = &r;
}

std::map<int, Inst*> FunctionBuilder::Scope::changes() const {
    std::map<int, Inst*> changed;
    for (size_t n = mark_; n < builder_.log_.size(); ++n) {
        const int slot = builder_.log_[n].first;
        changed[slot] = builder_.value(slot);
    }
    return changed;
}

void FunctionBuilder::Scope::close() {
    if (!std::exchange(open_, false)) return;
    builder_.region_ = around_;
    for (auto& log = builder_.log_; log.size() > mark_; log.pop_back()) builder_.value(log.back().first) = log.back().second;
}

std::vector<Inst*> FunctionBuilder::branch(Inst* condition, const std::function<std::vector<Inst*>()>& yes,
                                           const std::function<std::vector<Inst*>()>& no) {
    if (isConst(condition)) return condition->numbers[0] != 0 ? yes() : no();
    Inst* inst = k_.make(Op::If, Kind::None, {condition});
    inst->place = keptPlace(place_);
    inst->regions.resize(2);
    std::map<int, Inst*> changed[2];
    std::vector<Inst*> extra[2];
    for (size_t side = 0; side < 2; ++side) {
        const Scope scope(*this, inst->regions[side]);
        extra[side] = side == 0 ? yes() : no();
        changed[side] = scope.changes();
    }
    region_->body.push_back(inst);
    const auto yield = [&](Inst* a, Inst* b) {
        if (a == b) return a;
        inst->regions[0].yields.push_back(a);
        inst->regions[1].yields.push_back(b);
        inst->results.push_back(a->kind);
        return emit(Op::Result, a->kind, {inst}, static_cast<int>(inst->results.size()) - 1);
    };
    std::set<int> slots;
    for (const auto& side : changed)
        for (const auto& [n, v] : side) slots.insert(n);
    for (int n : slots) {
        Inst* before = value(n);
        const auto valueOf = [&](int side) {
            const auto it = changed[side].find(n);
            return it == changed[side].end() ? before : it->second;
        };
        // Without a value before, the variable lives inside the branch only; array names never change what they stand for.
        if (before && before->kind != Kind::Array && valueOf(0)->kind == valueOf(1)->kind) set(n, yield(valueOf(0), valueOf(1)));
    }
    std::vector<Inst*> out;
    for (size_t n = 0; n < extra[0].size(); ++n) out.push_back(yield(extra[0][n], extra[1][n]));
    return out;
}

void FunctionBuilder::when(Inst* condition, const Code& yes, const Code& no) {
    const auto without = [](const Code& code) {
        return [&code] {
            if (code) code();
            return std::vector<Inst*>{};
        };
    };
    branch(condition, without(yes), without(no));
}

std::vector<int> FunctionBuilder::carry(Inst* loop, const std::set<int>& assigned) {
    std::vector<int> carried;
    for (int n : assigned) {
        if (isGlobal(n)) get(n);
        Inst* v = value(n);
        if (!v || v->kind == Kind::Array) continue;
        carried.push_back(n);
        loop->args.push_back(v);
        loop->results.push_back(v->kind);
    }
    return carried;
}

void FunctionBuilder::enterTurn(const Inst* loop, Region& r, const std::vector<int>& carried) {
    for (size_t c = 0; c < carried.size(); ++c) set(carried[c], parameter(r, loop->results[c]));
}

void FunctionBuilder::leaveLoop(Inst* loop, const std::vector<int>& carried) {
    region_->body.push_back(loop);
    for (size_t c = 0; c < carried.size(); ++c) set(carried[c], emit(Op::Result, loop->results[c], {loop}, static_cast<int>(c)));
}

void FunctionBuilder::everyElement(int count, const std::function<void(Inst* at)>& each) {
    constexpr int kOneByOne = 256;
    if (count <= kOneByOne) {
        for (int i = 0; i < count; ++i) each(constant(static_cast<float>(i)));
        return;
    }
    countLoop(constant(0), constant(static_cast<float>(count)), each);
}

void FunctionBuilder::countLoop(Inst* first, Inst* end, const std::function<void(Inst* at)>& each) {
    Inst* inst = k_.make(Op::Loop, Kind::None);
    inst->place = keptPlace(place_);
    inst->args = {first};
    inst->results = {Kind::Float};
    inst->regions.resize(2);
    {
        const Scope test(*this, inst->regions[0]);
        Inst* at = parameter(inst->regions[0], Kind::Float);
        inst->regions[0].yields.push_back(emit(Op::Less, Kind::Bool, {at, end}));
    }
    {
        const Scope turn(*this, inst->regions[1]);
        Inst* at = parameter(inst->regions[1], Kind::Float);
        each(at);
        inst->regions[1].yields.push_back(emit(Op::Add, Kind::Float, {at, constant(1)}));
    }
    region_->body.push_back(inst);
}

} // namespace alpenglow::rsl::ir
