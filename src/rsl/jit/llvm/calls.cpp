// Calls: runtime functions in bitcode (inlined, or behind a wrapper with its arguments in registers) and services of the
// renderer.
#include "rsl/jit/llvm/emitter.h"
#include "rsl/kernel.h"
#include <algorithm>
#include <cstddef>

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using ir::Op;
using llvm::Function;
using llvm::FunctionType;
using llvm::Value;

namespace {

int argumentComponents(Kind k) {
    return k == Kind::Triple ? 3 : k == Kind::Matrix ? 16 : k == Kind::None || k == Kind::Array ? 0 : 1;
}
constexpr int kPartCount[3] = {0, 2, 5};

} // namespace

Value* Emitter::scratch(int which, int rows) {
    auto& s = scratch_[size_t(which)];
    s.rows = std::max(s.rows, std::max(1, rows));
    return s.place;
}

Value* Emitter::row(Value* block, int index) {
    return index == 0 ? block : b_.CreateConstInBoundsGEP1_32(vf_, block, unsigned(index));
}

Function* Emitter::runtimeFunction(const std::string& symbol, int order) {
    const std::string name = symbol + "_" + std::to_string(order);
    if (Function* f = module_.getFunction(name)) return f;
    if (!runtime_.getFunction(name)) fail("the runtime has no function " + name);
    auto* f = Function::Create(FunctionType::get(void_, {ptr_, ptr_}, false), Function::ExternalLinkage, name, module_);
    f->addFnAttr(llvm::Attribute::NoUnwind);
    return f;
}

std::vector<Value*> Emitter::callRuntime(Function* f, const std::vector<Value*>& in, int out) {
    Value* a = scratch(0, int(in.size()));
    Value* r = scratch(1, out);
    const llvm::Align align(uint64_t(width_) * 4);
    for (size_t k = 0; k < in.size(); k++) b_.CreateAlignedStore(in[k], row(a, int(k)), align);
    b_.CreateCall(f, {a, r});
    std::vector<Value*> result;
    for (int k = 0; k < out; k++) result.push_back(b_.CreateAlignedLoad(vf_, row(r, k), align));
    return result;
}

Function* Emitter::wrapper(const std::string& symbol, int order, int in, int out) {
    const std::string name = symbol + "_" + std::to_string(order) + "_wide";
    Function*& f = shared_->wrappers[name];
    if (f) return f;
    Function* target = runtimeFunction(symbol, order);
    std::vector<llvm::Type*> args(size_t(in), vf_), results(size_t(out), vf_);
    llvm::Type* result = out == 1 ? (llvm::Type*)vf_ : llvm::StructType::get(context_, results);
    f = Function::Create(FunctionType::get(result, args, false), Function::InternalLinkage, name, module_);
    f->setCallingConv(llvm::CallingConv::Fast);
    f->addFnAttr(llvm::Attribute::NoUnwind);
    f->addFnAttr(llvm::Attribute::NoInline);
    B b(llvm::BasicBlock::Create(context_, "entry", f));
    const llvm::Align align(uint64_t(std::max(64, width_ * 4)));
    auto* a = b.CreateAlloca(llvm::ArrayType::get(vf_, uint64_t(std::max(1, in))));
    auto* r = b.CreateAlloca(llvm::ArrayType::get(vf_, uint64_t(std::max(1, out))));
    a->setAlignment(align);
    r->setAlignment(align);
    for (int k = 0; k < in; k++) b.CreateStore(f->getArg(unsigned(k)), b.CreateConstInBoundsGEP1_32(vf_, a, unsigned(k)));
    b.CreateCall(target, {a, r});
    Value* all = out == 1 ? nullptr : llvm::PoisonValue::get(result);
    for (int k = 0; k < out; k++) {
        Value* v = b.CreateLoad(vf_, b.CreateConstInBoundsGEP1_32(vf_, r, unsigned(k)));
        all = all ? b.CreateInsertValue(all, v, unsigned(k)) : v;
    }
    b.CreateRet(all);
    return f;
}

Value* Emitter::toFloatRow(Value* v) {
    if (v->getType()->getScalarType() == i1_) {
        v = b_.CreateSelect(v, v->getType()->isVectorTy() ? lanes(number(1)) : number(1),
                            v->getType()->isVectorTy() ? lanes(number(0)) : number(0));
    } else if (v->getType()->getScalarType() == i32_) {
        v = b_.CreateBitCast(v, v->getType()->isVectorTy() ? (llvm::Type*)vf_ : f32_);
    }
    return lanes(v);
}

void Emitter::runtime(const Inst* i) {
    const int order = shapes_.callOrder(i);
    const int parts = kPartCount[order];
    std::vector<Value*> in;
    bool varying = false;
    for (const Inst* a : i->args) {
        for (const Jet& j : value(a)) {
            varying |= j.v->getType()->isVectorTy();
            in.push_back(toFloatRow(j.v));
            for (int p = 0; p < parts; p++) {
                Value* d = j.d[size_t(p)];
                if (d) varying |= d->getType()->isVectorTy();
                in.push_back(d ? lanes(d) : llvm::Constant::getNullValue(vf_));
            }
        }
    }
    std::vector<Kind> kinds = i->results;
    if (kinds.empty()) kinds.push_back(i->kind);
    int out = 0;
    for (Kind k : kinds) out += argumentComponents(k) * (1 + parts);
    std::vector<Value*> results;
    if (wrapCalls_ && request_.outOfLine && request_.outOfLine->count(i->text)) {
        auto* c = b_.CreateCall(wrapper(i->text, order, int(in.size()), out), in);
        c->setCallingConv(llvm::CallingConv::Fast);
        for (int k = 0; k < out; k++) results.push_back(out == 1 ? c : b_.CreateExtractValue(c, unsigned(k)));
    } else {
        results = callRuntime(runtimeFunction(i->text, order), in, out);
    }
    size_t at = 0;
    for (size_t k = 0; k < kinds.size(); k++) {
        Val v;
        // Only requested orders are kept.
        const uint8_t wanted = partsOfOrder(shapes_.order(i, int(k)));
        for (int c = 0; c < argumentComponents(kinds[k]); c++) {
            auto take = [&]() -> Value* {
                Value* x = results[at++];
                return varying ? x : b_.CreateExtractElement(x, uint64_t(0));
            };
            Jet j{take()};
            if (kinds[k] == Kind::String) j.v = b_.CreateBitCast(j.v, varying ? (llvm::Type*)vi_ : i32_);
            if (kinds[k] == Kind::Bool) j.v = b_.CreateFCmpUNE(j.v, llvm::Constant::getNullValue(j.v->getType()));
            for (int p = 0; p < parts; p++) {
                Value* d = take();
                if (wanted & (1 << p)) j.d[size_t(p)] = d;
            }
            v.push_back(j);
        }
        define(i, int(k), std::move(v));
    }
}

Value* Emitter::maskBits() { return b_.CreateZExt(b_.CreateBitCast(mask_, b_.getIntNTy(unsigned(width_))), i64_); }

void Emitter::flatten(const Inst* arg, std::vector<Value*>& rows) {
    if (auto it = arrays_.find(arg); it != arrays_.end()) {
        const ArrayStorage& a = it->second;
        for (int e = 0; e < a.length; e++)
            for (int c = 0; c < a.components; c++)
                rows.push_back(toFloatRow(loadRow(a, b_.getInt32(uint32_t(e)), c * (a.rows() / a.components))));
        return;
    }
    for (const Jet& j : value(arg)) rows.push_back(toFloatRow(j.v));
}

void Emitter::storeRows(Value* block, const std::vector<Value*>& rows) {
    for (size_t k = 0; k < rows.size(); k++)
        b_.CreateAlignedStore(rows[k], row(block, int(k)), llvm::Align(uint64_t(std::min(64, width_ * 4))));
}

Val Emitter::fromRows(Kind kind, Value* block, int& at) {
    Val v;
    for (int c = 0; c < argumentComponents(kind); c++, at++) {
        llvm::Type* t = kind == Kind::String ? vi_ : vf_;
        Value* x = b_.CreateAlignedLoad(t, row(block, at), llvm::Align(uint64_t(std::min(64, width_ * 4))));
        if (kind == Kind::Bool) x = b_.CreateFCmpUNE(x, llvm::Constant::getNullValue(vf_));
        v.push_back({x});
    }
    return v;
}

void Emitter::callService(int site, Value* in, Value* out) {
    auto* null = llvm::ConstantPointerNull::get(llvm::cast<llvm::PointerType>(ptr_));
    Value* f = field(offsetof(KernelCall, service), ptr_, "service");
    auto* type = FunctionType::get(void_, {ptr_, i32_, i32_, i64_, i32_, ptr_, ptr_}, false);
    b_.CreateCall(type, f,
                  {call_, b_.getInt32(uint32_t(site)), first_, maskBits(), b_.getInt32(uint32_t(width_)), in ? in : null,
                   out ? out : null});
}

void Emitter::service(const Inst* i) {
    std::vector<Value*> rows;
    for (const Inst* a : i->args) flatten(a, rows);
    Value* in = rows.empty() ? nullptr : scratch(2, int(rows.size()));
    storeRows(in, rows);
    std::vector<Kind> kinds = i->results;
    if (kinds.empty() && i->kind != Kind::None) kinds.push_back(i->kind);
    if (i->op == Op::Emit) kinds.clear();
    int count = 0;
    for (Kind k : kinds) count += argumentComponents(k);
    Value* out = count ? scratch(3, count) : nullptr;
    // Whatever a service leaves unanswered is zero.
    for (int k = 0; k < count; k++)
        b_.CreateAlignedStore(llvm::Constant::getNullValue(vf_), row(out, k), llvm::Align(uint64_t(std::min(64, width_ * 4))));
    const std::string& op = kernel_.sites[size_t(i->site)].op;
    if (op.rfind(kPluginSymbol, 0) == 0) {
        // A plug-in's function, by its name: the loader puts the address there.
        auto* null = llvm::ConstantPointerNull::get(llvm::cast<llvm::PointerType>(ptr_));
        auto f = module_.getOrInsertFunction(op, FunctionType::get(void_, {i32_, i64_, ptr_, ptr_}, false));
        b_.CreateCall(f, {b_.getInt32(uint32_t(width_)), maskBits(), in ? in : null, out ? out : null});
    } else {
        callService(i->site, in, out);
    }
    if (i->op == Op::Request) suspend();
    int at = 0;
    for (size_t k = 0; k < kinds.size(); k++) define(i, int(k), fromRows(kinds[k], out, at));
}

void Emitter::mark(const Inst* i) {
    if (i->op == Op::Mark) {
        Value* out = scratch(3, 1);
        b_.CreateAlignedStore(llvm::Constant::getNullValue(vf_), out, llvm::Align(uint64_t(std::min(64, width_ * 4))));
        callService(kSiteMark, nullptr, out);
        int at = 0;
        return define(i, 0, fromRows(Kind::Float, out, at));
    }
    std::vector<Value*> rows;
    for (const Inst* a : i->args) flatten(a, rows);
    Value* in = scratch(2, int(rows.size()));
    storeRows(in, rows);
    callService(kSiteRescale, in, nullptr);
}

} // namespace alpenglow::rsl::jit
