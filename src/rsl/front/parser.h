// Tokens to an unchecked syntax tree. Names are still text (Expr::text), conversions and overloads are the checker's business.
#pragma once
#include "rsl/front/preprocessor.h"
#include "rsl/front/structs.h"
#include <functional>
#include <span>
#include <unordered_set>

namespace alpenglow::rsl::front {

/// A shader object as written: its body declares the members, then the methods.
struct ClassDefinition {
    std::unique_ptr<Shader> shader;
    std::unordered_set<std::string> publics; ///< members and methods that other shaders see
};

/// `plugin "name";`
struct PluginUse {
    std::string name;
    Place place; ///< of the word plugin
};

/// What one text declares, unchecked.
struct Unit {
    std::vector<PluginUse> plugins;                              ///< in the order of the text
    std::vector<std::unique_ptr<Shader>> shaders;                ///< in the order of the text
    std::vector<std::unique_ptr<Function>> functions;            ///< outside of shaders
    std::vector<ClassDefinition> classes;                        ///< in the order of the text
    std::vector<StructType> structs;                             ///< outside of shaders
    std::vector<std::vector<std::unique_ptr<Function>>> methods; ///< of each structure, until they are functions
    bool incomplete = false; ///< text is missing (an include that was not found): it may have declared unknown names
    std::unordered_set<std::string> skipped; ///< names in text that was skipped after an error, which may have declared them
    /// Whether the name may be declared in text that was not read.
    bool hides(const std::string& n) const {
        missed = missed || incomplete;
        return incomplete || skipped.count(n);
    }
    mutable bool missed = false; ///< an unknown name may be declared in text that is missing
};

/// Builds the syntax tree of a unit from one or more texts.
class Parser {
public:
    /// s: receives the texts.
    explicit Parser(SourceSet& s) : sources_(s) {}
    /// Reads one more text into the unit; it sees the structures of those before. Never fails: errors are in the set, and what
    /// could be read is in the unit.
    void read(const Preprocessed&);
    /// What the texts so far declare.
    Unit& unit() { return unit_; }

private:
    struct SyntaxError {};
    struct Owner {
        std::vector<std::unique_ptr<Symbol>>* symbols = nullptr;
        std::vector<std::unique_ptr<Function>>* nested = nullptr;
    };
    struct Specifiers {
        bool output = false, isExtern = false, isConstant = false, any = false;
        Storage storage = Storage::Unspecified;
        Place place;
    };

    // tokens
    const Token& peek(size_t k = 0) const { return (*tokens_)[std::min(at_ + k, tokens_->size() - 1)]; }
    const Token& take();
    bool at(std::string_view s) const { return peek().is(s); }
    bool accept(std::string_view s);
    void expect(std::string_view s, const char* where);
    void expectSemicolon(const char* after);
    void expectSeparator(const char* after); ///< a ';' that ends no statement
    [[noreturn]] void fail(Place, const Raised&, std::string hint = {});
    [[noreturn]] void failHere(const Raised& expected);
    Place endOfLast() const;
    bool atCut() const { return sources_.cut && peek().kind == Tok::End; } ///< the rest is missing, as was reported
    void skipBalanced();
    void recover();
    void skippedFrom(size_t begin); ///< the tokens from there to here were not understood
    bool atTypeName(size_t k = 0) const;
    bool atStructWord() const {
        return at("struct") && structs_.count(std::string(peek(1).text)) && peek(2).kind == Tok::Identifier;
    }
    bool atName() const; ///< of a variable to be declared; old shaders call theirs vector, normal, matrix
    const Token& takeName();
    Type takeType();
    std::string shown() const;

    // declarations (parser.cpp)
    void topLevel();
    void takeAnnotations(Shader&);
    Shader* lastShader();
    void shader(ShaderKind);
    bool plugin(); ///< at `plugin "name"`, allowed at file level and in place of a statement
    void extends(StructType&);
    void structure(); // parser_objects.cpp
    void structureBody(StructType&, std::vector<size_t>& methods);
    void structureMember(StructType&, std::vector<size_t>& methods);
    void structureMethods(size_t index, const std::vector<size_t>& methods);
    void skipMethod(size_t begin, std::vector<size_t>& methods);
    void shaderObject();
    void takeAccess();
    std::unique_ptr<Function> function(Type result, bool typed);
    void parameters(Owner, std::vector<ShaderParameter>* shader, std::vector<Symbol*>* function,
                    std::vector<ExprPtr>* defaults = nullptr);
    Specifiers specifiers();
    bool notYet(Place, const char* what);
    Type dimensions(Type, ExprPtr* length = nullptr);
    ExprPtr declaredSpace(Type);
    ExprPtr inSpace(ExprPtr value, Type, const Expr* space);
    int constantLength(const Expr&, Place, bool open);
    Symbol* declare(Owner, const Token& name, Type, const Specifiers&);
    bool functionFollows() const;
    std::string written(size_t begin) const;

    // statements (parser_statements.cpp)
    StmtPtr block();
    void statements(Stmt& block);
    StmtPtr statement();
    StmtPtr statementOnce();
    StmtPtr keywordStatement();
    StmtPtr conditional(StmtKind);
    StmtPtr jump(StmtKind);
    StmtPtr returnStatement();
    bool atDeclaration();
    void refuseTypeName();
    StmtPtr declaration(bool member = false);
    StmtPtr forLoop();
    StmtPtr doLoop();
    StmtPtr lightStatement(StmtKind);
    StmtPtr make(StmtKind, Place);
    StmtPtr expressionStatement(ExprPtr);
    StmtPtr effects();

    // expressions (parser_expressions.cpp)
    ExprPtr expression();
    ExprPtr assignment();
    ExprPtr conditional();
    ExprPtr binary(int level);
    ExprPtr unary();
    ExprPtr castExpression();
    ExprPtr postfix();
    ExprPtr primary();
    ExprPtr parenthesis();
    ExprPtr arrayList();
    void arguments(std::vector<ExprPtr>&);
    ExprPtr node(ExprKind, Place, ExprOp = ExprOp::None);
    /// Hangs a child in and keeps the height below the limit.
    void adopt(Expr& parent, ExprPtr child);
    /// An expression for its effect: "i++" and "++i" are taken, with a warning, as "i += 1".
    ExprPtr effect();
    bool atStep(size_t k) const; ///< "++" or "--" without a blank between
    ExprPtr step(ExprPtr variable, const Token& sign);
    void grow(Expr& parent, const Expr& child);

    struct Depth {
        explicit Depth(Parser&);
        ~Depth() { --parser.depth_; }
        Parser& parser;
    };

    const std::vector<Token>* tokens_ = nullptr; ///< of the text being read
    std::span<const Annotation> annotations_;    ///< of the text, those that no shader has yet
    SourceSet& sources_;
    Unit unit_;
    size_t at_ = 0;
    int depth_ = 0;
    bool tooDeep_ = false;
    std::vector<StmtPtr> after_;                     ///< statements that a declaration adds behind itself
    Owner owner_;                                    ///< of the function or shader being read
    std::unordered_set<std::string_view> typeWords_; ///< variables of it called like the types that came later
    bool inObject_ = false;                          ///< `this` is the shader object being read
    bool returnsValue_ = false;                      ///< a `return expression` was seen in it
    std::unordered_map<std::string, int> structs_;   ///< index in Unit::structs
    std::unordered_set<std::string> reported_;       ///< names reported as not yet available
    size_t lastError_ = size_t(-1);
};

/// The type of a keyword; nothing for other words.
std::optional<Base> baseNamed(std::string_view);
/// The kind of a keyword that begins a shader; nothing for other words.
std::optional<ShaderKind> shaderKindNamed(std::string_view);

} // namespace alpenglow::rsl::front
