// Values to arguments: optional brackets, optional arguments, handles, the parameter list.
#include "ri/parser.h"
#include "ri/requests/request.h"
#include <cmath>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

class Matcher {
public:
    Matcher(std::vector<Value>& v, Call& c, Reporter& r) : values_(v), call_(c), reporter_(r) {}

    bool run() {
        const Request& r = *call_.request;
        call_.arguments.resize(r.args.size());
        for (size_t i = 0; i < r.args.size(); ++i)
            if (!argument(r.args[i], call_.arguments[i], i + 1 == r.args.size())) return false;
        endArray();
        if (r.parameters) parameters();
        else if (index_ < values_.size())
            reporter_.warning(Rie::Syntax, where(), fmt::format("{} takes no more arguments: the rest is ignored", r.name));
        return true;
    }

private:
    SourcePlace where() const {
        if (index_ >= values_.size()) return call_.place;
        return {call_.place.file, values_[index_].line, values_[index_].column};
    }
    bool missing(const ArgSpec& a) {
        std::string_view what = a.form == ArgSpec::Form::Number || a.form == ArgSpec::Form::Int ? "a number"
                                : a.form == ArgSpec::Form::Handle                               ? "a handle"
                                                                                                : "a string";
        std::string message = index_ < values_.size() ? fmt::format("{}: {} is expected here for '{}'", call_.request->name,
                                                                    a.array ? "an array" : what, a.name)
                                                      : fmt::format("{}: argument '{}' is missing", call_.request->name, a.name);
        reporter_.error(index_ < values_.size() ? Rie::Syntax : Rie::MissingData, where(), message,
                        fmt::format("{} {}", call_.request->name, call_.request->signature));
        return false;
    }
    Value* current() { return index_ < values_.size() ? &values_[index_] : nullptr; }
    void advance() {
        ++index_;
        used_ = 0;
    }
    /// A run or array whose numbers are used up is left behind; left-over numbers of an array are named.
    void endArray() {
        Value* v = current();
        if (!v || used_ == 0) return;
        if (used_ < v->numbers.size())
            reporter_.warning(
                Rie::Consistency, where(),
                fmt::format("{}: {} more numbers than it takes are ignored", call_.request->name, v->numbers.size() - used_));
        advance();
    }
    bool takeNumber(double& out) {
        while (Value* v = current()) {
            if (v->kind != Value::Kind::Numbers) return false;
            if (used_ < v->numbers.size()) {
                out = v->numbers[used_++];
                if (used_ == v->numbers.size()) advance();
                return true;
            }
            advance();
        }
        return false;
    }
    bool takeString(std::string& out) {
        endArray();
        Value* v = current();
        if (!v || v->kind != Value::Kind::Strings || v->strings.size() != 1) return false;
        out = std::move(v->strings[0]);
        advance();
        return true;
    }
    bool present(const ArgSpec& a) {
        Value* v = current();
        if (!v) return false;
        if (a.form == ArgSpec::Form::String && !a.array && call_.request->parameters && (values_.size() - index_) % 2 == 0)
            return false; // a parameter list has pairs of names and values
        if (a.form == ArgSpec::Form::String)
            return a.array ? v->array && v->kind != Value::Kind::Numbers : v->kind == Value::Kind::Strings;
        return a.array ? v->array && v->kind != Value::Kind::Strings : v->kind == Value::Kind::Numbers;
    }
    bool whole(const ArgSpec& a, const Argument& out) {
        for (double d : out.numbers) {
            if (!std::isfinite(d) || (a.form == ArgSpec::Form::Int && (d != std::floor(d) || std::fabs(d) > 2147483647.0))) {
                reporter_.error(std::isfinite(d) ? Rie::Syntax : Rie::Range, call_.place,
                                fmt::format("{}: {} for '{}' is not {}", call_.request->name, d, a.name,
                                            a.form == ArgSpec::Form::Int ? "an integer" : "finite"));
                return false;
            }
        }
        return true;
    }

    bool argument(const ArgSpec& a, Argument& out, bool last) {
        if (a.optional && !present(a)) return true;
        out.given = true;
        switch (a.form) {
        case ArgSpec::Form::Number:
        case ArgSpec::Form::Int:
            return (a.array ? numbers(out, last) || missing(a) : count(a, out)) && whole(a, out);
        case ArgSpec::Form::String:
            if (a.array) return strings(out) || missing(a);
            out.strings.resize(1);
            return takeString(out.strings[0]) || missing(a);
        case ArgSpec::Form::Handle:
            return handle(a, out);
        case ArgSpec::Form::Basis: {
            endBeforeString();
            Value* v = current();
            if (v && v->kind == Value::Kind::Strings) {
                out.strings.resize(1);
                return takeString(out.strings[0]) || missing(a);
            }
            ArgSpec sixteen = a;
            sixteen.count = 16;
            return count(sixteen, out) && whole(a, out);
        }
        }
        return false;
    }
    void endBeforeString() { endArray(); }

    bool count(const ArgSpec& a, Argument& out) {
        Value* v = current();
        if (a.otherCount && v && v->kind == Value::Kind::Numbers && used_ == 0 && v->numbers.size() == size_t(a.otherCount)) {
            out.numbers.swap(v->numbers);
            advance();
            return true;
        }
        for (int i = 0; i < a.count; ++i) {
            double d;
            if (!takeNumber(d)) return missing(a);
            out.numbers.push_back(d);
        }
        return true;
    }
    bool numbers(Argument& out, bool last) {
        Value* v = current();
        if (!v || v->kind == Value::Kind::Strings) return false;
        if (v->array && used_ == 0) {
            out.numbers.swap(v->numbers);
            advance();
            return true;
        }
        if (v->array) { // the rest of an array that an earlier argument began: not two arguments in one
            endArray();
            return numbers(out, last);
        }
        double d;
        while (Value* w = current()) {
            if (w->kind != Value::Kind::Numbers || w->array || !takeNumber(d)) break;
            out.numbers.push_back(d);
            if (!last) break;
        }
        return !out.numbers.empty();
    }
    bool strings(Argument& out) {
        endArray();
        Value* v = current();
        if (!v || v->kind == Value::Kind::Numbers) return false;
        out.strings.swap(v->strings);
        advance();
        return true;
    }
    /// Number or string, as text. Left out (old files): the strings that remain are pairs of a parameter list.
    bool handle(const ArgSpec& a, Argument& out) {
        out.strings.resize(1);
        Value* v = current();
        if (v && v->kind == Value::Kind::Strings) {
            if (call_.request->parameters && !v->array && (values_.size() - index_) % 2 == 0) {
                reporter_.warning(Rie::Syntax, where(),
                                  fmt::format("{} has no handle: it cannot be named later", call_.request->name));
                return true;
            }
            return takeString(out.strings[0]) || missing(a);
        }
        double d;
        if (!takeNumber(d)) {
            if (!call_.request->parameters || index_ < values_.size()) return missing(a);
            reporter_.warning(Rie::Syntax, call_.place,
                              fmt::format("{} has no handle: it cannot be named later", call_.request->name));
            return true;
        }
        if (!std::isfinite(d)) return missing(a);
        out.strings[0] = fmt::format("{}", d); // 1 and 1.0 are the same handle, and so is "1"
        return true;
    }

    void parameters() {
        while (index_ < values_.size()) {
            Value& token = values_[index_];
            if (token.kind != Value::Kind::Strings || token.strings.size() != 1) {
                reporter_.error(Rie::Syntax, where(), fmt::format("{}: a parameter name is expected here", call_.request->name));
                advance();
                continue;
            }
            RawParam p{std::move(token.strings[0]), {}, token.line, token.column};
            if (index_ + 1 >= values_.size()) {
                reporter_.error(Rie::MissingData, where(),
                                fmt::format("{}: parameter \"{}\" has no value", call_.request->name, p.token));
                return;
            }
            p.value = std::move(values_[index_ + 1]);
            index_ += 2;
            call_.params.push_back(std::move(p));
        }
    }

    std::vector<Value>& values_;
    Call& call_;
    Reporter& reporter_;
    size_t index_ = 0, used_ = 0;
};

} // namespace

bool matchArguments(std::vector<Value>& values, Call& call, Reporter& reporter) { return Matcher(values, call, reporter).run(); }

} // namespace alpenglow::ri
