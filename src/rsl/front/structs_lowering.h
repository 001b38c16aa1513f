// The insides of the pass that takes structures away, shared by structs*.cpp. Not for others.
#pragma once
#include "rsl/front/nodes.h"
#include "rsl/front/parser.h"
#include <map>
#include <unordered_map>

namespace alpenglow::rsl::front {

inline constexpr Type kNone{Base::Void, 0};

/// One plain member of a structure, members of members included.
struct Leaf {
    std::string path; ///< "->origin"
    Type type;
    Storage storage;
    const StructMember* member;
};

inline ExprPtr assign(ExprPtr left, ExprPtr right, Place place) {
    auto e = node(ExprKind::Assign, place, ExprOp::Assign);
    adopt(*e, std::move(left));
    adopt(*e, std::move(right));
    return e;
}

class Lowering {
public:
    Lowering(Unit& u, SourceSet& s) : unit_(u), sources_(s) {}
    void run();

private:
    struct Result {
        Type type;
        std::vector<Type> parameters;
        std::vector<bool> outputs; ///< of the parameters
    };
    using List = std::vector<ExprPtr>;

    // structs.cpp
    /// Of anything else, after an error, a structure without members.
    const StructType& structOf(Type t) const;
    std::string shown(Type t) const;
    /// A structure inside itself would have no end; what changes its length has no place in an array of structures.
    void checkType(size_t index);
    void note(const Function& f);
    std::vector<Leaf> leaves(Type t) const;
    const StructMember* member(Type t, const std::string& name) const;
    int structNamed(const std::string& name) const;
    /// How many structures above t the one of that base is: 0: t is it; -1: t does not extend it, or is no structure.
    int extensions(Type t, Base base) const;
    bool derives(Type t, Base base) const { return extensions(t, base) >= 0; }
    /// The name of the function that a method of this structure, or of one that it extends, became; empty if there is none.
    std::string methodNamed(Type t, const std::string& method, size_t arguments) const;
    /// The structure that an expression is, or void.
    Type typeOf(const Expr& e) const;
    static bool isList(const Expr& e) { return e.kind == ExprKind::ArrayList; }
    /// Whether arguments of these types (void: no structure) fit the parameters, as far as structures say.
    bool accepts(const Result& function, const List& given, const std::vector<Type>& types) const;
    /// The structure that a call of this name gives, or void. Of the functions that its structures fit, the first that gives
    /// `wanted` or what extends it, else the first that gives a structure.
    Type resultOf(const std::string& function, const List& given, Base wanted = Base::Void) const;
    Symbol* newSymbol(const std::string& name, Type type, Storage storage, Place place);
    /// The variables of one variable of a structure; what was declared of it holds for each.
    std::vector<Symbol*> split(const Symbol& s);
    /// A variable with a name that shaders cannot use; it is declared before the statement.
    std::string temporary(Type type, Place place, Storage storage = Storage::Varying);
    void spill(List& values, Type type, List& pre, Place place);
    ExprPtr zero(const Leaf& l, Place place);
    /// Members without a value.
    void defaults(Type t, Place place, List& pre, List& out);
    bool hasDefaults(Type t) const;

    // structs_arrays.cpp
    static bool isSlice(const Expr&);
    static int flatLength(int outer, int inner);
    const StructMember* openMember(Type) const;
    bool arrayPossible(Type, Place);
    ExprPtr bounded(ExprPtr index, int length, const Expr& array, int each);
    static ExprPtr partAt(ExprPtr array, ExprPtr at, int each);
    void elements(ExprPtr array, Type, List& pre, List& out);
    static ExprPtr whole(ExprPtr);
    void store(ExprPtr left, ExprPtr right, Base, Place, List& pre);
    const StructMember* arrayMember(const Expr&) const;
    bool rewriteArray(ExprPtr&);
    static bool inArray(const Expr&);
    bool putsOut(const std::string& function, size_t arguments, size_t i) const;
    static bool isMethod(const std::string& function);
    bool takesAnything(const std::string& function) const;
    bool mustBeVariable(const std::string& function, size_t arguments, size_t i, const Expr& argument) const;
    ExprPtr argument(ExprPtr part, Type, bool output, List& pre, List& after);
    void changeLength(Expr& call, List& pre);
    void popLast(Expr& call, Type, List& pre, List& out);
    void measure(ExprPtr& call, List& pre);
    void listOf(Expr&, Type want, List& pre, List& out);

    // structs_methods.cpp
    /// Methods to functions of the unit, called "Structure->method".
    void methods();
    void methodCall(Expr&);
    void regions(Expr& call);
    void gatherRegion(Stmt&);

    // structs_values.cpp
    /// An expression for a variable of any type, in its parts.
    void valueOf(ExprPtr e, Type want, List& pre, List& out);
    /// Name(a, b, ...) or {a, b, ...}.
    void construct(Type type, Expr& e, List& pre, List& out);
    /// The parts of an expression that is a structure; what must happen before goes to `pre`.
    void flatten(ExprPtr e, List& pre, List& out, Type as = kNone);
    void flattenElement(Expr& e, Type type, List& pre, List& out);
    void flattenConditional(Expr& e, Type type, List& pre, List& out);
    void flattenCall(ExprPtr e, Type type, List& pre, List& out);
    /// The parts of a member.
    void pick(Expr& e, List& pre, List& out);
    /// left = right, both structures.
    void assignTo(Expr& e, List& pre, List* value = nullptr);
    static bool path(const Expr& e);
    void checkArguments(Expr& call);
    /// `after`: what must happen when the call is done.
    /// What the first of the members of a structure says about the whole.
    static Whole wholeOf(Type, size_t members, bool self);
    void arguments(Expr& call, List& pre, List& after);
    void handleArguments(Expr& call, List& pre);
    Base wanted(const std::string& function, size_t arguments, size_t i, Type have) const;
    /// What must happen first, and then the expression, as one expression.
    void sequence(ExprPtr& e, List pre);
    void called(ExprPtr& e, List& pre, List after);
    /// What must happen before a place can be named goes to `pre`.
    static void hoist(ExprPtr& place, List& pre);
    /// An expression that is no structure itself.
    void rewrite(ExprPtr& e);

    // structs_statements.cpp
    static void flush(List& pre, std::vector<StmtPtr>& out);
    void body(StmtPtr& s);
    void declare(StmtPtr s, std::vector<StmtPtr>& out);
    void expression(StmtPtr s, std::vector<StmtPtr>& out);
    void statement(StmtPtr s, std::vector<StmtPtr>& target);
    void function(Function& f);
    void shader(Shader& s);

    Unit& unit_;
    SourceSet& sources_;
    std::vector<std::unordered_map<std::string, Type>> scopes_; ///< void: a variable that is no structure
    std::multimap<std::string, Result> functions_;
    std::vector<std::unique_ptr<Symbol>>* owner_ = nullptr;
    Type result_ = kNone;  ///< of the function being taken apart
    std::string function_; ///< its name
    std::vector<Symbol*> results_;
    std::vector<StmtPtr>* before_ = nullptr;
    int temporaries_ = 0;
    std::vector<size_t> members_; ///< by structure: itself, its members, and those of members that are structures
};

} // namespace alpenglow::rsl::front
