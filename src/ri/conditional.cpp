// Expressions of IfBegin and ElseIf (docs/design/ri.md): numbers, 'strings', $variables, defined(), concat(), the operators of C,
// and =~ for patterns (PRMan).
#include "base/limits.h"
#include "base/pattern.h"
#include "ri/interpreter.h"
#include <cctype>
#include <cmath>
#include <fast_float/fast_float.h>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

class Evaluator {
public:
    Evaluator(const std::string& t, const ConditionLookup& l, Reporter& r, const SourcePlace& p)
        : text_(t), lookup_(l), reporter_(r), place_(p) {}

    bool run() {
        ConditionValue v = binary(0);
        skip();
        if (!failed_ && at_ < text_.size()) fail("unexpected text");
        return !failed_ && truth(v);
    }

private:
    static bool truth(const ConditionValue& v) { return v.isString ? !v.text.empty() : v.number != 0; }
    static ConditionValue num(double d) { return {false, d, {}}; }
    static std::string asText(const ConditionValue& v) { return v.isString ? v.text : fmt::format("{}", v.number); }

    void fail(const std::string& what) {
        if (!failed_)
            reporter_.error(Rie::Syntax, place_,
                            fmt::format("condition \"{}\": {} at character {}", text_.substr(0, 80), what, at_ + 1),
                            "it counts as false");
        failed_ = true;
    }
    void skip() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    bool take(std::string_view op) {
        skip();
        if (text_.compare(at_, op.size(), op) != 0) return false;
        at_ += op.size();
        return true;
    }

    /// Precedence climbing: || && (== != =~) (< <= > >=) (+ -) (* /).
    ConditionValue binary(int level) {
        static const std::vector<std::vector<std::string_view>> kOps = {
            {"||"}, {"&&"}, {"==", "!=", "=~"}, {"<=", ">=", "<", ">"}, {"+", "-"}, {"*", "/"}};
        if (level == int(kOps.size())) return unary();
        ConditionValue a = binary(level + 1);
        while (!failed_) {
            std::string_view op;
            for (std::string_view o : kOps[size_t(level)])
                if (take(o)) {
                    op = o;
                    break;
                }
            if (op.empty()) break;
            // The side that cannot matter is parsed, but unknown variables in it are no error.
            bool decided = (op == "||" && truth(a)) || (op == "&&" && !truth(a));
            quiet_ += decided;
            ConditionValue b = binary(level + 1);
            quiet_ -= decided;
            a = apply(op, a, b);
        }
        return a;
    }
    ConditionValue apply(std::string_view op, const ConditionValue& a, const ConditionValue& b) {
        if (op == "||") return num(truth(a) || truth(b));
        if (op == "&&") return num(truth(a) && truth(b));
        if (op == "=~") return num(matches(asText(a), asText(b)));
        if (a.isString || b.isString) {
            int c = asText(a).compare(asText(b));
            if (op == "==") return num(c == 0);
            if (op == "!=") return num(c != 0);
            if (op == "<") return num(c < 0);
            if (op == "<=") return num(c <= 0);
            if (op == ">") return num(c > 0);
            if (op == ">=") return num(c >= 0);
            fail(fmt::format("'{}' needs numbers", op));
            return num(0);
        }
        double x = a.number, y = b.number;
        if (op == "==") return num(x == y);
        if (op == "!=") return num(x != y);
        if (op == "<") return num(x < y);
        if (op == "<=") return num(x <= y);
        if (op == ">") return num(x > y);
        if (op == ">=") return num(x >= y);
        if (op == "+") return num(x + y);
        if (op == "-") return num(x - y);
        if (op == "*") return num(x * y);
        if (y == 0) {
            if (!quiet_) fail("division by zero");
            return num(0);
        }
        return num(x / y);
    }
    /// As match() of the shading language: whether the pattern occurs anywhere in the text.
    bool matches(const std::string& text, const std::string& pattern) {
        std::string error;
        const auto p = Pattern::make(pattern, error);
        if (!p && !quiet_) fail("'" + pattern.substr(0, 40) + "' is no pattern (" + error + ")");
        return p && p->occurs(text);
    }
    ConditionValue unary() {
        if (++depth_ > limits::kConditionDepth) {
            fail("nested too deeply");
            --depth_;
            return num(0);
        }
        ConditionValue v;
        skip();
        bool notEqual = text_.compare(at_, 2, "!=") == 0;
        if (!notEqual && take("!")) v = num(!truth(unary()));
        else if (take("-")) v = num(-unary().number);
        else v = primary();
        --depth_;
        return v;
    }
    std::string word() {
        size_t from = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' ||
                                      text_[at_] == ':' || text_[at_] == '.'))
            ++at_;
        return text_.substr(from, at_ - from);
    }
    std::string variableName() {
        if (take("(")) { // $(expression): the name is computed
            ConditionValue v = binary(0);
            if (!take(")")) fail("')' expected");
            return asText(v);
        }
        const bool braces = take("{");
        std::string w = word();
        if (w.empty()) fail("a variable name is expected");
        else if (braces && !take("}")) fail("'}' expected");
        return w;
    }
    ConditionValue variable() {
        std::string name = variableName();
        if (failed_) return num(0);
        if (auto v = lookup_(name, true)) return *v;
        if (!quiet_)
            reporter_.once("ri:condition:" + name, Severity::Error, Rie::BadToken, place_,
                           fmt::format("condition: ${} is not set", name), "defined($" + name + ")");
        return num(0);
    }
    ConditionValue primary() {
        skip();
        if (at_ >= text_.size()) {
            fail("the expression ends early");
            return num(0);
        }
        char c = text_[at_];
        if (take("(")) {
            ConditionValue v = binary(0);
            if (!take(")")) fail("')' expected");
            return v;
        }
        if (take("$")) return variable();
        if (c == '\'' || c == '"') {
            ConditionValue v{true, 0, {}};
            for (++at_; at_ < text_.size() && text_[at_] != c; ++at_) {
                if (text_[at_] == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] == c) ++at_; // the quote itself
                v.text += text_[at_];
            }
            if (at_ >= text_.size()) fail("a string has no end");
            else ++at_;
            return v;
        }
        if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
            double d = 0;
            auto r = fast_float::from_chars(text_.data() + at_, text_.data() + text_.size(), d);
            if (r.ec != std::errc()) {
                fail("not a number");
                return num(0);
            }
            at_ = size_t(r.ptr - text_.data());
            return num(d);
        }
        std::string w = word();
        if (w == "defined" && take("(")) {
            take("$");
            skip();
            std::string name = variableName();
            if (!take(")")) fail("')' expected");
            return num(!failed_ && lookup_(name, false).has_value());
        }
        if (w == "concat" && take("(")) {
            ConditionValue v{true, 0, {}};
            do { v.text += asText(binary(0)); } while (!failed_ && v.text.size() < limits::kTokenBytes && take(","));
            if (!take(")")) fail("')' expected");
            return v;
        }
        if (w == "true" || w == "false") return num(w == "true");
        if (w.empty()) fail("a value is expected");
        return {true, 0, w}; // a bare word is a string
    }

    const std::string& text_;
    const ConditionLookup& lookup_;
    Reporter& reporter_;
    const SourcePlace& place_;
    size_t at_ = 0;
    int depth_ = 0, quiet_ = 0;
    bool failed_ = false;
};

} // namespace

bool evaluateCondition(const std::string& text, const ConditionLookup& lookup, Reporter& reporter, const SourcePlace& place) {
    return Evaluator(text, lookup, reporter, place).run();
}

} // namespace alpenglow::ri
