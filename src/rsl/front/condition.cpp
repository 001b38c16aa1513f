// #if expressions: integers with all operators of C that make sense on them, and numbers with a fraction, which C refuses there,
// with those of arithmetic and comparison.
#include "base/limits.h"
#include "rsl/front/preprocessor.h"
#include <charconv>
#include <cmath>
#include <optional>

namespace alpenglow::rsl::front {

namespace {

/// A value of the preprocessor. One with a fraction makes real what it is combined with.
struct Value {
    long long whole = 0;
    double real = 0;
    bool isReal = false;
    Value(long long v) : whole(v), real(double(v)) {}
    static Value fraction(double d) {
        Value v(0);
        v.real = d;
        v.isReal = true;
        return v;
    }
    bool yes() const { return isReal ? real != 0 : whole != 0; }
    /// Towards zero, as a cast of C; 0 where there is no such integer.
    long long integer() const { return !isReal ? whole : std::abs(real) < 9e18 ? (long long)real : 0; }
};

class Condition {
public:
    Condition(const std::vector<Token>& t, Place p, SourceSet& s) : tokens_(t), place_(p), sources_(s) {}
    bool run() {
        if (tokens_.empty()) {
            bad(msg::kConditionEmpty);
            return false;
        }
        const Value v = ternary();
        if (!failed_ && at_ < tokens_.size()) bad(msg::kCondition("unexpected '" + std::string(tokens_[at_].text) + "'"));
        return !failed_ && v.yes();
    }

private:
    bool accept(std::string_view s) {
        if (at_ < tokens_.size() && tokens_[at_].is(s)) {
            ++at_;
            return true;
        }
        return false;
    }
    void bad(const Raised& m) {
        if (!failed_) sources_.report(at_ < tokens_.size() ? tokens_[at_].place : place_, m);
        failed_ = true;
        at_ = tokens_.size();
    }
    Value ternary() {
        const Value c = binary(0);
        if (!accept("?")) return c;
        const Value a = ternary();
        if (!accept(":")) bad(msg::kCondition("expected ':'"));
        const Value b = ternary();
        return c.yes() ? a : b;
    }
    Value binary(int level) {
        static const std::vector<std::vector<std::string_view>> kLevels = {
            {"||"}, {"&&"}, {"|"}, {"^"}, {"&"}, {"==", "!="}, {"<=", ">=", "<", ">"}, {"<<", ">>"}, {"+", "-"}, {"*", "/", "%"}};
        if (level == int(kLevels.size())) return unary();
        Value a = binary(level + 1);
        for (;;) {
            std::string_view op;
            for (auto o : kLevels[level])
                if (accept(o)) {
                    op = o;
                    break;
                }
            if (op.empty()) return a;
            a = apply(op, a, binary(level + 1));
        }
    }
    template <class T> static std::optional<bool> compared(std::string_view op, T a, T b) {
        if (op == "==") return a == b;
        if (op == "!=") return a != b;
        if (op == "<=") return a <= b;
        if (op == ">=") return a >= b;
        if (op == "<") return a < b;
        if (op == ">") return a > b;
        return {};
    }
    Value apply(std::string_view op, const Value& l, const Value& r) {
        using U = unsigned long long; // wraps instead of overflowing
        if (op == "||") return l.yes() || r.yes();
        if (op == "&&") return l.yes() && r.yes();
        if (l.isReal || r.isReal) {
            const double a = l.real, b = r.real;
            if (const auto c = compared(op, a, b)) return *c;
            if (op == "+") return Value::fraction(a + b);
            if (op == "-") return Value::fraction(a - b);
            if (op == "*") return Value::fraction(a * b);
            if (op == "/" && b != 0) return Value::fraction(a / b);
        }
        const long long a = l.integer(), b = r.integer();
        if (op == "|") return a | b;
        if (op == "^") return a ^ b;
        if (op == "&") return a & b;
        if (const auto c = compared(op, a, b)) return *c;
        if (op == "<<") return (long long)(U(a) << (b & 63));
        if (op == ">>") return (long long)(U(a) >> (b & 63));
        if (op == "+") return (long long)(U(a) + U(b));
        if (op == "-") return (long long)(U(a) - U(b));
        if (op == "*") return (long long)(U(a) * U(b));
        if (b == 0) {
            bad(msg::kCondition("division by zero"));
            return 0;
        }
        if (b == -1) return op == "/" ? (long long)(0 - U(a)) : 0;
        return op == "/" ? a / b : a % b;
    }
    Value unary() {
        if (++depth_ > limits::kExpressionDepth) {
            bad(msg::kConditionDepth);
            return 0;
        }
        Value v = 0;
        if (accept("!")) v = !unary().yes();
        else if (accept("-")) {
            v = unary();
            v = v.isReal ? Value::fraction(-v.real) : Value((long long)(0ull - (unsigned long long)v.whole));
        } else if (accept("+")) v = unary();
        else if (accept("~")) v = ~unary().integer();
        else if (accept("(")) {
            v = ternary();
            if (!accept(")")) bad(msg::kCondition("expected ')'"));
        } else if (at_ < tokens_.size() && tokens_[at_].kind == Tok::Number) {
            v = number(tokens_[at_]);
            ++at_;
        } else if (at_ < tokens_.size() && tokens_[at_].kind == Tok::Identifier) {
            ++at_; // an unknown name is 0
            if (accept("(")) bad(msg::kCondition("a macro that is not defined is called"));
        } else bad(msg::kCondition("expected a value"));
        --depth_;
        return v;
    }
    /// Versions are compared as 10.0 now and then. A zero in front makes an integer octal, as in C; in a shader it does not.
    Value number(const Token& token) {
        const std::string_view t = token.text;
        const char *begin = t.data(), *end = begin + t.size();
        long long v = 0;
        if (t.size() > 2 && t[0] == '0' && (t[1] | 32) == 'x') {
            std::from_chars(begin + 2, end, v, 16);
            return v;
        }
        const bool real = t.find_first_of(".eE") != t.npos;
        double d = 0;
        std::from_chars(begin, end, d);
        if (real) return Value::fraction(d);
        const size_t digits = std::min(t.find_first_not_of("0123456789"), t.size());
        if (t[0] != '0' || digits < 2 || t.substr(0, digits).find_first_of("89") != t.npos) return d < 9e18 ? (long long)d : 0;
        std::from_chars(begin, begin + digits, v, 8);
        if (double(v) != d)
            sources_.report(token.place, msg::kOctal(t, v),
                            "in the shader itself it is " +
                                std::string(t.substr(std::min(t.find_first_not_of('0'), digits - 1))));
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

bool conditionValue(const std::vector<Token>& t, Place p, SourceSet& s) { return Condition(t, p, s).run(); }

} // namespace alpenglow::rsl::front
