#include "ri/direct.h"
#include "ri/binarynumber.h"
#include "ri/lexer.h"
#include "ri/requests/request.h"
#include <array>

namespace alpenglow::ri {
namespace {

constexpr size_t kMargin = 16; // bytes that every token but long ones has behind it
static_assert(kMargin > kNumberBytes && kMargin > 1 + 15 /* of a short string */ - 1);

/// What a byte begins. Other: the general way knows.
enum class Begins : unsigned char { Other, Number, Text, Floats, Open, Close, Request };

constexpr std::array<Begins, 256> kBegins = [] {
    std::array<Begins, 256> t{};
    for (unsigned c = 0200; c <= 0217; ++c) t[c] = Begins::Number;
    t[0244] = t[0245] = Begins::Number;
    for (unsigned c = 0220; c <= 0241; ++c) t[c] = Begins::Text; // lengths of up to two bytes
    t[0317] = t[0320] = Begins::Text;
    for (unsigned c = 0310; c <= 0313; ++c) t[c] = Begins::Floats;
    t['['] = Begins::Open;
    t[']'] = Begins::Close;
    t[0246] = Begins::Request;
    return t;
}();

/// Room for n numbers, which are not defined; what one large request had is not kept for ever.
void room(std::vector<double>& v, size_t n) {
    constexpr size_t kSmall = 4096;
    if (v.capacity() > kSmall && n < v.capacity() / 8) v = {};
    v.resize(n);
}

bool allFinite(const std::vector<double>& v) {
    double sum = 0;
    for (const double d : v) sum += d - d; // 0 for finite ones
    return sum == 0;
}

bool allWhole(const std::vector<double>& v) {
    bool good = true;
    for (const double d : v) good &= d == std::floor(d) && std::fabs(d) <= 2147483647.0;
    return good;
}

class Request1 {
public:
    Request1(const Lexer& l, const Ahead& a) : lexer_(l), at_(a) {}
    bool arguments(const Request& r, Call& call) {
        for (size_t i = 0; i < r.args.size(); ++i) {
            Argument& x = call.arguments[i];
            x.given = true;
            if (!argument(r.args[i], x)) return false;
        }
        return true;
    }
    Begins next();
    bool param(RawParam& p) {
        place(p.line, p.column);
        if (!text(p.token)) return false;
        const Begins b = next();
        place(p.value.line, p.value.column);
        return value(b, p.value);
    }
    const Ahead& here() const { return at_; }

private:
    void place(int& line, int& column) const {
        line = at_.line;
        column = at_.column();
    }
    bool argument(const ArgSpec& a, Argument& x);
    bool count(size_t& n);
    bool floats(std::vector<double>& out);
    bool text(std::string& out);
    bool value(Begins b, Value& v);
    bool array(Value& v);

    const Lexer& lexer_;
    Ahead at_;
};

/// What comes next. Blanks before it are passed, and what it begins has the margin behind it.
Begins Request1::next() {
    for (;; ++at_.p) {
        if (size_t(at_.end - at_.p) < kMargin) return Begins::Other;
        if (*at_.p == '\n') {
            ++at_.line;
            at_.mark = at_.p + 1;
            at_.markColumn = 1;
        } else if (*at_.p != ' ') return kBegins[static_cast<unsigned char>(*at_.p)];
    }
}

/// The length of an array of floats, all of which are there.
bool Request1::count(size_t& n) {
    const unsigned bytes = static_cast<unsigned char>(*at_.p) - 0310u + 1;
    n = 0;
    for (unsigned i = 1; i <= bytes; ++i) n = n << 8 | static_cast<unsigned char>(at_.p[i]);
    if (n > size_t(at_.end - at_.p - 1 - bytes) / 4) return false;
    at_.p += 1 + bytes;
    return true;
}

bool Request1::floats(std::vector<double>& out) {
    size_t n;
    if (!count(n)) return false;
    room(out, n);
    floatsAt(at_.p, n, out.data());
    at_.p += 4 * n;
    return true;
}

bool Request1::text(std::string& out) {
    const auto byte = [&](int i) { return unsigned(static_cast<unsigned char>(at_.p[i])); };
    const unsigned c = byte(0);
    if (c >= 0317) {
        const bool two = c == 0320;
        const std::string* known = lexer_.stringOfCode(two ? byte(1) << 8 | byte(2) : byte(1));
        if (!known) return false;
        out = *known;
        at_.p += two ? 3 : 2;
        return true;
    }
    const size_t head = c < 0240 ? 1 : c == 0240 ? 2 : 3, n = c < 0240 ? c - 0220 : c == 0240 ? byte(1) : byte(1) << 8 | byte(2);
    if (n > size_t(at_.end - at_.p) - head) return false;
    out.assign(at_.p + head, n);
    at_.p += head + n;
    return true;
}

/// Texts or numbers in brackets, not both.
bool Request1::array(Value& v) {
    v.array = true;
    v.kind = Value::Kind::Empty;
    size_t texts = 0;
    v.numbers.clear();
    ++at_.p;
    for (;;) {
        const Begins b = next();
        if (b == Begins::Text && v.kind != Value::Kind::Numbers) {
            v.kind = Value::Kind::Strings;
            if (v.strings.size() == texts) v.strings.emplace_back();
            if (!text(v.strings[texts++])) return false;
        } else if (b == Begins::Number && v.kind != Value::Kind::Strings) {
            v.kind = Value::Kind::Numbers;
            double d;
            at_.p = numberAt(at_.p, d);
            v.numbers.push_back(d);
        } else if (b == Begins::Close) {
            ++at_.p;
            v.strings.resize(texts);
            return true;
        } else return false;
    }
}

bool Request1::value(Begins b, Value& v) {
    if (b == Begins::Open) return array(v);
    v.array = b == Begins::Floats;
    v.kind = b == Begins::Text ? Value::Kind::Strings : Value::Kind::Numbers;
    if (b == Begins::Text) {
        v.numbers.clear();
        v.strings.resize(1);
        return text(v.strings[0]);
    }
    v.strings.clear();
    if (b == Begins::Floats) {
        if (!floats(v.numbers)) return false;
        if (v.numbers.empty()) v.kind = Value::Kind::Empty;
        return true;
    }
    v.numbers.clear();
    for (; b == Begins::Number; b = next()) { // bare numbers in a row are one value
        double d;
        at_.p = numberAt(at_.p, d);
        v.numbers.push_back(d);
    }
    return !v.numbers.empty();
}

bool Request1::argument(const ArgSpec& a, Argument& x) {
    const bool numbers = a.form == ArgSpec::Form::Number || a.form == ArgSpec::Form::Int;
    Begins b = next();
    if (a.optional) return false;
    if (a.form == ArgSpec::Form::String && !a.array) {
        x.numbers.clear();
        x.strings.resize(1);
        return b == Begins::Text && text(x.strings[0]);
    }
    if (!numbers) return false;
    x.strings.clear();
    if (b == Begins::Floats) {
        if (!floats(x.numbers) || (!a.array && x.numbers.size() != size_t(a.count))) return false;
    } else {
        if (a.array) return false;
        room(x.numbers, size_t(a.count));
        for (int i = 0; i < a.count; ++i, b = next()) {
            if (b != Begins::Number) return false;
            at_.p = numberAt(at_.p, x.numbers[size_t(i)]);
        }
    }
    return a.form == ArgSpec::Form::Int ? allWhole(x.numbers) : allFinite(x.numbers);
}

/// Moves what is too much to the spare ones, and takes what is missing from there.
template <class T> void fit(std::vector<T>& v, size_t n, std::vector<T>& spare) {
    constexpr size_t kSpare = 64;
    while (v.size() > n) {
        if (spare.size() < kSpare) spare.push_back(std::move(v.back()));
        v.pop_back();
    }
    while (v.size() < n && !spare.empty()) {
        v.push_back(std::move(spare.back()));
        spare.pop_back();
    }
    v.resize(n);
}

} // namespace

void DirectReader::resize(Call& call, size_t arguments, size_t params) {
    fit(call.arguments, arguments, arguments_);
    fit(call.params, params, params_);
}

bool DirectReader::read(Lexer& lexer, Call& call) {
    const Ahead ahead = lexer.ahead();
    if (size_t(ahead.end - ahead.p) < kMargin || static_cast<unsigned char>(*ahead.p) < 0200) return false;
    const Request& r = *call.request;
    fit(call.arguments, r.args.size(), arguments_);
    Request1 one(lexer, ahead);
    if (!one.arguments(r, call)) return false;
    size_t k = 0;
    Begins b = one.next();
    for (; b == Begins::Text && r.parameters; ++k, b = one.next()) {
        if (k == call.params.size()) fit(call.params, k + 1, params_);
        if (!one.param(call.params[k])) return false;
    }
    // A code that is not defined ends no request.
    if (b != Begins::Request || !lexer.definesRequest(static_cast<unsigned char>(one.here().p[1]))) return false;
    fit(call.params, k, params_);
    lexer.advance(one.here());
    return true;
}

} // namespace alpenglow::ri
