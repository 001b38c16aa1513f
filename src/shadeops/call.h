// From a template to the functions of the bitcode: loads and stores of flattened arguments, and the macro that exports a symbol.
#pragma once
#include "shadeops/jet.h"
#if !defined(ALPENGLOW_BITCODE) && !defined(ALPENGLOW_TEMPLATES)
#include <array>
#include <string_view>
#endif
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Three numbers for each lane: a colour, point, vector or normal.
template <class T> struct Triple {
    T x, y, z; ///< by lane
};
/// Row by row: m[4 * row + column].
template <class T> struct Matrix {
    T m[16];
};
/// Two results.
template <class T> struct Pair {
    T a, b; ///< by lane
};

/// Component by component.
template <class T> AL_INLINE Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> AL_INLINE Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> AL_INLINE Triple<T> operator-(const Triple<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T> AL_INLINE Triple<T> times(const Triple<T>& a, const T& k) { return {a.x * k, a.y * k, a.z * k}; }
/// a * k + b.
template <class T> AL_INLINE Triple<T> mad3(const Triple<T>& a, const T& k, const Triple<T>& b) {
    return {mad(a.x, k, b.x), mad(a.y, k, b.y), mad(a.z, k, b.z)};
}
/// Products, a choice by lane (a where m is set), and the length, as of vectors.
template <class T> AL_INLINE T dot(const Triple<T>& a, const Triple<T>& b) { return mad(a.x, b.x, mad(a.y, b.y, a.z * b.z)); }
template <class T> AL_INLINE Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> AL_INLINE Triple<T> select3(vm m, const Triple<T>& a, const Triple<T>& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class T> AL_INLINE T length(const Triple<T>& a) { return root(dot(a, a)); }
/// The zero vector for the zero vector.
template <class T> AL_INLINE Triple<T> normalize(const Triple<T>& a) { return times(a, divide(T(vf(1)), length(a))); }

/// Reads the next value from the flattened arguments of a call and moves p behind it.
AL_INLINE void load(const vf*& p, vf& x) { x = *p++; }
AL_INLINE void load(const vf*& p, Jet1& x) {
    x = Jet1{p[0], p[1], p[2]};
    p += 3;
}
AL_INLINE void load(const vf*& p, Jet2& x) {
    x = Jet2{p[0], p[1], p[2], p[3], p[4], p[5]};
    p += 6;
}
template <class T> AL_INLINE void load(const vf*& p, Triple<T>& t) {
    load(p, t.x);
    load(p, t.y);
    load(p, t.z);
}
template <class T> AL_INLINE void load(const vf*& p, Matrix<T>& t) {
#pragma clang loop unroll(full)
    for (int i = 0; i < 16; ++i) load(p, t.m[i]);
}
/// Writes a value to the flattened results of a call and moves p behind it.
AL_INLINE void store(vf*& p, vf x) { *p++ = x; }
AL_INLINE void store(vf*& p, const Jet1& x) {
    p[0] = x.v, p[1] = x.du, p[2] = x.dv;
    p += 3;
}
AL_INLINE void store(vf*& p, const Jet2& x) {
    p[0] = x.v, p[1] = x.du, p[2] = x.dv, p[3] = x.duu, p[4] = x.duv, p[5] = x.dvv;
    p += 6;
}
template <class T> AL_INLINE void store(vf*& p, const Triple<T>& t) {
    store(p, t.x);
    store(p, t.y);
    store(p, t.z);
}
template <class T> AL_INLINE void store(vf*& p, const Pair<T>& t) {
    store(p, t.a);
    store(p, t.b);
}
template <class T> AL_INLINE void store(vf*& p, const Matrix<T>& t) {
#pragma clang loop unroll(full)
    for (int i = 0; i < 16; ++i) store(p, t.m[i]);
}

/// An argument that is a reference to non-const is an output: loaded first, stored after the result.
template <class A> AL_INLINE void storeOutput(vf*& p, const std::remove_cvref_t<A>& x) {
    if constexpr (std::is_lvalue_reference_v<A> && !std::is_const_v<std::remove_reference_t<A>>) store(p, x);
}

/// Calls f with arguments from `in`; its result and then its outputs go to `out`.
template <class R, class... A, std::size_t... I>
AL_INLINE void callWith(R (*f)(A...), const vf* in, vf* out, std::index_sequence<I...>) {
    std::tuple<std::remove_cvref_t<A>...> arguments;
    (load(in, std::get<I>(arguments)), ...);
    if constexpr (std::is_void_v<R>) f(std::get<I>(arguments)...);
    else store(out, f(std::get<I>(arguments)...));
    (storeOutput<A>(out, std::get<I>(arguments)), ...);
}
template <class R, class... A> AL_INLINE void call(R (*f)(A...), const vf* in, vf* out) {
    callWith(f, in, out, std::index_sequence_for<A...>{});
}

#ifdef ALPENGLOW_TEMPLATES // who uses the templates alone, for instance a lobe
#define AL_RUNTIME(symbol, function)
#elif defined(ALPENGLOW_BITCODE)
#define AL_RUNTIME(symbol, function)                                                                                             \
    extern "C" __attribute__((always_inline)) void symbol##_0(const vf* in, vf* out) { call(&function<vf>, in, out); }           \
    extern "C" __attribute__((always_inline)) void symbol##_1(const vf* in, vf* out) { call(&function<Jet1>, in, out); }         \
    extern "C" __attribute__((always_inline)) void symbol##_2(const vf* in, vf* out) { call(&function<Jet2>, in, out); }
#else

/// Floats a lane of a type, and of the arguments and results of a function, at order 0.
template <class A> constexpr int componentsOf() {
    if constexpr (std::is_void_v<A>) return 0;
    else return static_cast<int>(sizeof(std::remove_cvref_t<A>) / sizeof(vf));
}
template <class R, class... A> constexpr int inputsOf(R (*)(A...)) { return (componentsOf<A>() + ... + 0); }
template <class R, class... A> constexpr int outputsOf(R (*)(A...)) {
    return componentsOf<R>() +
           ((std::is_lvalue_reference_v<A> && !std::is_const_v<std::remove_reference_t<A>> ? componentsOf<A>() : 0) + ... + 0);
}
/// call() with the signature of all runtime functions.
template <auto F> void wrapped(const vf* in, vf* out) { call(F, in, out); }

// Who includes this wants the functions on vf alone (1), or those on Jet1 and Jet2 as well (3).
#ifndef ALPENGLOW_ORDERS
#define ALPENGLOW_ORDERS 3
#endif
#if ALPENGLOW_ORDERS == 1
#define AL_ORDERS(function) &wrapped<&function<vf>>
#else
#define AL_ORDERS(function) &wrapped<&function<vf>>, &wrapped<&function<Jet1>>, &wrapped<&function<Jet2>>
#endif

/// One symbol as compiled into this program.
struct RuntimeEntry {
    std::string_view symbol;
    void (*order[ALPENGLOW_ORDERS])(const vf* in, vf* out); ///< on vf, Jet1, Jet2
    int in, out;                                            ///< components (at order 0, floats)
};

template <int I> struct EntryAt;
inline constexpr int kFirstEntry = __COUNTER__ + 1; ///< value of __COUNTER__ at the first AL_RUNTIME
#define AL_RUNTIME(name, function)                                                                                               \
    template <> struct EntryAt<__COUNTER__ - kFirstEntry> {                                                                      \
        static constexpr RuntimeEntry kEntry = {                                                                                 \
            #name, {AL_ORDERS(function)}, inputsOf(&function<vf>), outputsOf(&function<vf>)};                                    \
    };
/// All entries, in the order of the source.
template <size_t... I> constexpr auto collectEntries(std::index_sequence<I...>) {
    return std::array<RuntimeEntry, sizeof...(I)>{EntryAt<static_cast<int>(I)>::kEntry...};
}
#endif

} // namespace alpenglow::shadeops::AL_NAMESPACE
