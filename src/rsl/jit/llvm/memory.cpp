// Inputs, outputs, arrays, string constants.
#include "base/limits.h"
#include "rsl/jit/llvm/emitter.h"
#include "rsl/kernel.h"
#include <algorithm>

namespace alpenglow::rsl::jit {

using ir::Inst;
using ir::Kind;
using llvm::Value;

namespace {

int elementComponents(Kind k) { return k == Kind::Triple ? 3 : k == Kind::Matrix ? 16 : 1; }

// Arrays up to this length with an index that differs between lanes are read by comparisons, longer ones by a gather.
constexpr int kSelectChain = 16;

int partRow(const ArrayStorage& a, int component, int part) { // part -1: the value
    const int perComponent = a.rows() / a.components;
    if (part < 0) return component * perComponent;
    return component * perComponent + 1 + __builtin_popcount(a.shape.parts & ((1u << part) - 1));
}

} // namespace

Value* Emitter::inputBase(int index) {
    Value*& base = inputBases_[index];
    if (!base) base = entry_.CreateLoad(ptr_, entry_.CreateConstInBoundsGEP1_32(ptr_, in_, unsigned(index)), "input");
    return base;
}

Value* Emitter::constantString(const std::string& s) {
    if (s.empty()) return b_.getInt32(0);
    Value*& v = stringValues_[s];
    if (!v) {
        const unsigned index = unsigned(shared_->strings.size());
        shared_->strings.push_back(s);
        v = entry_.CreateLoad(i32_, entry_.CreateConstInBoundsGEP1_32(i32_, stringIds_, index), "string");
    }
    return v;
}

void Emitter::input(const Inst* i) {
    const ir::Input& in = kernel_.inputs[size_t(i->index)];
    const int count = elementComponents(in.kind);
    const bool string = in.kind == Kind::String;
    Value* base = inputBase(i->index);
    if (in.uniform && !request_.mixed) {
        Val& v = uniformInputs_[i->index];
        if (v.empty()) {
            llvm::Type* t = string ? i32_ : f32_;
            for (int c = 0; c < count; c++)
                v.push_back({entry_.CreateLoad(t, entry_.CreateConstInBoundsGEP1_32(t, base, unsigned(c)), in.name)});
        }
        return define(i, 0, v);
    }
    const int parts = inputParts(in);
    const uint8_t wanted = partsOfOrder(shapes_.order(i)) & shapes_.of(i).parts;
    const bool parameter = in.name == "u" || in.name == "v"; // the derivative that is not zero is one
    Val v;
    llvm::Type* t = string ? vi_ : vf_;
    for (int c = 0; c < count; c++) {
        auto load = [&](int part) -> Value* {
            Value* at = b_.CreateAdd(b_.CreateMul(stride_, b_.getInt64(uint64_t(c * parts + part))), first64_);
            return b_.CreateAlignedLoad(t, b_.CreateGEP(f32_, base, at), llvm::Align(std::min(64, width_ * 4)), in.name);
        };
        Jet j{load(0)};
        for (int p = 0; p + 1 < parts; p++)
            if (wanted & (1 << p)) j.d[size_t(p)] = parameter ? number(1) : load(p + 1);
        v.push_back(j);
    }
    define(i, 0, std::move(v));
}

void Emitter::output(const Inst* i) {
    const Val& v = value(i->args[0]);
    Value* base = inputBases_.count(-1 - i->index) ? inputBases_[-1 - i->index] : nullptr;
    if (!base) {
        base = entry_.CreateLoad(ptr_, entry_.CreateConstInBoundsGEP1_32(ptr_, out_, unsigned(i->index)), "output");
        inputBases_[-1 - i->index] = base;
    }
    for (size_t c = 0; c < v.size(); c++) {
        Value* x = lanes(v[c].v);
        if (x->getType() == vm_) x = b_.CreateSelect(x, lanes(number(1)), lanes(number(0)));
        Value* at = b_.CreateAdd(b_.CreateMul(stride_, b_.getInt64(c)), first64_);
        Value* p = b_.CreateGEP(f32_, base, at);
        const llvm::Align align(uint64_t(std::min(64, width_ * 4)));
        if (rootMask_) b_.CreateAlignedStore(x, p, align);
        else b_.CreateMaskedStore(x, p, align, mask_);
    }
}

// Null while the stack has room for `bytes` more; else a place in the kernel's local memory, which is known from `place` on
// (null: in the whole body). One kernel has one stack and one memory, however its functions call each other: no RSL function
// calls itself.
Value* Emitter::localMemory(uint64_t bytes, uint64_t align, llvm::Instruction* place) {
    if (shared_->stackBytes + bytes <= limits::kKernelStack) {
        shared_->stackBytes += bytes;
        return nullptr;
    }
    const uint64_t at = (shared_->localBytes + align - 1) / align * align;
    shared_->localBytes = at + (bytes + 63) / 64 * 64;
    llvm::Type* byte = llvm::Type::getInt8Ty(context_);
    if (!place) return entry_.CreateConstInBoundsGEP1_64(byte, memory_, at, "array");
    return B(place).CreateConstInBoundsGEP1_64(byte, memory_, at, "rows");
}

void Emitter::arrayNew(const Inst* i) {
    const auto bytesOf = [&](const ArrayStorage& a) {
        return uint64_t(a.length) * uint64_t(a.rows()) * 4 * uint64_t(a.shape.varying ? width_ : 1);
    };
    ArrayStorage& a = arrays_[i];
    if (!a.base) {
        a.length = std::max(1, i->index);
        a.element = i->element;
        a.components = elementComponents(i->element);
        a.shape = shapes_.of(i);
        llvm::Type* t =
            a.element == Kind::String ? (a.shape.varying ? (llvm::Type*)vi_ : i32_) : (a.shape.varying ? (llvm::Type*)vf_ : f32_);
        a.base = localMemory(bytesOf(a), 64, nullptr);
        if (!a.base) {
            B top(&function_->getEntryBlock(), function_->getEntryBlock().begin());
            auto* storage = top.CreateAlloca(llvm::ArrayType::get(t, uint64_t(a.length) * uint64_t(a.rows())), nullptr, "array");
            storage->setAlignment(llvm::Align(64));
            a.base = storage;
        }
    }
    const uint64_t bytes = bytesOf(a);
    b_.CreateMemSet(a.base, b_.getInt8(0), bytes, llvm::MaybeAlign(64));
    define(i, 0, {Jet{a.base}});
}

void Emitter::arrayInput(const Inst* i) {
    const ir::Input& in = kernel_.inputs[size_t(i->index)];
    ArrayStorage& a = arrays_[i];
    a.readOnly = true;
    a.length = std::max(1, in.array);
    a.element = in.kind;
    a.components = elementComponents(in.kind);
    a.shape = {!in.uniform || request_.mixed, 0};
    a.base = inputBase(i->index);
    if (a.shape.varying) a.stride = stride_;
    define(i, 0, {Jet{a.base}});
}

// Truncated towards zero; outside of the array the nearest element is used; NaN is element 0.
Value* Emitter::elementIndex(Value* index, int length) {
    if (auto* c = llvm::dyn_cast<llvm::ConstantFP>(index)) {
        const double d = c->getValueAPF().convertToDouble();
        return b_.getInt32(uint32_t(d >= length - 1 ? length - 1 : d > 0 ? int(d) : 0));
    }
    llvm::Type* t = index->getType()->isVectorTy() ? (llvm::Type*)vi_ : i32_;
    Value* k = b_.CreateIntrinsic(llvm::Intrinsic::fptosi_sat, {t, index->getType()}, {index});
    k = b_.CreateBinaryIntrinsic(llvm::Intrinsic::smax, k, llvm::Constant::getNullValue(t));
    return b_.CreateBinaryIntrinsic(llvm::Intrinsic::smin, k, llvm::ConstantInt::get(t, uint64_t(length - 1)));
}

Value* Emitter::rowPointer(const ArrayStorage& a, Value* element, int row) {
    Value* index =
        b_.CreateAdd(b_.CreateMul(b_.CreateZExt(element, i64_), b_.getInt64(uint64_t(a.rows()))), b_.getInt64(uint64_t(row)));
    if (a.stride) return b_.CreateGEP(f32_, a.base, b_.CreateAdd(b_.CreateMul(index, a.stride), first64_));
    return b_.CreateGEP(a.shape.varying ? (llvm::Type*)vf_ : f32_, a.base, index);
}

Value* Emitter::loadRow(const ArrayStorage& a, Value* element, int row) {
    const bool string = a.element == Kind::String;
    llvm::Type* scalar = string ? i32_ : f32_;
    llvm::Type* wide = string ? (llvm::Type*)vi_ : vf_;
    if (!element->getType()->isVectorTy())
        return b_.CreateAlignedLoad(a.shape.varying ? wide : scalar, rowPointer(a, element, row),
                                    llvm::Align(a.shape.varying ? uint64_t(std::min(64, width_ * 4)) : 4));
    if (a.length <= kSelectChain) {
        Value* r = lanes(loadRow(a, b_.getInt32(0), row));
        for (int e = 1; e < a.length; e++) {
            Value* is = b_.CreateICmpEQ(element, lanes(b_.getInt32(uint32_t(e))));
            r = b_.CreateSelect(is, lanes(loadRow(a, b_.getInt32(uint32_t(e)), row)), r);
        }
        return r;
    }
    auto* wide64 = llvm::FixedVectorType::get(i64_, unsigned(width_));
    Value* index = b_.CreateAdd(b_.CreateMul(b_.CreateZExt(element, wide64), lanes(b_.getInt64(uint64_t(a.rows())))),
                                lanes(b_.getInt64(uint64_t(row))));
    std::vector<llvm::Constant*> lane;
    for (int k = 0; k < width_; k++) lane.push_back(llvm::ConstantInt::get(i64_, uint64_t(k)));
    if (a.stride)
        index =
            b_.CreateAdd(b_.CreateMul(index, lanes(a.stride)), b_.CreateAdd(lanes(first64_), llvm::ConstantVector::get(lane)));
    else if (a.shape.varying)
        index = b_.CreateAdd(b_.CreateMul(index, lanes(b_.getInt64(uint64_t(width_)))), llvm::ConstantVector::get(lane));
    return b_.CreateMaskedGather(wide, b_.CreateGEP(f32_, a.base, index), llvm::Align(4), llvm::Constant::getAllOnesValue(vm_));
}

void Emitter::storeRow(const ArrayStorage& a, Value* element, int row, Value* v) {
    if (!a.shape.varying) {
        b_.CreateAlignedStore(v, rowPointer(a, element, row), llvm::Align(4));
        return;
    }
    v = lanes(v);
    const llvm::Align align(uint64_t(std::min(64, width_ * 4)));
    if (!element->getType()->isVectorTy()) {
        Value* p = rowPointer(a, element, row);
        if (!rootMask_) v = b_.CreateSelect(mask_, v, b_.CreateAlignedLoad(v->getType(), p, align));
        b_.CreateAlignedStore(v, p, align);
        return;
    }
    if (a.length <= kSelectChain) {
        for (int e = 0; e < a.length; e++) {
            Value* is = b_.CreateICmpEQ(element, lanes(b_.getInt32(uint32_t(e))));
            if (!rootMask_) is = b_.CreateAnd(is, mask_);
            Value* p = rowPointer(a, b_.getInt32(uint32_t(e)), row);
            b_.CreateAlignedStore(b_.CreateSelect(is, v, b_.CreateAlignedLoad(v->getType(), p, align)), p, align);
        }
        return;
    }
    auto* wide64 = llvm::FixedVectorType::get(i64_, unsigned(width_));
    std::vector<llvm::Constant*> lane;
    for (int k = 0; k < width_; k++) lane.push_back(llvm::ConstantInt::get(i64_, uint64_t(k)));
    Value* index = b_.CreateAdd(b_.CreateMul(b_.CreateZExt(element, wide64), lanes(b_.getInt64(uint64_t(a.rows())))),
                                lanes(b_.getInt64(uint64_t(row))));
    index = b_.CreateAdd(b_.CreateMul(index, lanes(b_.getInt64(uint64_t(width_)))), llvm::ConstantVector::get(lane));
    b_.CreateMaskedScatter(v, b_.CreateGEP(f32_, a.base, index), llvm::Align(4),
                           rootMask_ ? llvm::Constant::getAllOnesValue(vm_) : mask_);
}

void Emitter::arrayLoad(const Inst* i) {
    auto it = arrays_.find(i->args[0]);
    if (it == arrays_.end()) fail("load from what is not an array");
    const ArrayStorage& a = it->second;
    Value* e = elementIndex(value(i->args[1])[0].v, a.length);
    const uint8_t wanted = partsOfOrder(shapes_.order(i)) & a.shape.parts;
    Val v;
    for (int c = 0; c < a.components; c++) {
        Jet j{loadRow(a, e, partRow(a, c, -1))};
        for (int p = 0; p < 5; p++)
            if (wanted & (1 << p)) j.d[size_t(p)] = loadRow(a, e, partRow(a, c, p));
        v.push_back(j);
    }
    define(i, 0, std::move(v));
}

void Emitter::arrayStore(const Inst* i) {
    auto it = arrays_.find(i->args[0]);
    if (it == arrays_.end() || it->second.readOnly) fail("store to what is not a local array");
    const ArrayStorage& a = it->second;
    Value* e = elementIndex(value(i->args[1])[0].v, a.length);
    const Val v = conform(value(i->args[2]), a.element, a.shape);
    for (int c = 0; c < a.components; c++) {
        storeRow(a, e, partRow(a, c, -1), v[size_t(c)].v);
        for (int p = 0; p < 5; p++)
            if (a.shape.parts & (1 << p)) storeRow(a, e, partRow(a, c, p), v[size_t(c)].d[size_t(p)]);
    }
}

} // namespace alpenglow::rsl::jit
