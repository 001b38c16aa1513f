#include "rsl/services_basic.h"
#include "base/category.h"
#include "base/limits.h"
#include "base/pattern.h"
#include "base/printable.h"
#include "rsl/front/protocol.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <unordered_map>

namespace alpenglow::rsl {
namespace {

constexpr int kWidest = 1000; // of one conversion: width and precision; more is taken as this

struct Conversion {
    std::string flags;
    int width = 0, precision = -1;
    char letter = 0;
};

std::string number(double v, char letter, int precision, bool sign) {
    if (v != v) return "nan"; // whatever its sign, which means nothing
    char text[kWidest + 400];
    const char* plus = sign ? "+" : "";
    const std::string f = std::string("%") + plus + ".*" + letter;
    std::snprintf(text, sizeof text, f.c_str(), precision, v);
    return text;
}

// %g: with a precision it is %f; without one whatever is shorter, "full precision" being the seven digits that eval prints.
std::string general(float v, int precision, bool sign) {
    if (precision >= 0 || v != v) return number(double(v), 'f', precision, sign);
    char text[64];
    std::snprintf(text, sizeof text, sign ? "%+.7g" : "%.7g", double(v));
    std::string plain = text;
    if (!std::isfinite(v) || plain.find('e') != std::string::npos) return plain;
    std::string power = number(double(v), 'e', 6, sign); // 1.000000e+05: shorter once trailing zeros are removed
    const size_t e = power.find('e');
    size_t end = e;
    while (end > 0 && power[end - 1] == '0') --end;
    if (end > 0 && power[end - 1] == '.') --end;
    power.erase(end, e - end);
    return power.size() < plain.size() ? power : plain;
}

std::string scalar(float v, char letter, int precision, bool sign) {
    switch (letter) {
    case 'd':
        return number(double(v), 'f', 0, sign);
    case 'e':
        return number(double(v), 'e', precision < 0 ? 6 : precision, sign);
    case 'g':
        return general(v, precision, sign);
    default:
        return number(double(v), 'f', precision < 0 ? 6 : precision, sign);
    }
}

std::string convert(const FormatValue& v, const Conversion& c) {
    const bool sign = c.flags.find('+') != std::string::npos;
    std::string s;
    if (v.base == Base::String) {
        s = c.precision >= 0 ? v.text.substr(0, size_t(c.precision)) : v.text;
    } else if (v.base == Base::Matrix) {
        s = "[";
        for (int k = 0; k < 16; k++) {
            if (k) s += k % 4 == 0 ? ", " : " ";
            s += c.letter == 'm' ? general(v.numbers[k], c.precision, sign) : scalar(v.numbers[k], c.letter, c.precision, sign);
        }
        s += "]";
    } else if (v.base == Base::Float) {
        const char letter = std::strchr("fegd", c.letter) ? c.letter : 'g';
        s = scalar(v.numbers[0], letter, c.precision, sign);
    } else {
        const char letter = std::strchr("fegd", c.letter) ? c.letter : 'f';
        s = "[";
        for (int k = 0; k < 3; k++) s += (k ? " " : "") + scalar(v.numbers[k], letter, c.precision, sign);
        s += "]";
    }
    if (int(s.size()) >= c.width) return s;
    const size_t pad = size_t(c.width) - s.size();
    if (c.flags.find('-') != std::string::npos) return s + std::string(pad, ' ');
    if (c.flags.find('0') != std::string::npos && v.base == Base::Float) {
        const size_t at = !s.empty() && (s[0] == '-' || s[0] == '+') ? 1 : 0;
        return s.substr(0, at) + std::string(pad, '0') + s.substr(at);
    }
    return std::string(pad, ' ') + s;
}

// Positional arguments of one lane. Constant strings are in the site; everything else comes in rows. The site lists all strings,
// "" for those that come in rows; conversions of a pattern say where a constant string belongs.
struct Arguments {
    const ir::Site& site;
    int32_t lanes;
    const float* in;
    int lane;
    size_t nextKind = 0, nextString = 0;
    int row = 0;
    int dynamicLeft = 0;
    Arguments(const ir::Site& s, int32_t lanes, const float* in, int lane) : site(s), lanes(lanes), in(in), lane(lane) {
        dynamicLeft = int(std::count(s.argKinds.begin(), s.argKinds.end(), ir::Kind::String));
    }
    float at(int r) const { return in[size_t(r) * size_t(lanes) + size_t(lane)]; }
    bool more(bool wantString) const { return wantString ? nextString < site.strings.size() : nextKind < site.argKinds.size(); }
    std::string string() {
        if (nextString >= site.strings.size()) return {};
        const std::string& s = site.strings[nextString++];
        if (!s.empty() || dynamicLeft == 0) return s;
        while (nextKind < site.argKinds.size() && site.argKinds[nextKind] != ir::Kind::String) skip();
        if (nextKind >= site.argKinds.size()) return {};
        dynamicLeft--;
        nextKind++;
        return internedString(std::bit_cast<int32_t>(at(row++)));
    }
    void skip() { row += ir::components(site.argKinds[nextKind++]); }
    FormatValue value() {
        FormatValue v;
        if (nextKind >= site.argKinds.size()) return v;
        const ir::Kind k = site.argKinds[nextKind];
        if (k == ir::Kind::String) {
            v.base = Base::String;
            v.text = string();
            return v;
        }
        v.base = nextKind < site.argTypes.size() ? site.argTypes[nextKind].base
                 : k == ir::Kind::Float          ? Base::Float
                                                 : Base::Color;
        if (k == ir::Kind::Float || k == ir::Kind::Bool) v.base = Base::Float;
        for (int c = 0; c < ir::components(k) && c < 16; c++) v.numbers[c] = at(row + c);
        skip();
        return v;
    }
};

size_t parseConversion(const std::string& p, size_t at, Conversion& c) {
    size_t i = at + 1;
    while (i < p.size() && std::strchr("-+ 0#", p[i])) c.flags += p[i++];
    auto digits = [&] {
        int n = 0;
        while (i < p.size() && p[i] >= '0' && p[i] <= '9') n = std::min(kWidest, n * 10 + (p[i++] - '0'));
        return n;
    };
    c.width = digits();
    if (i < p.size() && p[i] == '.') {
        i++;
        c.precision = digits();
    }
    c.letter = i < p.size() ? p[i] : 0;
    if (c.letter == 'v' || c.letter == 'n') c.letter = 'p'; // vectors and normals of Aqsis and Pixie
    if (c.letter == 'i') c.letter = 'd';
    return i + 1;
}

// `next` gives the value for a conversion, or null when there is none left.
std::string formatWith(const std::string& p, const std::function<const FormatValue*(char letter)>& next) {
    std::string out;
    for (size_t i = 0; i < p.size();) {
        if (p[i] != '%') {
            out += p[i++];
            continue;
        }
        Conversion c;
        const size_t end = parseConversion(p, i, c);
        if (c.letter == '%') {
            out += '%';
        } else if (c.letter && std::strchr("fegdpcmsh", c.letter)) {
            const FormatValue* v = next(c.letter);
            if (v) out += convert(*v, c);
            else out += p.substr(i, end - i);
        } else {
            out += p.substr(i, end - i);
        }
        i = std::min(end, p.size());
    }
    return out;
}

std::string formatSite(const ir::Site& s, int32_t lanes, const float* in, int lane) {
    Arguments a(s, lanes, in, lane);
    const std::string pattern = a.string();
    FormatValue v;
    return formatWith(pattern, [&](char letter) -> const FormatValue* {
        const bool text = letter == 's' || letter == 'h';
        if (!(text && a.more(true)) && a.more(false)) {
            v = a.value();
        } else if (!a.more(true)) {
            return nullptr;
        } else {
            v = FormatValue{Base::String, {}, a.string()};
        }
        if (letter == 'h' && v.base == Base::String) v.text = shownHandle(v.text);
        return &v;
    });
}

} // namespace

std::string formatText(const std::string& pattern, const std::vector<FormatValue>& values) {
    size_t at = 0;
    return formatWith(pattern, [&](char) { return at < values.size() ? &values[at++] : nullptr; });
}

namespace {

/// Compiled patterns by text: a shader uses the same ones at every point.
struct Patterns {
    struct Entry {
        std::shared_ptr<const Pattern> pattern;
        std::string error;
    };
    std::shared_mutex mutex;
    std::unordered_map<std::string, Entry> all;

    Entry get(const std::string& text) {
        {
            const std::shared_lock lock(mutex);
            if (const auto it = all.find(text); it != all.end()) return it->second;
        }
        Entry e;
        e.pattern = Pattern::make(text, e.error);
        const std::unique_lock lock(mutex);
        if (all.size() >= limits::kPatternCache) all.clear();
        return all.insert_or_assign(text, e).first->second;
    }
};

Patterns& patterns() {
    static Patterns p;
    return p;
}

} // namespace

bool matchText(const std::string& pattern, const std::string& subject, std::string* error) {
    struct Answer {
        std::string pattern, subject;
        bool found;
    };
    thread_local std::optional<Answer> last; // consecutive points mostly repeat the query
    if (last && last->pattern == pattern && last->subject == subject) return last->found;
    const Patterns::Entry e = patterns().get(pattern);
    if (!e.pattern) {
        if (error) *error = e.error;
        return false;
    }
    last = Answer{pattern, subject, e.pattern->occurs(subject)};
    return last->found;
}

void hashText(const std::string& s, float out[3]) {
    // 64-bit FNV-1a, then a finaliser for each number; 24 bits of each, so that the float is exact and below one.
    uint64_t h = 0xcbf29ce484222325u;
    for (unsigned char c : s) h = (h ^ c) * 0x100000001b3u;
    for (uint64_t k = 0; k < 3; k++) {
        uint64_t x = h + 0x9e3779b97f4a7c15u * (k + 1);
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        x ^= x >> 31;
        out[k] = float(x >> 40) * 0x1p-24f;
    }
}

namespace {

/// A call of one of these services for some lanes.
class BasicCall {
public:
    BasicCall(const ir::Site& s, uint64_t mask, int32_t lanes, const float* in, float* out, Diagnostics& diagnostics,
              const PrintFn& print, const std::vector<std::string>* files)
        : site_(s), mask_(mask), lanes_(lanes), in_(in), out_(out), diagnostics_(diagnostics), print_(print),
          place_{files && s.place.file >= 0 && size_t(s.place.file) < files->size() ? (*files)[size_t(s.place.file)] : "",
                 s.place.line, s.place.column} {}
    /// False for sites of other services.
    bool answer();

private:
    template <class F> void each(F&& f) const {
        for (int l = 0; l < lanes_; l++)
            if (mask_ >> l & 1) f(l);
    }
    Arguments arguments(int lane) const { return Arguments(site_, lanes_, in_, lane); }
    void put(int row, int lane, float v) { out_[size_t(row) * size_t(lanes_) + size_t(lane)] = v; }
    void putString(int lane, const std::string&);
    void say(const std::string& key, const Raised& message, Rie code, std::string hint = {}) {
        diagnostics_.reportOnce(key, diagnostic(message, code, place_, std::move(hint)));
    }
    void cut(std::string&);

    void inCategories();
    void complaint();
    void arrayLimit();
    void format();
    void print();
    void concat();
    void match();
    void colourTransform();
    void hash();

    const ir::Site& site_;
    uint64_t mask_;
    int32_t lanes_;
    const float* in_;
    float* out_;
    Diagnostics& diagnostics_;
    const PrintFn& print_;
    SourcePlace place_;
};

void BasicCall::putString(int lane, const std::string& t) {
    bool full = false;
    put(0, lane, std::bit_cast<float>(internRuntimeString(t, full)));
    if (full) say("runtime strings", msg::kStringsLimit(limits::kRuntimeStrings), Rie::Limit);
}

/// A string that is joined with itself in a loop doubles each time.
void BasicCall::cut(std::string& t) {
    if (t.size() <= limits::kTokenBytes) return;
    t.resize(limits::kTokenBytes);
    say("stringlimit:" + place_.file + std::to_string(place_.line), msg::kStringLimit(site_.op, limits::kTokenBytes), Rie::Limit);
}

/// getshaders() with a category that is known now.
void BasicCall::inCategories() {
    each([&](int l) { put(0, l, inCategory(arguments(l).string(), site_.strings[1]) ? 1 : 0); });
}

/// Messages about code that the builder could not exclude: reported when a point reaches it.
void BasicCall::complaint() {
    if (!mask_) return;
    Arguments a = arguments(std::countr_zero(mask_));
    std::string text;
    while (a.more(true)) text += a.string();
    Diagnostic d{Severity::Error, Rie::Consistency, place_, text, {}, {}};
    if (!site_.pairStrings.empty()) d.id = site_.pairStrings[0]; // ir/complaint.h
    diagnostics_.reportOnce("complaint:" + place_.file + std::to_string(place_.line) + ":" + std::to_string(place_.column) + text,
                            std::move(d));
}

void BasicCall::arrayLimit() {
    const int most = mask_ ? int(in_[std::countr_zero(mask_)]) : 0;
    say("arraylimit:" + place_.file + std::to_string(place_.line), msg::kArrayLimit(most), Rie::Limit);
}

void BasicCall::format() {
    each([&](int l) {
        std::string t = formatSite(site_, lanes_, in_, l);
        cut(t);
        putString(l, t);
    });
}

/// printf(), and print(), which ends the line.
void BasicCall::print() {
    each([&](int l) {
        const std::string t = formatSite(site_, lanes_, in_, l) + (site_.op == "print" ? "\n" : "");
        if (print_) print_(l, t);
        else std::fputs(printable(t).c_str(), stdout);
    });
}

void BasicCall::concat() {
    each([&](int l) {
        Arguments a = arguments(l);
        std::string t;
        while (a.more(true)) t += a.string();
        cut(t);
        putString(l, t);
    });
}

void BasicCall::match() {
    each([&](int l) {
        Arguments a = arguments(l);
        const std::string pattern = a.string(), subject = a.string();
        std::string error;
        put(0, l, matchText(pattern, subject, &error) ? 1.0f : 0.0f);
        if (!error.empty()) say("match:" + pattern, msg::kMatchPattern(pattern, error), Rie::Syntax);
    });
}

/// ctransform() between spaces that are known only now.
void BasicCall::colourTransform() {
    const auto lower = [](std::string t) {
        for (char& c : t) c = char(std::tolower(static_cast<unsigned char>(c)));
        return t;
    };
    const auto known = [](const std::string& t) { return t == "rgb" || t == "hsv" || t == "hsl" || t == "yiq" || t == "xyz"; };
    each([&](int l) {
        Arguments a = arguments(l);
        const std::string from = lower(a.string()), to = lower(a.string());
        for (const std::string& t : {from, to})
            if (!t.empty() && !known(t))
                say("ctransform:" + t, msg::kUnknownColourSpace(t), Rie::NoError, "there are: rgb, hsv, hsl, yiq, xyz");
        FormatValue v = a.value();
        float c[3] = {v.numbers[0], v.numbers[1], v.numbers[2]}, r[3];
        if (from != to && known(from) && known(to)) {
            if (from != "rgb" && evaluateRuntime("al_" + from + "_to_rgb", c, 3, r, 3)) std::copy_n(r, 3, c);
            if (to != "rgb" && evaluateRuntime("al_rgb_to_" + to, c, 3, r, 3)) std::copy_n(r, 3, c);
        }
        for (int k = 0; k < 3; k++) put(k, l, c[k]);
    });
}

void BasicCall::hash() {
    each([&](int l) {
        float h[3];
        hashText(arguments(l).string(), h);
        const int n = site_.resultKinds.empty() ? 1 : std::min(3, ir::components(site_.resultKinds[0]));
        for (int c = 0; c < n; c++) put(c, l, h[c]);
    });
}

bool BasicCall::answer() {
    constexpr std::pair<std::string_view, void (BasicCall::*)()> kServices[] = {{"incategory", &BasicCall::inCategories},
                                                                                {"complaint", &BasicCall::complaint},
                                                                                {"arraylimit", &BasicCall::arrayLimit},
                                                                                {"format", &BasicCall::format},
                                                                                {"printf", &BasicCall::print},
                                                                                {"print", &BasicCall::print},
                                                                                {"concat", &BasicCall::concat},
                                                                                {"match", &BasicCall::match},
                                                                                {"ctransform", &BasicCall::colourTransform},
                                                                                {"stringhash", &BasicCall::hash}};
    for (const auto& [name, service] : kServices)
        if (site_.op == name) return (this->*service)(), true;
    return false;
}

} // namespace

bool basicService(const ir::Site& s, uint64_t mask, int32_t lanes, const float* in, float* out, Diagnostics& diagnostics,
                  const PrintFn& print, const std::vector<std::string>* files) {
    return BasicCall(s, mask, lanes, in, out, diagnostics, print, files).answer();
}

} // namespace alpenglow::rsl
