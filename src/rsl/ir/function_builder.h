// Writes instructions, variables and control flow of a kernel, without knowing what they stand for in a shader. Builder lowers
// the syntax tree with it. Not for others.
#pragma once
#include "rsl/ir/build.h"
#include "rsl/ir/edit.h"
#include "rsl/messages/messages.h"
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace alpenglow::rsl::ir {

/// The kind that values of a type have; arrays are Kind::Array, void is Kind::None.
Kind kindOf(Type);
/// A place of the syntax tree as messages show it; a file that is not among `files` is shown as "".
SourcePlace sourcePlace(const std::vector<std::string>& files, const Place&);

/// Variables are slots of an environment. A slot has a value, an instruction; null where it has none yet. set() notes the value
/// before in a log, so that a Scope can go back to it: a region sees what was set before it, and what it sets itself leaves it
/// as results only.
class FunctionBuilder {
public:
    FunctionBuilder(const FunctionBuilder&) = delete;
    FunctionBuilder& operator=(const FunctionBuilder&) = delete;

protected:
    using Code = std::function<void()>;

    FunctionBuilder(Kernel& k, const std::vector<std::string>& files, const KernelOptions& o, Diagnostics& d)
        : k_(k), options_(o), diagnostics_(d), leaves_(k), files_(&files) {}
    ~FunctionBuilder() = default;
    /// The value that a predefined variable has before the shader sets it.
    virtual Inst* initialGlobal(const std::string& name, Type) = 0;

    // Values (function_values.cpp)

    /// Appends an instruction with one result, or returns what it simplifies to. Past limits::kInlinedInstructions the build
    /// fails.
    Inst* emit(Op, Kind, std::vector<Inst*> args, int index = 0);
    Inst* constant(float f) { return leaves_.constant(Kind::Float, f); }
    Inst* constant(int n) { return constant(static_cast<float>(n)); }
    Inst* boolean(bool b) { return leaves_.constant(Kind::Bool, b ? 1.0f : 0.0f); }
    Inst* zero(Kind);
    /// Parameter of a region, the next one.
    Inst* parameter(Region&, Kind);
    /// An input of the kernel. Each name is one input, whatever asks for it.
    Inst* input(const std::string& name, Type type, bool uniform);
    /// A Runtime call; several results when `results` has more than one.
    std::vector<Inst*> runtime(const std::string& symbol, std::vector<Inst*> args, std::vector<Kind> results);
    Inst* runtime1(const std::string& symbol, std::vector<Inst*> args, Kind k) {
        return runtime(symbol, std::move(args), {k})[0];
    }
    /// A Service or Request at a site of its own; its results.
    std::vector<Inst*> call(Op, Site, std::vector<Inst*> args);
    /// Appends a value to the arguments of a call.
    static void addArgument(Site&, std::vector<Inst*>& args, Inst* value, Type);
    /// Appends a pair of a call whose value is a constant string.
    static void addPair(Site&, const std::string& name, const std::string& text);
    /// Appends a pair of a call. A value that is no constant string becomes an argument.
    static void addPair(Site&, std::vector<Inst*>& args, const std::string& name, Inst* value, Type);
    Inst* coerce(Inst*, Kind);
    Inst* coerce(Inst*, Type);
    Inst* dot(Inst*, Inst*);
    Inst* cross(Inst*, Inst*);
    Inst* multiply(Inst* a, Inst* b); ///< matrices
    Inst* negative(Inst*);
    Inst* isNot0(Inst*);
    Inst* component(Inst* triple, Inst* at);                  ///< the nearest one; NaN is component 0
    Inst* withComponent(Inst* triple, Inst* at, Inst* value); ///< the same triple with another value there
    Inst* transformBy(Inst* matrix, Inst* value, Base);       ///< as what the base says: point, vector, normal or matrix
    Inst* colourSpace(const std::string& from, const std::string& to, Inst*);
    Inst* newArray(Base, int length);
    Inst* load(Inst* array, int index);
    void store(Inst* array, int index, Inst* value);

    // Variables

    int newSlot(Inst* value);
    Inst*& value(int slot) { return env_[static_cast<size_t>(slot)]; }
    Inst* value(int slot) const { return env_[static_cast<size_t>(slot)]; }
    const Symbol* symbol(int slot) const { return symbols_[static_cast<size_t>(slot)]; }
    bool isGlobal(int slot) const { return symbol(slot) && symbol(slot)->origin == Symbol::Origin::Global; }
    int slot(const Symbol*);
    /// The value of a variable; zero where nothing has set it.
    Inst* get(int slot);
    void set(int slot, Inst* value);

    /// The environment as it is now, to come back to after building the body of a function with one of its own.
    struct Environment {
        std::vector<Inst*> values;
        size_t log;
        Region* region;
    };
    Environment environment() const { return {env_, log_.size(), region_}; }
    void goBackTo(const Environment&);

    // Control flow (function_control.cpp)

    /// Builds into a region while it is open. Closing it goes back to the region around, and to the values that variables had.
    class Scope {
    public:
        Scope(FunctionBuilder&, Region&);
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;
        ~Scope() { close(); }
        /// Slots that have been set since it was opened, with their values.
        std::map<int, Inst*> changes() const;
        void close();

    private:
        FunctionBuilder& builder_;
        Region* const around_;
        const size_t mark_;
        bool open_ = true;
    };
    friend class Scope;
    /// If with everything assigned in a branch yielded; extra values of the branches, too.
    std::vector<Inst*> branch(Inst* condition, const std::function<std::vector<Inst*>()>& yes,
                              const std::function<std::vector<Inst*>()>& no);
    /// The same for branches without values. `no` may be null.
    void when(Inst* condition, const Code& yes, const Code& no = nullptr);
    /// Which of these slots a loop carries from turn to turn: those with a value that is no array. Their values become operands
    /// and results of the loop.
    std::vector<int> carry(Inst* loop, const std::set<int>& assigned);
    /// Makes the carried slots parameters of a region of the loop, behind those that it has.
    void enterTurn(const Inst* loop, Region&, const std::vector<int>& carried);
    /// Makes the results of the loop the values of what it carried.
    void leaveLoop(Inst* loop, const std::vector<int>& carried);
    /// A loop over the numbers from `first` to `end`, exclusive. `each` must assign no variable.
    void countLoop(Inst* first, Inst* end, const std::function<void(Inst* at)>& each);
    /// Builds what is done with each of `count` elements: one after the other, so that short arrays become values; a loop where
    /// there are many, as code for each would take minutes to compile.
    void everyElement(int count, const std::function<void(Inst* at)>& each);

    // Places and messages

    /// An error ends the build; the same warning is reported once a place.
    void report(const Place&, const Raised&, std::string hint = {});
    Place shownPlace(const Place& p) const { return ownText_ ? *ownText_ : p; }
    /// The same, with the file added to the kernel's list of files, so that run-time messages can name it.
    Place keptPlace(const Place& p) const {
        Place kept = shownPlace(p);
        if (kept.file >= 0) kept.file += fileBase_;
        return kept;
    }

    Kernel& k_;
    const KernelOptions& options_;
    Diagnostics& diagnostics_;
    Leaves leaves_;
    Region* region_ = nullptr;     ///< that instructions are appended to
    Place place_;                  ///< of the instructions that come next
    std::optional<Place> ownText_; ///< inside a function of the renderer that is written in RSL: where the shader calls it
    const std::vector<std::string>* files_; ///< those that places refer to just now
    int fileBase_ = 0;                      ///< where they begin among the kernel's
    std::unordered_map<const Symbol*, int> slots_;
    std::map<std::string, int> globals_; ///< slots of predefined variables
    std::vector<Inst*> env_;             ///< by slot
    std::set<std::string> writes_;       ///< predefined variables that the shader sets
    bool failed_ = false;

private:
    std::vector<const Symbol*> symbols_; ///< by slot; null for the builder's own
    std::vector<std::pair<int, Inst*>> log_;
    std::unordered_map<std::string, Inst*> inputs_;
};

} // namespace alpenglow::rsl::ir
