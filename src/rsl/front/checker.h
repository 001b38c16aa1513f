// Unit to Program: names, types, overloads, conversions. Expressions are read twice: `infer` finds, bottom up, every type an
// expression can have and what each would cost; `resolveTypes` picks, top down, the cheapest reading and makes its conversions
// explicit.
#pragma once
#include "rsl/front/conversions.h"
#include "rsl/front/parser.h"
#include <array>
#include <map>
#include <unordered_map>

namespace alpenglow::rsl::front {

class Checker {
public:
    Checker(SourceSet& s, Unit& u, Program& p) : sources_(s), main_(u), program_(p) {}
    void run();
    /// For lint: warns of calls that are floats because of arithmetic with a number, although a tuple is wanted.
    void warnOfNumbers();

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
        Type array;           ///< the expression is an array of this type
        int listLength = -1;  ///< it is written {a, b}: an array of whatever its elements become
        bool any = false;     ///< erroneous, and reported: fits everywhere
        bool channel = false; ///< name[channel] of a string that is no array
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
        Whole whole{};
    };
    static std::vector<ParameterView> views(const Signature&, const Shadeop&);
    static std::vector<ParameterView> views(const Function&);
    struct Scope {
        std::unordered_map<std::string, Symbol*> names;
        std::unordered_multimap<std::string, Function*> functions;
    };

    // program and functions (checker.cpp)
    void checkShader(Shader&);
    void checkStandalone(Function&);
    Function* instance(Function& definition, const Unit& unit, const std::pair<std::string, std::string>& rename, Place call);
    void checkBody(Function&);
    const Unit& rslUnit(const Shadeop&);
    Symbol* lookup(const std::string&);
    Symbol* global(const std::string&);
    void bindExtern(Symbol&);
    void declareLocal(Symbol&);
    Symbol* tolerated(Expr&);
    void unknownVariable(Expr&);
    std::vector<std::string> visibleNames();

    // statements (check_statements.cpp)
    void check(StmtPtr&);
    void checkDeclare(Stmt&);
    void checkLight(Stmt&);
    size_t lightPositions(Stmt&, std::vector<ExprPtr>& given);
    bool isGivenString(const std::vector<ExprPtr>& given, size_t i) const;
    void checkReturn(Stmt&);
    void checkLightBody(Stmt&);
    void checkLoopBody(Stmt&);
    void condition(ExprPtr&);
    void valueOf(ExprPtr&, Type);
    void whole(ExprPtr&);
    void initialise(Symbol&, ExprPtr&);
    void assignedToUniform(const Symbol&, const Expr&);
    static bool endsInReturn(const Stmt&);

    // infer (infer.cpp, calls.cpp)
    Info& infer(Expr&);
    void inferVariable(Expr&, Info&);
    void inferIndex(Expr&, Info&);
    void inferBinary(Expr&, Info&);
    void inferAssign(Expr&, Info&);
    void inferConditional(Expr&, Info&);
    void inferCast(Expr&, Info&);
    void inferUnary(Expr&, Info&);
    void inferTuple(Expr&, Info&);
    struct Candidates;
    void inferCall(Expr&, Info&);
    void inferResults(const Expr& call, Info&);
    void unknownFunction(const Expr& call);
    void inferMember(Expr&, Info&);
    bool match(const std::vector<ParameterView>&, bool repeats, bool pairs, Expr& call, Choice&, bool ignoreOutputs);
    int argumentCost(Expr& argument, const ParameterView& wanted, bool ignoreOutputs);
    Type wantedType(const ParameterView&, const Expr& argument) const;
    static void bestByArguments(std::vector<Choice>&);
    void preferArray(const Expr&, Type wanted);
    void noMatch(Expr& call, const std::vector<std::string>& candidates, std::vector<std::string> notes, bool outputsOnly);
    std::string signatureText(const Function&) const; ///< as the shader writes it, structures by their names
    /// Why these parameters do not fit the call, in words; "" when they do.
    std::string whyNot(const std::vector<ParameterView>&, bool repeats, bool pairs, Expr& call);
    std::string describe(Expr&);
    static bool isNumber(const Info&); ///< it can be nothing else, but for a last resort
    static const Expr* eitherOf(const Expr& call, const Info&, const std::unordered_map<const Expr*, Info>&);
    void becomesTuple(const Info&, const Expr& settled, Base wanted);
    static std::string componentHint(Base tuple);
    static Base cheapest(const Info&);
    static int costTo(const Info&, Base to);
    static int operandCost(ExprOp, const Operation&, const Info& left, Base leftAs, const Info& right, Base rightAs);
    bool isVariable(const Expr&) const;
    bool isText(const Expr&) const;
    void madeName(Expr& call, size_t at, const Shadeop&);
    void statementPair(Stmt&, ExprPtr token, ExprPtr value);
    void poison(Expr&, Info&);

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
    void convert(ExprPtr&, Type);
    void written(const Expr& variable);
    void readsPoint(const Expr&, const std::string& what, bool differs = true);
    bool inConstruct() const;
    void finish(Expr&);

    SourceSet& sources_;
    Unit& main_;
    Program& program_;
    // the shader being checked
    Shader* shader_ = nullptr;
    std::optional<ShaderKind> kind_; ///< none in a function that no shader calls
    std::vector<std::unique_ptr<Symbol>>* globalOwner_ = nullptr;
    std::unordered_map<std::string, Symbol*> globals_, shaderParameters_;
    std::map<std::pair<const Function*, std::string>, Function*> instances_;
    std::unordered_set<const Function*> checking_, used_, varyingFunctions_;
    std::set<const Symbol*> unclassed_; ///< parameters of functions that are neither uniform nor varying: what they are given
    std::unordered_map<const Shadeop*, std::unique_ptr<Unit>> rslUnits_;
    std::set<const Shadeop*> reportedUnavailable_;
    std::set<const Symbol*> toldNotOutput_; ///< parameters that are assigned though they are not output: reported once
    struct MadeNumber {
        std::string name;
        Base wanted;
    };
    std::map<std::array<int, 3>, MadeNumber> madeNumbers_; ///< by place, for warnOfNumbers()
    // the function being checked
    const Unit* unit_ = nullptr;
    Function* function_ = nullptr;
    std::vector<Scope> scopes_;
    int loops_ = 0;
    int instanceDepth_ = 0;
    std::map<const Function*, int> callHeight_; ///< how deep the calls inside of a function are nested
    bool foreignLight_ = false;                 ///< in the block of a light in another kind of shader, which has been reported
    std::unordered_map<const Expr*, Info> infos_;
};

} // namespace alpenglow::rsl::front
