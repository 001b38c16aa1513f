// #if expressions: integers, all operators of C that make sense on them.
#include "base/limits.h"
#include "rsl/front/preprocessor.h"
#include <charconv>

namespace alpenglow::rsl::front {

namespace {

class Condition {
public:
    Condition(const std::vector<Token>& t, Place p, SourceSet& s) : tokens_(t), place_(p), sources_(s) {}
    long long run() {
        if (tokens_.empty()) { bad("#if needs an expression"); return 0; }
        const long long v = ternary();
        if (!failed_ && at_ < tokens_.size()) bad("unexpected '" + std::string(tokens_[at_].text) + "' in the condition");
        return failed_ ? 0 : v;
    }

private:
    bool accept(std::string_view s) {
        if (at_ < tokens_.size() && tokens_[at_].is(s)) { ++at_; return true; }
        return false;
    }
    void bad(std::string m) {
        if (!failed_) sources_.error(at_ < tokens_.size() ? tokens_[at_].place : place_, std::move(m));
        failed_ = true;
        at_ = tokens_.size();
    }
    long long ternary() {
        const long long c = binary(0);
        if (!accept("?")) return c;
        const long long a = ternary();
        if (!accept(":")) bad("expected ':' in the condition");
        const long long b = ternary();
        return c ? a : b;
    }
    long long binary(int level) {
        static const std::vector<std::vector<std::string_view>> kLevels = {
            {"||"}, {"&&"}, {"|"}, {"^"}, {"&"}, {"==", "!="}, {"<=", ">=", "<", ">"}, {"<<", ">>"}, {"+", "-"}, {"*", "/", "%"}};
        if (level == int(kLevels.size())) return unary();
        long long a = binary(level + 1);
        for (;;) {
            std::string_view op;
            for (auto o : kLevels[level])
                if (accept(o)) { op = o; break; }
            if (op.empty()) return a;
            a = apply(op, a, binary(level + 1));
        }
    }
    long long apply(std::string_view op, long long a, long long b) {
        using U = unsigned long long; // wraps instead of overflowing
        if (op == "||") return a || b;
        if (op == "&&") return a && b;
        if (op == "|") return a | b;
        if (op == "^") return a ^ b;
        if (op == "&") return a & b;
        if (op == "==") return a == b;
        if (op == "!=") return a != b;
        if (op == "<=") return a <= b;
        if (op == ">=") return a >= b;
        if (op == "<") return a < b;
        if (op == ">") return a > b;
        if (op == "<<") return (long long)(U(a) << (b & 63));
        if (op == ">>") return (long long)(U(a) >> (b & 63));
        if (op == "+") return (long long)(U(a) + U(b));
        if (op == "-") return (long long)(U(a) - U(b));
        if (op == "*") return (long long)(U(a) * U(b));
        if (b == 0) { bad("division by zero in the condition"); return 0; }
        if (b == -1) return op == "/" ? (long long)(0 - U(a)) : 0;
        return op == "/" ? a / b : a % b;
    }
    long long unary() {
        if (++depth_ > limits::kExpressionDepth) { bad("this condition is nested too deeply"); return 0; }
        long long v = 0;
        if (accept("!")) v = !unary();
        else if (accept("-")) v = (long long)(0ull - (unsigned long long)unary());
        else if (accept("+")) v = unary();
        else if (accept("~")) v = ~unary();
        else if (accept("(")) {
            v = ternary();
            if (!accept(")")) bad("expected ')' in the condition");
        } else if (at_ < tokens_.size() && tokens_[at_].kind == Tok::Number) {
            double d = 0; // dialect versions are compared as 10.0 now and then
            const auto t = tokens_[at_].text;
            if (t.size() > 2 && (t[1] | 32) == 'x') std::from_chars(t.data() + 2, t.data() + t.size(), v, 16);
            else { std::from_chars(t.data(), t.data() + t.size(), d); v = d < 9e18 ? (long long)d : 0; }
            ++at_;
        } else if (at_ < tokens_.size() && tokens_[at_].kind == Tok::Identifier) {
            ++at_; // an unknown name is 0
            if (accept("(")) bad("a macro that is not defined is called in the condition");
        } else bad("expected a value in the condition");
        --depth_;
        return v;
    }
    const std::vector<Token>& tokens_;
    Place place_;
    SourceSet& sources_;
    size_t at_ = 0;
    int depth_ = 0;
    bool failed_ = false;
};

} // namespace

bool conditionValue(const std::vector<Token>& t, Place p, SourceSet& s) { return Condition(t, p, s).run() != 0; }

} // namespace alpenglow::rsl::front
