// The insides of the pass that takes structures apart, shared by lower*.cpp. Not for others. The tree is checked: every
// expression has its type, and what is made here has one, too. Where something is wrong, as has been reported, expressions have
// none.
#pragma once
#include "rsl/front/checker.h"
#include "rsl/front/nodes.h"
#include "rsl/front/structures.h"
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace alpenglow::rsl::front {

/// Types of statements, and of numbers that the pass makes.
inline constexpr Type kNone{Base::Void, 0};
inline constexpr Type kNumber{Base::Float, 0};
inline constexpr const char* kElement = "element"; ///< Expr::text of an index into members of an array of structures

/// The use of a variable.
ExprPtr use(Symbol*, Place);
/// left = right of the same type.
ExprPtr assign(ExprPtr left, ExprPtr right, Place);
/// A number.
ExprPtr floatOf(double, Place);
/// What stands in the place of an error.
ExprPtr broken(Place);
/// condition ? yes : no
ExprPtr choose(ExprPtr condition, ExprPtr yes, ExprPtr no, Place);
/// Zero, "" or null.
ExprPtr zeroOf(Base, Place);
/// `varying` and the height from the operands.
void inferFromOperands(Expr&);

/// The pass; used once.
class Lowering {
public:
    /// All outlive the pass.
    Lowering(Program& p, SourceSet& s, Checker& c) : program_(p), sources_(s), checker_(c), structures_(p.structs) {}
    /// Lowers the whole program.
    void run();

private:
    using List = std::vector<ExprPtr>;
    using Symbols = std::vector<Symbol*>;
    using Owner = std::vector<std::unique_ptr<Symbol>>;

    // lower.cpp
    const std::vector<Leaf>& leaves(Type);
    /// The variables of all structures among these, and the functions in the function.
    void splitAll(Owner&);
    void splitAll(Function&);
    Symbol* newSymbol(Owner&, const std::string& name, Type, Storage, Place);
    /// Variables with names that shaders cannot use, one for each leaf; they are declared before the statement.
    Symbols temporary(Type, Place);
    void spill(List& values, Type, List& pre, Place);
    static void flush(List& pre, std::vector<StmtPtr>& out);
    void body(StmtPtr&);
    void declare(StmtPtr, std::vector<StmtPtr>& out);
    void expression(StmtPtr, std::vector<StmtPtr>& out);
    void result(StmtPtr, std::vector<StmtPtr>& out);
    void statement(StmtPtr, std::vector<StmtPtr>& target);
    void function(Function&);
    void shader(Shader&);
    void parameter(ShaderParameter, std::vector<ShaderParameter>& out);
    ExprPtr computed(Function& steps, ExprPtr value);
    List defaultParts(ExprPtr value, const Symbol& parameter);
    void checkAll();
    void checkIndices(Expr&);

    // lower_values.cpp
    /// An expression for a variable of any type, in its parts.
    void valueOf(ExprPtr, Type want, List& pre, List& out);
    /// The parts of a structure; what must happen before goes to `pre`.
    void flatten(ExprPtr, Type want, List& pre, List& out);
    void flattenElement(Expr&, List& pre, List& out);
    void flattenConditional(Expr&, List& pre, List& out);
    void flattenCall(ExprPtr, List& pre, List& out);
    /// The parts of a member.
    void pick(Expr&, List& pre, List& out);
    /// left = right, both structures.
    void assignTo(Expr&, List& pre, List* value = nullptr);
    static bool path(const Expr&);
    static bool inArray(const Expr&);
    bool typed(Expr&);
    void typedAssign(Expr&);
    void arguments(Expr& call, List& pre, List& after);
    void handleArguments(Expr& call, List& pre);
    void brokenArguments(Expr& call);
    bool putsOut(const Expr& call, size_t argument) const;
    static void sequence(ExprPtr&, List pre);
    static void hoist(ExprPtr& place, List& pre);
    /// What happens before an array is there goes to `pre`: an array behind other steps has no place in a tree.
    static void unroll(ExprPtr& array, List& pre);
    void called(ExprPtr&, List& pre, List after);
    /// An expression that is no structure itself.
    void rewrite(ExprPtr&);
    void rewriteParts(ExprPtr&);

    // lower_arrays.cpp
    static bool isSlice(const Expr&);
    ExprPtr bounded(ExprPtr index, int length, const Expr& array, int each);
    static ExprPtr partAt(ExprPtr array, ExprPtr at, int each);
    void elements(ExprPtr array, Type, List& pre, List& out);
    static ExprPtr whole(ExprPtr);
    void store(ExprPtr left, ExprPtr right, Base, Place, List& pre);
    bool rewriteArray(ExprPtr&);
    ExprPtr argument(ExprPtr part, Type, bool output, List& pre, List& after);
    bool changeLength(Expr& call, List& pre);
    void popLast(Expr& call, List& pre, List& out);
    void measure(ExprPtr& call, List& pre);
    void listOf(Expr&, List& pre, List& out);

    Program& program_;
    SourceSet& sources_;
    Checker& checker_;
    const Structures structures_;
    std::map<std::pair<int, int>, std::vector<Leaf>> leaves_;        ///< by structure and length
    std::unordered_map<const Symbol*, Symbols> parts_;               ///< of the variables of structures
    std::unordered_set<const Symbol*> members_;                      ///< all of these parts
    std::unordered_map<const Function*, std::vector<bool>> outputs_; ///< of the parameters as written
    Owner* owner_ = nullptr;
    Type result_ = kNone; ///< of the function being taken apart
    Symbols results_;
    std::vector<StmtPtr>* before_ = nullptr;
    int temporaries_ = 0;
};

} // namespace alpenglow::rsl::front
