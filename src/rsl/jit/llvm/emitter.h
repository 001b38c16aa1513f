// From our IR to LLVM IR, lanes explicit. One Emitter makes one kernel: either a loop over the strips of a batch, or a coroutine
// a strip.
#pragma once
#include "rsl/jit/llvm/shape.h"
#include "rsl/jit/module.h"
#include <array>
#include <functional>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>
#include <map>
#include <stdexcept>

namespace alpenglow::rsl::jit {

/// A kernel that cannot be compiled; the text becomes ModuleResult::error.
struct CodegenError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A component with its derivative parts du, dv, duu, duv, dvv. A null part is exactly zero and costs nothing.
struct Jet {
    llvm::Value* v = nullptr;        ///< the value; null: zero
    std::array<llvm::Value*, 5> d{}; ///< derivatives, in that order
};
using Val = std::vector<Jet>; ///< one Jet a component

/// Storage of an array: rows of <W x float> (or of floats when uniform), element after element, component after component, part
/// after part.
struct ArrayStorage {
    llvm::Value* base = nullptr;    ///< address of the first row
    int length = 0, components = 0; ///< elements; components of an element
    ir::Kind element = ir::Kind::None;
    Shape shape;                   ///< of each component
    llvm::Value* stride = nullptr; ///< inputs: floats between rows (i64); null: rows are packed
    bool readOnly = false;         ///< it is an input
    /// Rows of an element.
    int rows() const { return components * (1 + __builtin_popcount(shape.parts)); }
};

/// Writes the functions of one kernel into an LLVM module; used once.
class Emitter {
public:
    /// runtime: bitcode of the shadeops; width: lanes of a vector.
    Emitter(const ModuleRequest&, const Shapes&, int width, llvm::Module&, llvm::Module& runtime);
    /// The function of a kernel that does not suspend: a loop over strips.
    void emitLoopKernel();
    /// The functions of a suspending kernel: one coroutine a strip.
    void emitCoroutine();
    /// String constants of the kernel, in the order of KernelCall::strings.
    const std::vector<std::string>& strings() const { return shared_->strings; }
    /// Bytes of KernelCall::memory that a kernel that does not suspend wants.
    uint64_t localBytes() const { return shared_->localBytes; }

private:
    /// One component as it passes a call: lanes or one number, and which parts there are.
    struct Slot {
        bool varying;
        uint8_t parts;
    };
    /// A Function as machine code for one set of argument slots; results component after component.
    struct Made {
        llvm::Function* function = nullptr;
        std::vector<std::vector<Slot>> results;
    };
    struct Shared {
        std::vector<std::string> strings;
        std::map<std::string, llvm::Function*> wrappers;
        std::map<std::string, Made> made;
        uint64_t stackBytes = 0; ///< of arrays and scratch rows on the stack, all functions of the kernel together
        uint64_t localBytes = 0; ///< of those in the kernel's local memory (KernelCall::memory, or behind a coroutine's frame)
    };
    /// The emitter of a function that `caller` calls.
    Emitter(const Emitter& caller, const Shapes&);
    // functions.cpp
    void call(const ir::Inst*);
    Made function(const ir::Inst*, const std::vector<std::vector<Slot>>& arguments);
    void leaves(const ir::Region&);
    Slot slot(const Jet&) const;
    llvm::Type* slotType(ir::Kind, bool varying);
    void passTypes(ir::Kind, const Slot&, std::vector<llvm::Type*>&);
    void pass(const Jet&, const Slot&, std::vector<llvm::Value*>&);
    Jet receive(ir::Kind, const Slot&, const std::function<llvm::Value*()>& next);
    using B = llvm::IRBuilder<>;
    // frame.cpp: the function around the body
    void beginFunction(llvm::Function*);
    void loadCall(llvm::Value* call);
    llvm::Value* field(size_t offset, llvm::Type*, const char* name);
    void finishScratch();
    void setMask(llvm::Value* firstPoint);
    // emitter.cpp: tree walk, control flow
    void region(const ir::Region&);
    void inst(const ir::Inst*);
    void emitIf(const ir::Inst*);
    int cost(const ir::Region&) const;
    void emitLoop(const ir::Inst*);
    llvm::Value* withinTurns(const ir::Inst* loop, bool varying, llvm::BasicBlock* exit);
    void allowTurn(const ir::Inst* loop, llvm::Value* turn, llvm::BasicBlock* inside, llvm::BasicBlock* exit);
    void keepLeft(const ir::Inst* loop, llvm::Value* running, const std::vector<Val>& before, std::vector<Val>& next);
    llvm::Value* spent();
    void spend(llvm::Value* turns, llvm::Value* mask);
    void emitLightLoop(const ir::Inst*);
    llvm::Value* any(llvm::Value* mask);
    llvm::Value* stopped();
    llvm::BasicBlock* block(const char* name);
    const Val& value(const ir::Inst*);
    void define(const ir::Inst*, int index, Val);
    Val zero(ir::Kind, Shape);
    Val conform(Val, ir::Kind, Shape);
    Val phis(ir::Kind, Shape);
    void addIncoming(Val& phi, const Val& v, llvm::BasicBlock* from);
    Val keepLanes(llvm::Value* running, const Val& next, const Val& old);
    Val dropDead(Val next, const Val& old, llvm::Value* leaving);
    Val selectLanes(llvm::Value* mask, const Val& a, const Val& b);
    // arithmetic.cpp
    void arithmetic(const ir::Inst*);
    Val logic(const ir::Inst*);
    Jet add(Jet, Jet), sub(Jet, Jet), mul(Jet, Jet), div(Jet, Jet, const ir::Inst* divisor), neg(Jet);
    Jet select(llvm::Value* c, Jet a, Jet b);
    Jet derive(Jet, bool v);
    llvm::Value* fadd(llvm::Value*, llvm::Value*);
    llvm::Value* fsub(llvm::Value*, llvm::Value*);
    llvm::Value* fmul(llvm::Value*, llvm::Value*);
    llvm::Value* lanes(llvm::Value*);         ///< splats a scalar
    void match(llvm::Value*&, llvm::Value*&); ///< both scalars or both lanes
    llvm::Value* number(float);
    // memory.cpp
    void input(const ir::Inst*);
    void output(const ir::Inst*);
    void arrayNew(const ir::Inst*);
    llvm::Value* localMemory(uint64_t bytes, uint64_t align, llvm::Instruction* place);
    void arrayInput(const ir::Inst*);
    void arrayLoad(const ir::Inst*);
    void arrayStore(const ir::Inst*);
    llvm::Value* elementIndex(llvm::Value* index, int length);
    llvm::Value* rowPointer(const ArrayStorage&, llvm::Value* element, int row);
    llvm::Value* loadRow(const ArrayStorage&, llvm::Value* element, int row);
    void storeRow(const ArrayStorage&, llvm::Value* element, int row, llvm::Value* v);
    llvm::Value* inputBase(int index);
    llvm::Value* constantString(const std::string&);
    // calls.cpp
    void runtime(const ir::Inst*);
    llvm::Function* runtimeFunction(const std::string& symbol, int order);
    llvm::Function* wrapper(const std::string& symbol, int order, int in, int out);
    std::vector<llvm::Value*> callRuntime(llvm::Function*, const std::vector<llvm::Value*>& in, int out);
    void service(const ir::Inst*);
    void mark(const ir::Inst*);
    void flatten(const ir::Inst* arg, std::vector<llvm::Value*>& rows);
    void storeRows(llvm::Value* block, const std::vector<llvm::Value*>& rows);
    llvm::Value* row(llvm::Value* block, int index);
    void callService(int site, llvm::Value* in, llvm::Value* out);
    llvm::Value* maskBits();
    llvm::Value* scratch(int which, int rows);
    Val fromRows(ir::Kind, llvm::Value* block, int& row);
    llvm::Value* toFloatRow(llvm::Value*);
    void suspend();

    [[noreturn]] void fail(const std::string&);

    const ModuleRequest& request_;
    const ir::Kernel& kernel_;
    const Shapes& shapes_;
    const int width_;
    llvm::Module& module_;
    llvm::Module& runtime_;
    llvm::LLVMContext& context_;
    B b_, entry_; ///< the place of emission; the end of the entry block (uniform loads)
    llvm::Type *f32_, *i1_, *i32_, *i64_, *ptr_, *void_;
    llvm::VectorType *vf_, *vi_, *vm_;
    llvm::Function* function_ = nullptr;
    llvm::BasicBlock* entryBlock_ = nullptr;
    llvm::Value *call_ = nullptr, *first_ = nullptr, *first64_ = nullptr, *mask_ = nullptr, *stop_ = nullptr, *stride_ = nullptr;
    llvm::Value *in_ = nullptr, *out_ = nullptr, *stringIds_ = nullptr, *n_ = nullptr;
    llvm::Value* turns_ =
        nullptr;    ///< lanes of integers in memory: what nested loops have turned; functions get it from their caller
    int loops_ = 0; ///< around the place of emission, a function's callers taken as one
    llvm::Value* memory_ = nullptr; ///< of arrays that the stack has no room for; functions get it from their caller
    bool rootMask_ = true;          ///< the mask is that of the strip: lanes beyond n may be overwritten
    // Scratch rows: arguments and results of runtime calls (promoted to registers), of services (escape).
    struct Scratch {
        llvm::Instruction* place = nullptr;
        int rows = 0;
    };
    std::array<Scratch, 4> scratch_;
    std::unordered_map<const ir::Inst*, std::vector<Val>> values_;
    std::unordered_map<const ir::Inst*, ArrayStorage> arrays_;
    std::map<int, llvm::Value*> inputBases_;
    std::map<int, Val> uniformInputs_;
    std::shared_ptr<Shared> shared_;
    std::map<std::string, llvm::Value*> stringValues_;
    bool wrapCalls_ = false;
    // coroutine
    llvm::BasicBlock *suspendBlock_ = nullptr, *cleanupBlock_ = nullptr;
};

/// Whether noise and its like are called through wrappers in this kernel, and how many vectors it works on at a time.
struct Plan {
    int vectors = 1;
    bool wrapCalls = false; ///< noise is called through wrappers
};
/// Of a kernel with these shapes.
Plan plan(const ModuleRequest&, const Shapes&);

} // namespace alpenglow::rsl::jit
