#include "rsl/jit/llvm/masks.h"
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Instructions.h>
#include <map>
#include <vector>

namespace alpenglow::rsl::jit {

namespace {

bool isMask(const llvm::Value& v) { return v.getType()->isVectorTy() && v.getType()->getScalarType()->isIntegerTy(1); }

llvm::Type* lanesOf(const llvm::Value& mask) {
    return llvm::VectorType::get(llvm::Type::getInt32Ty(mask.getContext()),
                                 llvm::cast<llvm::VectorType>(mask.getType())->getElementCount());
}

llvm::Value* maskOf(llvm::Value* lanes, llvm::BasicBlock* block) {
    llvm::IRBuilder<> b(block, block->getFirstInsertionPt());
    return b.CreateICmpSLT(lanes, llvm::Constant::getNullValue(lanes->getType()));
}

} // namespace

void widenMasks(llvm::Module& m) {
    std::vector<llvm::PHINode*> phis;
    std::vector<llvm::Instruction*> leaving; // used in another block than their own
    for (llvm::Function& f : m)
        for (llvm::BasicBlock& b : f)
            for (llvm::Instruction& i : b) {
                if (!isMask(i)) continue;
                if (auto* p = llvm::dyn_cast<llvm::PHINode>(&i)) {
                    phis.push_back(p);
                    continue;
                }
                for (const llvm::User* u : i.users())
                    if (llvm::cast<llvm::Instruction>(u)->getParent() != &b || llvm::isa<llvm::PHINode>(u)) {
                        leaving.push_back(&i);
                        break;
                    }
            }
    std::map<llvm::Value*, llvm::Value*> wide;
    for (llvm::PHINode* p : phis)
        wide[p] = llvm::PHINode::Create(lanesOf(*p), p->getNumIncomingValues(), "lanes", p->getIterator());
    for (llvm::Instruction* i : leaving) {
        llvm::IRBuilder<> b(i->getParent(), std::next(i->getIterator()));
        wide[i] = b.CreateSExt(i, lanesOf(*i), "lanes");
    }
    for (llvm::PHINode* p : phis)
        for (unsigned k = 0; k < p->getNumIncomingValues(); k++) {
            llvm::Value* v = p->getIncomingValue(k);
            const auto known = wide.find(v);
            llvm::IRBuilder<> b(p->getIncomingBlock(k)->getTerminator());
            llvm::cast<llvm::PHINode>(wide[p])->addIncoming(known != wide.end() ? known->second : b.CreateSExt(v, lanesOf(*p)),
                                                            p->getIncomingBlock(k));
        }
    for (auto& [narrow, lanes] : wide) {
        std::map<llvm::BasicBlock*, llvm::Value*> there; // the mask again, once for each block that asks for it
        const auto* home = llvm::cast<llvm::Instruction>(narrow)->getParent();
        const bool phi = llvm::isa<llvm::PHINode>(narrow);
        for (llvm::Use& use : llvm::make_early_inc_range(narrow->uses())) {
            auto* user = llvm::cast<llvm::Instruction>(use.getUser());
            if (llvm::isa<llvm::PHINode>(user) || (!phi && user->getParent() == home)) continue;
            llvm::Value*& mask = there[user->getParent()];
            if (!mask) mask = maskOf(lanes, user->getParent());
            use.set(mask);
        }
    }
    for (llvm::PHINode* p : phis) p->replaceAllUsesWith(llvm::PoisonValue::get(p->getType()));
    for (llvm::PHINode* p : phis) p->eraseFromParent();
}

} // namespace alpenglow::rsl::jit
