// Unit to Program: names, types, overloads, conversions. Expressions are read twice: `infer` finds, bottom up, every type an
// expression can have and what each would cost; `resolveTypes` picks, top down, the cheapest reading and makes its conversions
// explicit.
#pragma once
#include "rsl/front/conversions.h"
#include "rsl/front/parser.h"
#include "rsl/front/structures.h"
#include <array>
#include <map>
#include <unordered_map>

namespace alpenglow::rsl::front {

/// Checks one unit; used once.
class Checker {
public:
    /// u: is taken apart; p: receives what is checked.
    Checker(SourceSet& s, Unit& u, Program& p) : sources_(s), main_(u), program_(p), structures_(p.structs) {}
    /// Checks all shaders and functions and moves them to the program. Errors are in the set.
    void run();
    /// For lint: warns of calls that are floats because of arithmetic with a number, although a tuple is wanted.
    void warnOfNumbers();
    /// Warns if the value is varying and the variable uniform.
    void assignedToUniform(const Symbol&, const Expr& value);
    /// The parameter of a function is neither uniform nor varying: it is what the argument is.
    void classOfArgument(const Symbol& parameter) { unclassed_.insert(&parameter); }
    /// Whether no shader calls the function: what is wrong with it is a warning.
    bool isUncalled(const Function& f) const { return uncalled_.count(&f) > 0; }

private:
    /// One interpretation of a call.
    struct Choice {
        const Shadeop* shadeop = nullptr;
        const Signature* signature = nullptr;
        Function* function = nullptr; ///< as parsed, or a nested one, which is bound as it is
        bool nested = false;
        const Unit* unit = nullptr;
        Type result;
        int cost = 0;
        size_t positional = 0; ///< arguments before the token/value pairs
    };
    struct Info {
        std::array<int, kBases> cost;
        Type array;            ///< the expression is an array of this type
        int structure = -1;    ///< it can be this structure, the first that the choices give
        bool ofHandle = false; ///< a member or a method of another shader
        int listLength = -1;   ///< it is written {a, b}: an array of whatever its elements become
        bool any = false;      ///< erroneous, and reported: fits everywhere
        bool channel = false;  ///< name[channel] of a string that is no array
        std::vector<Choice> choices;
        /// A call that differs only in what it returns, a float or a tuple, and makes the expression either. Not what is read
        /// from maps and rays: how many channels these bring is in the map, not in the text.
        const Expr* either = nullptr;
        const Expr* number =
            nullptr; ///< such a call that arithmetic with a number has made a float: docs/language.md has the rule
        Info() { cost.fill(kNever); }
    };
    struct ParameterView {
        Type type;
        bool output;
        bool anyText = false; ///< a string where a handle does as well, or the other way about
    };
    static std::vector<ParameterView> views(const Signature&, const Shadeop&);
    static std::vector<ParameterView> views(const Function&);
    struct Scope {
        std::unordered_map<std::string, Symbol*> names;
        std::unordered_multimap<std::string, Function*> functions;
    };

    // program and functions (checker.cpp)
    void checkShader(Shader&);
    /// A function that no shader calls: any predefined variable is allowed, and its errors are warnings.
    void checkStandalone(Function&);
    /// The copy of a function for the shader being checked, made and checked at its first call. Null after an error.
    Function* instance(Function& definition, const Unit& unit, const std::pair<std::string, std::string>& rename, Place call);
    void checkBody(Function&);
    const Unit& rslUnit(const Shadeop&); ///< the parsed text of a shadeop written in RSL
    Symbol* lookup(const std::string&);  ///< in the open scopes, then global(); null if there is none
    Symbol* global(const std::string&);  ///< a predefined variable, which becomes a symbol of the shader at its first use
    void bindExtern(Symbol&);            ///< `extern`: enters the outer variable into the innermost scope
    void declareLocal(Symbol&);          ///< enters a local variable into the innermost scope
    Symbol* tolerated(
        Expr&); ///< a parameter of the shader, or a variable of other kinds of shaders, that is not declared here; else null
    void unknownVariable(Expr&); ///< reports, with the nearest name
    std::vector<std::string> visibleNames();

    // statements (check_statements.cpp)
    void check(StmtPtr&);
    void checkDeclare(Stmt&);
    void checkLight(Stmt&); ///< illuminance, illuminate, solar, gather
    size_t lightPositions(Stmt&, std::vector<ExprPtr>& given);
    bool isGivenString(const std::vector<ExprPtr>& given, size_t i) const;
    void checkReturn(Stmt&);
    void checkLightBody(Stmt&);
    void checkLoopBody(Stmt&);
    void condition(ExprPtr&);     ///< an expression that must be true or false
    void valueOf(ExprPtr&, Type); ///< an expression that is converted to the type
    void whole(ExprPtr&);         ///< an expression of any type
    void initialise(Symbol&, ExprPtr&);
    void resolveInitial(ExprPtr&, Type&);  ///< the value of a variable or member of that type, which may take its length
    static bool endsInReturn(const Stmt&); ///< whether every path through it returns

    // infer (infer.cpp, calls.cpp)
    /// Fills infos_ for the expression and its parts. The reference stays valid until infos_ is cleared.
    Info& infer(Expr&);
    Info& inferPlain(Expr&); ///< what can be no structure; a structure is reported
    void inferVariable(Expr&, Info&);
    void inferIndex(Expr&, Info&);
    void inferBinary(Expr&, Info&);
    void inferAssign(Expr&, Info&);
    void inferConditional(Expr&, Info&);
    void inferCast(Expr&, Info&);
    void inferUnary(Expr&, Info&);
    void inferTuple(Expr&, Info&);
    struct Candidates;
    void inferCall(Expr&, Info&, size_t inferred = 0); ///< `inferred`: arguments that are inferred already
    void inferResults(const Expr& call, Info&);
    void unknownFunction(const Expr& call); ///< reports, with the nearest name
    void inferMember(Expr&, Info&);         ///< members and methods of structures and of other shaders
    /// Whether the call fits the parameters; fills cost and positional of the choice.
    bool match(const std::vector<ParameterView>&, bool repeats, bool pairs, Expr& call, Choice&, bool ignoreOutputs);
    int argumentCost(Expr& argument, const ParameterView& wanted, bool ignoreOutputs);
    int structureCost(const Expr& argument, const ParameterView& wanted, bool ignoreOutputs) const;
    Type wantedType(const ParameterView&, const Expr& argument) const;
    static void bestByArguments(std::vector<Choice>&); ///< removes choices that others beat by their arguments
    void preferArray(const Expr&, Type wanted);
    void noMatch(Expr& call, const std::vector<std::string>& candidates, std::vector<std::string> notes, bool outputsOnly);
    std::string signatureText(const Function&) const; ///< as the shader writes it, structures by their names
    /// Why these parameters do not fit the call, in words; "" when they do.
    std::string whyNot(const std::vector<ParameterView>&, bool repeats, bool pairs, Expr& call);
    std::string describe(Expr&);       ///< the type of an inferred expression, for messages
    static bool isNumber(const Info&); ///< it can be nothing else, but for a last resort
    static const Expr* eitherOf(const Expr& call, const Info&, const std::unordered_map<const Expr*, Info>&);
    void becomesTuple(const Info&, const Expr& settled, Base wanted);
    static std::string componentHint(Base tuple);
    static Base cheapest(const Info&);       ///< Void if it can be no single value
    static int costTo(const Info&, Base to); ///< implicit conversion included; kNever if there is none
    static int operandCost(ExprOp, const Operation&, const Info& left, Base leftAs, const Info& right, Base rightAs);
    bool isVariable(const Expr&) const;                      ///< a variable or an element of one
    bool isText(const Expr&) const;                          ///< a string, possibly computed
    void madeName(Expr& call, size_t at, const Shadeop&);    ///< a pair whose token is computed
    void statementPair(Stmt&, ExprPtr token, ExprPtr value); ///< a pair of illuminance or gather
    void poison(Expr&, Info&);                               ///< after an error: the expression fits everywhere

    // structures (infer_structs.cpp)
    static Type structureOf(const Info&); ///< the structure or array of structures that it can be; void: none
    static bool isStructure(const Info&); ///< it can be nothing else
    bool refuseStructure(const Expr&);    ///< reports a structure where there can be none
    void inferPart(Expr&, Type of, Info&);
    void inferMethod(Expr&, Type of, Info&);
    std::string methodNamed(Type, const std::string& method, size_t arguments) const;
    bool hasFunction(const std::string& name) const;
    bool isArrayCall(const Expr&) const;
    bool inferStructureCall(Expr&, Info&);
    bool takeApart(Expr& call, const Shadeop&);
    void gatherRegion(std::vector<ExprPtr>& given);
    int costToStructure(const Expr&, Type want) const;
    bool wrongStructure(const Expr& call, const std::vector<const Function*>& functions);
    void inferStructureAssign(Expr&, Info&);
    static std::string pathText(const Expr&);
    static bool isBounded(const Expr& member);
    static bool isReceiver(const Expr& call, size_t i);
    // structures (resolve_structs.cpp)
    ExprPtr defaultOf(Type, Place) const;
    ExprPtr defaultOf(const StructMember&, Place) const;
    void resolveConstruct(Expr&, Type);
    void resolveStructures(Expr& list, Type);
    void resolveArrayCall(Expr&);
    void changesLength(const Expr& array);
    void resolvePart(Expr&);
    Storage storageOf(const Expr& part) const;
    void resolveElement(Expr&);
    void resolveStructure(ExprPtr&, Type);
    void resolveStructureKind(ExprPtr&, Type);
    bool isPossible(Symbol&); ///< whether there can be an array of such structures; if not, it is reported and becomes void

    // resolveTypes (resolve.cpp, calls.cpp)
    void resolveTypes(ExprPtr&, Type); ///< to this type, with conversions
    void resolveCheapest(ExprPtr&);
    void resolveAs(ExprPtr&, Base); ///< exactly this type, which must have a finite cost
    void resolveParts(ExprPtr&, Base);
    void resolveHandle(ExprPtr&, Base);
    void resolveCast(ExprPtr&, Base);
    void resolveIndexed(ExprPtr&);
    void resolveCondition(ExprPtr&);
    void resolveArray(ExprPtr&, Type);
    void resolveVariable(ExprPtr&); ///< an output argument: no conversion
    void resolveBinary(ExprPtr&, Base);
    void resolveAssign(ExprPtr&);
    void resolveCall(ExprPtr&, Type result);
    void optionalArguments(Expr&, const Shadeop&);
    void resolvePairs(Expr&, size_t positional, const Shadeop*);
    void bindShadeop(Expr&, const Choice&);
    void bindChannel(const Expr&);
    void bindPrimitiveVariable(const Expr&);
    void bindArrayChange(const Expr&);
    bool allowedHere(const Expr&);
    void classOfResult(Expr&, const Choice&);
    void bindText(Expr&, const Choice&);
    std::pair<std::string, std::string> checkTextPairs(const Expr&);
    bool uniformResult(const Expr&, const Choice&) const;
    void convert(ExprPtr&, Type);       ///< wraps the expression in a Cast unless it has the type
    void written(const Expr& variable); ///< reports a store into a variable that is read-only
    void readsPoint(const Expr&, const std::string& what, bool differs = true);
    bool inConstruct() const;
    void finish(Expr&); ///< sets `varying` from the parts

    SourceSet& sources_;
    Unit& main_; ///< its shaders move to program_ at the end
    Program& program_;
    const Structures structures_;
    std::multimap<std::string, const Function*> methods_; ///< of structures, by "Structure->method"
    // the shader being checked
    Shader* shader_ = nullptr;
    std::optional<ShaderKind> kind_;                              ///< none in a function that no shader calls
    std::vector<std::unique_ptr<Symbol>>* globalOwner_ = nullptr; ///< owns the symbols of global()
    std::unordered_map<std::string, Symbol*> globals_, shaderParameters_;
    std::map<std::pair<const Function*, std::string>, Function*> instances_; ///< by function as parsed and renamed shadeop
    std::unordered_set<const Function*> checking_;                           ///< those on the way to here: a call is recursion
    std::unordered_set<const Function*> used_;                               ///< as parsed, called by some shader
    std::unordered_set<const Function*> uncalled_;                           ///< as checked
    std::unordered_set<const Function*> varyingFunctions_;                   ///< their results vary whatever their arguments are
    std::set<const Symbol*> unclassed_; ///< parameters of functions of no class, which take that of the argument
    std::unordered_map<const Shadeop*, std::unique_ptr<Unit>> rslUnits_;
    std::set<const Shadeop*> reportedUnavailable_; ///< reported once
    /// Parameters, and members of parameters, that are assigned though they are not output: reported once.
    std::set<std::pair<const Symbol*, std::string>> reportedNotOutput_;
    struct MadeNumber {
        std::string name;
        Base wanted;
    };
    std::map<std::array<int, 3>, MadeNumber> madeNumbers_; ///< by place, for warnOfNumbers()
    // the function being checked
    const Unit* unit_ = nullptr;                  ///< whose functions it sees
    Function* function_ = nullptr;                ///< null in the body of a shader
    std::vector<Scope> scopes_;                   ///< the innermost is last
    int loops_ = 0;                               ///< around the current statement
    int instanceDepth_ = 0;                       ///< calls of instance() that have not returned
    std::map<const Function*, int> callHeight_;   ///< how deep the calls inside of a function are nested
    bool foreignLight_ = false;                   ///< in the block of a light in another kind of shader, which has been reported
    std::unordered_map<const Expr*, Info> infos_; ///< of the current whole expression
};

} // namespace alpenglow::rsl::front
