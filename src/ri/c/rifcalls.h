// How a filter's functions are called with the arguments of a request. Each file that defines functions of ri.h may list those of
// RifFilter that belong to it.
#pragma once
#include "ri/c/client.h"
#include "ri/requests/request.h"
#include <RifPlugin.h>
#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace alpenglow::ri {

/// Thrown if C cannot express a request: the filter does not see it.
struct NotInC {};

/// The function of ri.h for a filter of that name. Throws NotInC.
inline RtFilterFunc filterOf(const std::string& name) {
    static const std::map<std::string, RtFilterFunc> kFilters = {{"box", RiBoxFilter},
                                                                 {"triangle", RiTriangleFilter},
                                                                 {"catmull-rom", RiCatmullRomFilter},
                                                                 {"separable-catmull-rom", RiSeparableCatmullRomFilter},
                                                                 {"gaussian", RiGaussianFilter},
                                                                 {"sinc", RiSincFilter},
                                                                 {"bessel", RiBesselFilter},
                                                                 {"disk", RiDiskFilter},
                                                                 {"mitchell", RiMitchellFilter},
                                                                 {"blackman-harris", RiBlackmanHarrisFilter},
                                                                 {"lanczos", RiLanczosFilter}};
    const auto f = kFilters.find(name);
    if (f == kFilters.end()) throw NotInC();
    return f->second;
}

/// The arguments of a request, read one by one as C has them. Counts of arrays, which RIB leaves out, follow from these.
class RifArguments {
public:
    /// handle: the object of C for a handle of RIB. The call must outlive this.
    RifArguments(const Call& c, const Declarations& d, std::function<RtPointer(const std::string&)> handle)
        : call_(c), declarations_(d), handle_(std::move(handle)) {
        const std::vector<ArgSpec>& specs = c.request->args;
        for (size_t i = 0; i < specs.size(); ++i)
            if (specs[i].otherCount && c.given(i) && int(c.numbers(i).size()) == specs[i].otherCount) throw NotInC();
        if (isLight()) parameter("string __handleid", {.kind = Value::Kind::Strings, .strings = {c.text(1)}});
        const std::string category = !c.arguments.empty() && !c.arguments[0].strings.empty() ? c.text(0) : "";
        const bool classes = c.request->name == "Attribute" || c.request->name == "Option";
        for (const RawParam& p : c.params) parameter(p.token, p.value, classes ? category : "");
    }
    /// The request returns a handle.
    bool isLight() const { return call_.request->name == "LightSource" || call_.request->name == "AreaLightSource"; }

    /// The next argument, as the C type T. Throws NotInC.
    template <class T> T next() {
        if constexpr (std::is_same_v<T, RtFloat>) return number(RI_INFINITY);
        else if constexpr (std::is_same_v<T, RtInt>) return integer();
        else if constexpr (std::is_same_v<T, RtBoolean>) return RtBoolean(integer());
        else if constexpr (std::is_same_v<T, RtToken>) return text();
        else if constexpr (std::is_same_v<T, RtFloat*>) return list<RtFloat>(floats_);
        else if constexpr (std::is_same_v<T, RtInt*>) return list<RtInt>(ints_);
        else if constexpr (std::is_same_v<T, RtToken*>) return texts();
        else if constexpr (std::is_same_v<T, RtFloat(*)[4]>) return matrix();
        else if constexpr (std::is_same_v<T, RtFilterFunc>) return filterOf(text());
        else if constexpr (std::is_same_v<T, RtPointer>) return handle_(text());
        else {
            static_assert(std::is_same_v<T, RtArchiveCallback>);
            return nullptr;
        }
    }
    /// The parameter list; valid as long as this.
    RtInt count() const { return RtInt(tokens_.size()); }
    RtToken* tokens() { return tokens_.data(); }
    RtPointer* values() { return values_.data(); }

private:
    const Argument* now() const { return at_ < call_.arguments.size() ? &call_.arguments[at_] : nullptr; }
    void step() { ++at_, k_ = 0; }
    RtFloat number(RtFloat otherwise) {
        const Argument* a = now();
        if (!a || k_ >= a->numbers.size()) {
            if (a && a->given) throw NotInC();
            return otherwise;
        }
        const float f = toFloat(a->numbers[k_]);
        if (++k_ == a->numbers.size()) step();
        return f;
    }
    RtInt integer() {
        if (at_ >= call_.request->args.size()) return points();
        if (!call_.request->args[at_].array) return RtInt(number(0));
        const Argument* a = now();
        if (!a) return 0;
        const size_t n = std::max(a->numbers.size(), a->strings.size());
        return RtInt(call_.request->name == "ColorSamples" ? n / 3 : n);
    }
    /// Polygon and Points: as many as they have positions.
    RtInt points() const {
        for (const RawParam& p : call_.params) {
            const std::string name = p.token.substr(p.token.find_last_of(' ') + 1);
            const size_t each = name == "P" ? 3 : name == "Pw" ? 4 : name == "Pz" ? 1 : 0;
            if (each) return RtInt(p.value.numbers.size() / each);
        }
        throw NotInC();
    }
    RtToken text() {
        const Argument* a = now();
        if (!a || k_ >= a->strings.size()) throw NotInC();
        RtToken t = a->strings[k_].c_str();
        if (++k_ == a->strings.size()) step();
        return t;
    }
    template <class T> T* list(std::deque<std::vector<T>>& keep) {
        const Argument* a = now();
        step();
        std::vector<T>& v = keep.emplace_back();
        if (a)
            for (double d : a->numbers) v.push_back(T(toFloat(d)));
        return v.data();
    }
    RtToken* texts() {
        const Argument* a = now();
        step();
        std::vector<RtToken>& v = texts_.emplace_back();
        if (a)
            for (const std::string& s : a->strings) v.push_back(s.c_str());
        return v.data();
    }
    RtFloat (*matrix())[4] {
        const Argument* a = now();
        if (a && !a->strings.empty()) {
            static const std::map<std::string, RtFloat(*)[4]> kBases = {{"bezier", RiBezierBasis},
                                                                        {"b-spline", RiBSplineBasis},
                                                                        {"catmull-rom", RiCatmullRomBasis},
                                                                        {"hermite", RiHermiteBasis},
                                                                        {"power", RiPowerBasis}};
            const auto b = kBases.find(text());
            if (b == kBases.end()) throw NotInC();
            return b->second;
        }
        if (!a || a->numbers.size() != 16) throw NotInC();
        return reinterpret_cast<RtFloat(*)[4]>(list<RtFloat>(floats_));
    }
    void parameter(const std::string& token, const Value& v, const std::string& category = {}) {
        const bool connects = token.starts_with("reference ");
        const Resolved r = declarations_.resolve(token, category);
        const bool isText = connects || v.kind == Value::Kind::Strings;
        tokens_.push_back(keptTokens_.emplace_back(token).c_str());
        if (isText) {
            std::vector<RtToken>& t = texts_.emplace_back();
            for (const std::string& s : v.strings) t.push_back(keptTokens_.emplace_back(s).c_str());
            values_.push_back(const_cast<RtToken*>(t.data()));
        } else if (r.declaration && r.declaration->type == scene::Type::Integer) {
            std::vector<RtInt>& n = ints_.emplace_back();
            for (double d : v.numbers) n.push_back(RtInt(std::clamp(d, -2147483648., 2147483647.)));
            values_.push_back(n.data());
        } else {
            std::vector<RtFloat>& n = floats_.emplace_back();
            for (double d : v.numbers) n.push_back(toFloat(d));
            values_.push_back(n.data());
        }
    }

    const Call& call_;
    const Declarations& declarations_;
    std::function<RtPointer(const std::string&)> handle_;
    size_t at_ = 0, k_ = 0; ///< the next argument, and its next value
    std::deque<std::string> keptTokens_;
    std::deque<std::vector<RtFloat>> floats_;
    std::deque<std::vector<RtInt>> ints_;
    std::deque<std::vector<RtToken>> texts_;
    std::vector<RtToken> tokens_;
    std::vector<RtPointer> values_;
};

/// Calls a function with the arguments of its request. The handle that it gives; null: none.
template <class R, class... A, size_t... I> RtPointer callWith(R (*f)(A...), RifArguments& a, std::index_sequence<I...>) {
    using Types = std::tuple<A...>;
    constexpr size_t n = sizeof...(A);
    constexpr bool pairs = [] {
        if constexpr (n >= 3) return std::is_same_v<std::tuple_element_t<n - 1, Types>, RtPointer*>;
        else return false;
    }();
    const auto one = [&]<size_t K>(std::integral_constant<size_t, K>) -> std::tuple_element_t<K, Types> {
        if constexpr (pairs && K + 3 == n) return a.count();
        else if constexpr (pairs && K + 2 == n) return a.tokens();
        else if constexpr (pairs && K + 1 == n) return a.values();
        else return a.next<std::tuple_element_t<K, Types>>();
    };
    Types all{one(std::integral_constant<size_t, I>())...}; // in their order
    if constexpr (std::is_void_v<R>) {
        std::apply(f, all);
        return nullptr;
    } else {
        return std::apply(f, all);
    }
}
/// With the arguments read one by one.
template <class R, class... A> RtPointer callWith(R (*f)(A...), RifArguments& a) {
    return callWith(f, a, std::index_sequence_for<A...>());
}

/// A member of RifFilter.
struct RifFunction {
    std::string_view request;        ///< whose calls it receives
    bool (*given)(const RifFilter&); ///< whether the filter has set it
    /// Calls it; throws NotInC if C cannot express the request. The handle of a light that it made; null: none.
    RtPointer (*call)(const RifFilter&, RifArguments&);
};

/// The request of a member: its name without the V of the vector form.
constexpr std::string_view requestOf(std::string_view member) {
    return member.ends_with('V') ? member.substr(0, member.size() - 1) : member;
}

/// The entry of a member in a list.
#define ALPENGLOW_RIF(member)                                                                                                    \
    RifFunction {                                                                                                                \
        requestOf(#member), [](const RifFilter& f) { return f.member != nullptr; },                                              \
            [](const RifFilter& f, RifArguments& a) { return callWith(f.member, a); }                                            \
    }

/// The members for primitives (primitives.cpp).
std::span<const RifFunction> rifPrimitives();

} // namespace alpenglow::ri
