// Expressions, by the precedence table of RISpec 3.2, 13.1.
#include "base/limits.h"
#include "rsl/front/parser.h"
#include <charconv>
#include <cmath>

namespace alpenglow::rsl::front {

ExprPtr Parser::node(ExprKind kind, Place place, ExprOp op) {
    auto e = std::make_unique<Expr>();
    e->kind = kind;
    e->place = place;
    e->op = op;
    return e;
}

void Parser::grow(Expr& parent, const Expr& child) {
    parent.height = std::max(parent.height, child.height + 1);
    if (parent.height > limits::kTreeHeight) fail(parent.place, msg::kTooLong(limits::kTreeHeight));
}

void Parser::adopt(Expr& parent, ExprPtr child) {
    grow(parent, *child);
    parent.args.push_back(std::move(child));
}

ExprPtr Parser::expression() { return assignment(); }

ExprPtr Parser::assignment() {
    Depth depth(*this);
    auto left = conditional();
    static constexpr struct {
        std::string_view text;
        ExprOp op;
    } kOps[] = {{"=", ExprOp::Assign}, {"+=", ExprOp::Add}, {"-=", ExprOp::Sub}, {"*=", ExprOp::Mul}, {"/=", ExprOp::Div}};
    for (const auto& o : kOps)
        if (at(o.text)) {
            auto e = node(ExprKind::Assign, take().place, o.op);
            adopt(*e, std::move(left));
            adopt(*e, at("{") ? arrayList() : assignment());
            return e;
        }
    return left;
}

bool Parser::atStep(size_t k) const {
    return (peek(k).is("+") || peek(k).is("-")) && peek(k + 1).text == peek(k).text && !peek(k + 1).space &&
           !peek(k + 1).lineStart;
}

/// variable += 1 or variable -= 1
ExprPtr Parser::step(ExprPtr variable, const Token& sign) {
    sources_.report(sign.place, msg::kNotRslStep(std::string(sign.text) + std::string(sign.text), sign.text));
    auto e = node(ExprKind::Assign, sign.place, sign.text == "+" ? ExprOp::Add : ExprOp::Sub);
    auto one = node(ExprKind::Number, sign.place);
    one->number = 1;
    adopt(*e, std::move(variable));
    adopt(*e, std::move(one));
    return e;
}

ExprPtr Parser::effect() {
    if (atStep(0) && peek(2).kind == Tok::Identifier) {
        const Token& sign = take();
        take();
        return step(postfix(), sign);
    }
    auto e = expression();
    // The value of i++ is not used here: it is i += 1.
    if (e->kind == ExprKind::Binary && e->text == "++") return std::move(e->args[0]);
    return e;
}

ExprPtr Parser::conditional() {
    auto c = binary(3);
    if (!at("?")) return c;
    auto e = node(ExprKind::Conditional, take().place);
    adopt(*e, std::move(c));
    adopt(*e, assignment());
    expect(":", "between the two values of '?'");
    adopt(*e, assignment());
    return e;
}

namespace {
struct BinaryOp {
    std::string_view text;
    int level;
    ExprOp op;
};
constexpr BinaryOp kBinary[] = {
    {"||", 3, ExprOp::Or},  {"&&", 4, ExprOp::And},    {"==", 5, ExprOp::Equal},     {"!=", 5, ExprOp::NotEqual},
    {"<", 5, ExprOp::Less}, {">", 5, ExprOp::Greater}, {"<=", 5, ExprOp::LessEqual}, {">=", 5, ExprOp::GreaterEqual},
    {"+", 6, ExprOp::Add},  {"-", 6, ExprOp::Sub},     {"^", 7, ExprOp::Cross}, // looser than * and /, unlike anywhere else
    {"*", 8, ExprOp::Mul},  {"/", 8, ExprOp::Div},     {"%", 8, ExprOp::None},  // % is mod()
    {".", 9, ExprOp::Dot}};
} // namespace

ExprPtr Parser::binary(int level) {
    auto left = unary();
    // Precedence climbing, with the recursion of the right operands bounded by the number of levels.
    for (;;) {
        const BinaryOp* found = nullptr;
        if (peek().kind == Tok::Punct)
            for (const auto& b : kBinary)
                if (b.text == peek().text) found = &b;
        if (!found || found->level < level) return left;
        auto e = node(found->op == ExprOp::None ? ExprKind::ShadeopCall : ExprKind::Binary, take().place, found->op);
        if (found->op == ExprOp::None) {
            sources_.report(e->place, msg::kNotRslMod);
            e->text = "mod";
        }
        adopt(*e, std::move(left));
        adopt(*e, binary(found->level + 1));
        left = std::move(e);
    }
}

ExprPtr Parser::unary() {
    if (at("-") || at("!") || at("+")) {
        Depth depth(*this);
        if (atStep(0) && peek(2).kind == Tok::Identifier)
            sources_.report(peek().place, msg::kTwoSigns(std::string(2, peek().text[0])),
                            "the value before is " + std::string(peek(2).text) + std::string(2, peek().text[0]));
        const Token& t = take();
        if (t.text == "+") return unary();
        auto operand = unary();
        if (t.text == "-" && operand->kind == ExprKind::Number && !std::signbit(operand->number)) {
            operand->number = -operand->number;
            operand->place = t.place;
            return operand;
        }
        auto e = node(ExprKind::Unary, t.place, t.text == "-" ? ExprOp::Negate : ExprOp::Not);
        adopt(*e, std::move(operand));
        return e;
    }
    if (atTypeName()) return castExpression();
    return postfix();
}

/// type ["space"] operand: a constructor, a conversion, or the choice of a return type.
ExprPtr Parser::castExpression() {
    Depth depth(*this);
    auto e = node(ExprKind::Cast, peek().place);
    e->type = takeType();
    if (e->type.base == Base::Void) fail(e->place, msg::kVoidValue);
    if (at("[") && peek(1).is("]")) {
        take();
        take();
        e->type.array = -1;
    }
    if (peek().kind == Tok::String && !isStringLike(e->type.base)) {
        size_t k = 0;
        while (peek(k).kind == Tok::String) ++k;
        const Token& n = peek(k);
        const bool operand = n.is("(") || n.kind == Tok::Number || n.kind == Tok::Identifier || n.is("-") || n.is("{");
        if (operand) {
            e->space = primary();
            grow(*e, *e->space);
        }
    }
    if (peek().kind == Tok::Identifier && !isStringLike(e->type.base) && e->type.base != Base::Float && !atTypeName() &&
        (peek(1).kind == Tok::Number || peek(1).kind == Tok::Identifier)) { // matrix space 1, with the space in a variable
        e->space = primary();
        grow(*e, *e->space);
    }
    ExprPtr operand = unary();
    if (e->space && operand->kind == ExprKind::ArrayList) return inSpace(std::move(operand), e->type, e->space.get());
    adopt(*e, std::move(operand));
    return e;
}

ExprPtr Parser::postfix() {
    ExprPtr e;
    if (inObject_ && at("this")) {
        if (peek(1).is("->") && peek(2).kind == Tok::Identifier) take(), take(); // a member or a method of its own
        else {
            e = node(ExprKind::String, take().place);
            e->text = "(this)";
            e->handle = true;
        }
    }
    if (!e) e = primary();
    for (;;) {
        if (at("[")) {
            auto index = node(ExprKind::Index, take().place);
            adopt(*index, std::move(e));
            adopt(*index, expression());
            expect("]", "after an index");
            e = std::move(index);
        } else if (at("->")) {
            const Place place = take().place;
            if (peek().kind != Tok::Identifier) failHere(msg::kExpectedName("a member behind '->'", shown()));
            auto member = node(ExprKind::Member, place);
            member->text = std::string(take().text);
            adopt(*member, std::move(e));
            if (accept("(")) {
                member->kind = ExprKind::Method;
                arguments(member->args);
                for (const auto& a : member->args) grow(*member, *a);
            }
            e = std::move(member);
        } else if (atStep(0) && (e->kind == ExprKind::Variable || e->kind == ExprKind::Index) &&
                   (peek(2).kind == Tok::End ||
                    (peek(2).kind == Tok::Punct && !peek(2).is("(") && !peek(2).is("!") && !peek(2).is("{")))) {
            const Token& sign = take();
            take();
            // The value is the one before: (i += 1) - 1.
            auto before = node(ExprKind::Binary, sign.place, sign.text == "+" ? ExprOp::Sub : ExprOp::Add);
            before->text = "++";
            auto one = node(ExprKind::Number, sign.place);
            one->number = 1;
            adopt(*before, step(std::move(e), sign));
            adopt(*before, std::move(one));
            return before;
        } else return e;
    }
}

ExprPtr Parser::primary() {
    const Token& t = peek();
    if (t.kind == Tok::Number) {
        auto e = node(ExprKind::Number, t.place);
        const char *const begin = t.text.data(), *const end = begin + t.text.size();
        const auto r = std::from_chars(begin, end, e->number);
        const bool suffix = r.ptr + 1 == end && (*r.ptr == 'f' || *r.ptr == 'F');
        if (r.ec == std::errc::result_out_of_range) {
            // Out of the range of double: the sign of the exponent says whether it is too large or too small.
            e->number = t.text.find("e-") != t.text.npos || t.text.find("E-") != t.text.npos ? 0 : 3e38;
        } else if (r.ec != std::errc() || (r.ptr != end && !suffix)) {
            fail(t.place, msg::kBadNumber(t.text.substr(0, 40)));
        }
        if (suffix) sources_.report(t.place, msg::kNumberSuffix(t.text));
        take();
        return e;
    }
    if (t.kind == Tok::String) {
        auto e = node(ExprKind::String, t.place);
        while (peek().kind == Tok::String) e->text += stringValue(take().text);
        return e;
    }
    if (t.is("(")) return parenthesis();
    if (t.is("{")) return arrayList();
    if (t.kind == Tok::Identifier) {
        static const std::unordered_set<std::string_view> kReserved = {
            "if", "else", "while", "for", "break", "continue", "return", "uniform", "varying", "output", "extern"};
        if (kReserved.count(t.text)) failHere(msg::kExpectedExpression(shown()));
        take();
        std::string name(t.text);
        if (structs_.count(name) && at(":") && peek(1).is(":") && peek(2).kind == Tok::Identifier && peek(3).is("(")) {
            take(), take(); // Base::method(...): the method as the extended structure has it
            name += "::" + std::string(take().text);
        }
        if (!at("(")) {
            auto e = node(ExprKind::Variable, t.place);
            e->text = std::string(t.text);
            return e;
        }
        take();
        auto e = node(ExprKind::ShadeopCall, t.place);
        e->text = name;
        arguments(e->args);
        for (const auto& a : e->args) grow(*e, *a);
        return e;
    }
    failHere(msg::kExpectedExpression(shown()));
}

/// Behind '(': expressions up to and with ')'.
void Parser::arguments(std::vector<ExprPtr>& out) {
    Depth depth(*this);
    while (!accept(")")) {
        out.push_back(at("{") ? arrayList() : assignment());
        if (accept(",")) continue;
        if (accept(")")) return;
        if (at(";") && !peek(1).lineStart && !peek(1).is("}")) { // some write calls as they write parameter lists
            sources_.report(take().place, msg::kSemicolonInCall);
            continue;
        }
        failHere(msg::kExpectedArgumentEnd(shown()));
    }
}

ExprPtr Parser::parenthesis() {
    Depth depth(*this);
    const Place place = take().place;
    if (atTypeName() && peek(1).is(")")) {
        const std::string type(peek().text);
        sources_.report(place, msg::kCastParentheses, "write " + type + "(...) or " + type + " x");
        ExprPtr e = node(ExprKind::Cast, place);
        e->type = takeType();
        take();
        adopt(*e, unary());
        return e;
    }
    auto e = expression();
    if (accept(")")) return e;
    if (!at(",")) failHere(msg::kExpectedClosing(shown()));
    auto tuple = node(ExprKind::Tuple, place);
    adopt(*tuple, std::move(e));
    while (accept(",")) adopt(*tuple, expression());
    expect(")", "after the components");
    if (tuple->args.size() == 16) tuple->kind = ExprKind::MatrixTuple;
    else if (tuple->args.size() != 3) sources_.report(place, msg::kTupleLength(tuple->args.size()));
    return tuple;
}

ExprPtr Parser::arrayList() {
    Depth depth(*this);
    auto e = node(ExprKind::ArrayList, take().place);
    while (!at("}")) {
        if (!e->args.empty() && at("...")) { // {0, ...}: the last element again for the rest
            e->text = take().text;
            break;
        }
        adopt(*e, assignment());
        if (e->args.size() > size_t(limits::kShaderArray)) fail(e->place, msg::kArrayElements(limits::kShaderArray));
        if (!accept(",")) break;
    }
    expect("}", "after the elements of an array");
    if (e->args.empty()) e->text = "{}"; // an open array begins with no elements; those of others are filled up with zeros
    return e;
}

} // namespace alpenglow::rsl::front
