#include "rsl/jit/llvm/masks.h"
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Instructions.h>
#include <map>
#include <vector>

namespace alpenglow::rsl::jit {

namespace {

using llvm::BasicBlock;
using llvm::Instruction;
using llvm::Value;

bool isMask(const Value& v) { return v.getType()->isVectorTy() && v.getType()->getScalarType()->isIntegerTy(1); }

llvm::Type* lanesOf(const Value& mask) {
    return llvm::VectorType::get(llvm::Type::getInt32Ty(mask.getContext()),
                                 llvm::cast<llvm::VectorType>(mask.getType())->getElementCount());
}

/// Instructions that make a mask of masks; other instructions with a mask as result are sources.
bool combines(const Instruction& i) {
    if (!isMask(i)) return false;
    if (llvm::isa<llvm::PHINode>(i)) return true;
    if (const auto* s = llvm::dyn_cast<llvm::SelectInst>(&i)) return isMask(*s->getCondition());
    return i.getOpcode() == Instruction::And || i.getOpcode() == Instruction::Or || i.getOpcode() == Instruction::Xor;
}

class Widener {
public:
    Widener(llvm::Function& f, unsigned registerLanes) : function_(f), registerLanes_(registerLanes) {}

    void run() {
        std::vector<Instruction*> combined;
        for (BasicBlock& b : function_)
            for (Instruction& i : b)
                if (combines(i)) combined.push_back(&i);
        // Phis first: loops need theirs before what they are made of.
        for (Instruction* i : combined)
            if (auto* p = llvm::dyn_cast<llvm::PHINode>(i))
                wide_[p] = llvm::PHINode::Create(lanesOf(*p), p->getNumIncomingValues(), "lanes", p->getIterator());
        for (Instruction* i : combined) wide(i);
        for (Instruction* i : combined)
            if (auto* p = llvm::dyn_cast<llvm::PHINode>(i))
                for (unsigned k = 0; k < p->getNumIncomingValues(); k++)
                    llvm::cast<llvm::PHINode>(wide_[p])->addIncoming(wide(p->getIncomingValue(k)), p->getIncomingBlock(k));
        for (Instruction* i : combined) replaceUses(i);
        // A source that is used in another block crosses as lanes too.
        std::vector<Instruction*> leaving;
        for (BasicBlock& b : function_)
            for (Instruction& i : b)
                if (isMask(i) && !combines(i) && !llvm::isa<llvm::PHINode>(i) && !again_.count(&i))
                    for (const llvm::User* u : i.users())
                        if (const auto* at = llvm::cast<Instruction>(u); at->getParent() != &b && !combines(*at)) {
                            leaving.push_back(&i);
                            break;
                        }
        for (Instruction* i : leaving) {
            wide(i);
            replaceUses(i);
        }
        for (Instruction* i : combined) i->replaceAllUsesWith(llvm::PoisonValue::get(i->getType()));
        for (Instruction* i : combined) i->eraseFromParent();
    }

private:
    Value* wide(Value* v) {
        if (auto* c = llvm::dyn_cast<llvm::Constant>(v)) {
            llvm::IRBuilder<> b(v->getContext());
            return b.CreateSExt(c, lanesOf(*v)); // folds
        }
        const auto known = wide_.find(v);
        if (known != wide_.end()) return known->second;
        auto* i = llvm::dyn_cast<Instruction>(v);
        Value* w = nullptr;
        if (!i) {
            llvm::IRBuilder<> b(&function_.getEntryBlock(), function_.getEntryBlock().getFirstInsertionPt());
            w = b.CreateSExt(v, lanesOf(*v), "lanes");
        } else if (!combines(*i)) {
            llvm::IRBuilder<> b(i->getParent(), llvm::isa<llvm::PHINode>(i) ? i->getParent()->getFirstInsertionPt()
                                                                            : std::next(i->getIterator()));
            w = b.CreateSExt(i, lanesOf(*i), "lanes");
        } else if (auto* s = llvm::dyn_cast<llvm::SelectInst>(i)) {
            Value *c = wide(s->getCondition()), *t = wide(s->getTrueValue()), *f = wide(s->getFalseValue());
            llvm::IRBuilder<> b(i);
            w = b.CreateOr(b.CreateAnd(c, t), b.CreateAnd(b.CreateNot(c), f), "lanes");
        } else {
            Value *x = wide(i->getOperand(0)), *y = wide(i->getOperand(1));
            llvm::IRBuilder<> b(i);
            w = b.CreateBinOp(llvm::cast<llvm::BinaryOperator>(i)->getOpcode(), x, y, "lanes");
        }
        wide_[v] = w;
        return w;
    }

    /// Everyone that takes this mask as a mask, and is not one that combines, takes the signs of its lanes.
    void replaceUses(Instruction* narrow) {
        Value* lanes = wide_.at(narrow);
        const bool source = !combines(*narrow);
        std::map<BasicBlock*, Instruction*> there;
        for (llvm::Use& use : llvm::make_early_inc_range(narrow->uses())) {
            auto* user = llvm::cast<Instruction>(use.getUser());
            if (user == lanes || combines(*user) || (source && user->getParent() == narrow->getParent())) continue;
            if (auto* cast = llvm::dyn_cast<llvm::BitCastInst>(user); cast && anyTest(cast, lanes)) continue;
            // In front of the first user of the block: a mask stays one where it is used.
            Instruction*& mask = there[user->getParent()];
            if (!mask || user->comesBefore(mask)) {
                llvm::IRBuilder<> b(user);
                Value* m = b.CreateICmpSLT(lanes, llvm::Constant::getNullValue(lanes->getType()));
                mask = llvm::cast<Instruction>(m);
                again_.insert({mask, 1});
            }
            use.set(mask);
        }
    }

    /// The bits of a mask that are only compared with zero: whether any lane is set is asked of one register.
    bool anyTest(llvm::BitCastInst* bits, Value* lanes) {
        unsigned count = llvm::cast<llvm::FixedVectorType>(lanes->getType())->getNumElements();
        if (count <= registerLanes_ || !bits->getType()->isIntegerTy()) return false;
        for (const llvm::User* u : bits->users()) {
            const auto* c = llvm::dyn_cast<llvm::ICmpInst>(u);
            if (!c || !c->isEquality() || !llvm::isa<llvm::Constant>(c->getOperand(1)) ||
                !llvm::cast<llvm::Constant>(c->getOperand(1))->isNullValue())
                return false;
        }
        llvm::IRBuilder<> b(bits);
        for (; count > registerLanes_; count /= 2) {
            std::vector<int> low, high;
            for (unsigned k = 0; k < count / 2; k++) {
                low.push_back(int(k));
                high.push_back(int(k + count / 2));
            }
            lanes = b.CreateOr(b.CreateShuffleVector(lanes, low), b.CreateShuffleVector(lanes, high));
        }
        Value* m = b.CreateICmpSLT(lanes, llvm::Constant::getNullValue(lanes->getType()));
        Value* few = b.CreateBitCast(m, b.getIntNTy(count));
        if (auto* i = llvm::dyn_cast<Instruction>(m)) again_.insert({i, 1});
        for (llvm::User* u : llvm::make_early_inc_range(bits->users())) {
            auto* c = llvm::cast<llvm::ICmpInst>(u);
            b.SetInsertPoint(c);
            c->replaceAllUsesWith(b.CreateICmp(c->getPredicate(), few, llvm::ConstantInt::get(few->getType(), 0)));
            c->eraseFromParent();
        }
        bits->setOperand(0, llvm::PoisonValue::get(bits->getOperand(0)->getType()));
        return true;
    }

    llvm::Function& function_;
    const unsigned registerLanes_;
    std::map<Value*, Value*> wide_;
    std::map<Value*, char> again_; ///< masks made here of lanes
};

} // namespace

void widenMasks(llvm::Module& m, unsigned registerLanes) {
    for (llvm::Function& f : m)
        if (!f.isDeclaration()) Widener(f, registerLanes).run();
}

} // namespace alpenglow::rsl::jit
