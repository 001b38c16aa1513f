// RSL plug-ins: functions in C++ that shaders call like shadeops. This header is all that a plug-in needs; nothing is linked.
//
//     #include <alpenglow/rslplugin.h>
//     using namespace alpenglow::rslplugin;
//
//     static float wave(float x, float phase) { return std::sin(x + phase); }
//     static void split(Color c, float& luma, Color& rest) { ... }
//
//     ALPENGLOW_RSL_PLUGIN(perPoint<wave>("float wave(float x, phase)", "A sine."),
//                          perPoint<split>("void split(color c; output float luma; output color rest)"))
//
// compiled with `c++ -std=c++17 -O2 -shared -fPIC wave.cpp -o wave.so` is found by `plugin "wave";` in a shader, in the folders
// of the `rslplugin` search path, and loaded only under --allow-exec. See docs/plugins.md.
//
// What every function promises: the same arguments give the same results, whatever was called before and on whatever thread
// (several call it at once); it does not throw; it writes nothing but its results. Its derivatives are taken as zero.
#ifndef ALPENGLOW_RSLPLUGIN_H
#define ALPENGLOW_RSLPLUGIN_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

/// Version of everything below that the two sides must agree about.
#define ALPENGLOW_RSL_PLUGIN_ABI 1u

extern "C" {

/// A function over lanes. `lanes` points are worked on at once (up to 64); bit i of `mask` says that point i is wanted, the
/// others may be left alone. Rows have `lanes` floats. `in`: the arguments one after the other, each component a row: float and
/// string 1, color, point, vector and normal 3, matrix 16 (row by row), an array element after element. Output arguments stand
/// among them with the values they had. `out`: first the result, unless it is void, then the output arguments in order, in the
/// same way; a row that is not written is 0. Strings are numbers, as int32 in place of the float; AlpenglowRslHost says what they
/// mean.
typedef void (*AlpenglowRslFunction)(int32_t lanes, uint64_t mask, const float* in, float* out);

/// What the renderer offers to a plug-in. Both are safe on any thread.
struct AlpenglowRslHost {
    uint32_t abi;                        ///< ALPENGLOW_RSL_PLUGIN_ABI of the renderer
    const char* (*text)(int32_t string); ///< valid until the program ends
    int32_t (*string)(const char* text); ///< the number of a text, the same for the same text
};

struct AlpenglowRslEntry {
    const char* signature; ///< as RSL declares it: "float noise2(point p; float w; output color c)"; arrays have a length
    AlpenglowRslFunction call;
    int32_t rowsIn, rowsOut; ///< how many rows `call` reads and writes, to be checked against the signature; -1: not said
    const char* doc;         ///< one line for `alpenglow info`, or null
};

struct AlpenglowRslPlugin {
    uint32_t abi; ///< ALPENGLOW_RSL_PLUGIN_ABI of the plug-in
    uint32_t count;
    const AlpenglowRslEntry* entries;
};

/// The one symbol that a plug-in exports. The host stays valid.
typedef const AlpenglowRslPlugin* (*AlpenglowRslEntryPoint)(const AlpenglowRslHost*);
}
#define ALPENGLOW_RSL_PLUGIN_SYMBOL "alpenglow_rsl_plugin"

namespace alpenglow::rslplugin {

struct Color {
    float r, g, b;
};
struct Point {
    float x, y, z;
};
struct Vector {
    float x, y, z;
};
struct Normal {
    float x, y, z;
};
/// m[row][column], row vectors: p' = p m.
struct Matrix {
    float m[4][4];
};
template <class T, size_t N> struct Array {
    T e[N];
};

inline const AlpenglowRslHost*& host() {
    static const AlpenglowRslHost* h = nullptr;
    return h;
}

/// How a type lies in rows. Strings are `const char*` as arguments, `std::string` as results and outputs.
template <class T> struct Rows {
    static_assert(std::is_same_v<T, float> || std::is_same_v<T, Color> || std::is_same_v<T, Point> || std::is_same_v<T, Vector> ||
                      std::is_same_v<T, Normal> || std::is_same_v<T, Matrix>,
                  "a shader has no such type");
    static constexpr int kCount = int(sizeof(T) / sizeof(float));
    static T load(const float* row, int32_t lanes) {
        float v[kCount];
        for (int k = 0; k < kCount; ++k) v[k] = row[k * lanes];
        T t;
        std::memcpy(&t, v, sizeof t);
        return t;
    }
    static void store(const T& t, float* row, int32_t lanes) {
        float v[kCount];
        std::memcpy(v, &t, sizeof t);
        for (int k = 0; k < kCount; ++k) row[k * lanes] = v[k];
    }
};
template <> struct Rows<std::string> {
    static constexpr int kCount = 1;
    static std::string load(const float* row, int32_t) {
        int32_t id;
        std::memcpy(&id, row, sizeof id);
        return host()->text(id);
    }
    static void store(const std::string& s, float* row, int32_t) {
        const int32_t id = host()->string(s.c_str());
        std::memcpy(row, &id, sizeof id);
    }
};
template <> struct Rows<const char*> {
    static constexpr int kCount = 1;
    static const char* load(const float* row, int32_t) {
        int32_t id;
        std::memcpy(&id, row, sizeof id);
        return host()->text(id);
    }
};
template <class T, size_t N> struct Rows<Array<T, N>> {
    static constexpr int kCount = int(N) * Rows<T>::kCount;
    static Array<T, N> load(const float* row, int32_t lanes) {
        Array<T, N> a;
        for (size_t n = 0; n < N; ++n) a.e[n] = Rows<T>::load(row + int(n) * Rows<T>::kCount * lanes, lanes);
        return a;
    }
    static void store(const Array<T, N>& a, float* row, int32_t lanes) {
        for (size_t n = 0; n < N; ++n) Rows<T>::store(a.e[n], row + int(n) * Rows<T>::kCount * lanes, lanes);
    }
};

template <class A> using Bare = std::remove_cv_t<std::remove_reference_t<A>>;
/// References to what is not constant are output arguments.
template <class A> inline constexpr bool kOutput = std::is_lvalue_reference_v<A> && !std::is_const_v<std::remove_reference_t<A>>;
template <class A> constexpr int outputRows() {
    if constexpr (kOutput<A>) return Rows<Bare<A>>::kCount;
    else return 0;
}
template <class R> constexpr int resultRows() {
    if constexpr (std::is_void_v<R>) return 0;
    else return Rows<Bare<R>>::kCount;
}

template <auto F, class T> struct PerPoint;
template <auto F, class R, class... A> struct PerPoint<F, R (*)(A...)> {
    static constexpr int kIn = (0 + ... + Rows<Bare<A>>::kCount), kOut = (resultRows<R>() + ... + outputRows<A>());

    template <size_t... I> static void one(int32_t lanes, const float* in, float* out, std::index_sequence<I...>) {
        std::tuple<Bare<A>...> a;
        (((std::get<I>(a) = Rows<Bare<A>>::load(in, lanes)), in += Rows<Bare<A>>::kCount * lanes), ...);
        if constexpr (std::is_void_v<R>) {
            F(std::get<I>(a)...);
        } else {
            Rows<Bare<R>>::store(F(std::get<I>(a)...), out, lanes);
            out += resultRows<R>() * lanes;
        }
        (put<A>(std::get<I>(a), out, lanes), ...);
    }
    template <class X> static void put(const Bare<X>& x, float*& out, int32_t lanes) {
        if constexpr (kOutput<X>) {
            Rows<Bare<X>>::store(x, out, lanes);
            out += Rows<Bare<X>>::kCount * lanes;
        }
    }
    static void call(int32_t lanes, uint64_t mask, const float* in, float* out) {
        for (int32_t n = 0; n < lanes; ++n)
            if (mask >> n & 1) one(lanes, in + n, out + n, std::index_sequence_for<A...>{});
    }
};

/// An entry for an ordinary function, called once for each point that is wanted.
template <auto F> constexpr AlpenglowRslEntry perPoint(const char* signature, const char* doc = nullptr) {
    using P = PerPoint<F, decltype(F)>;
    return {signature, &P::call, P::kIn, P::kOut, doc};
}

/// An entry for a function that works on all lanes itself.
constexpr AlpenglowRslEntry overLanes(AlpenglowRslFunction f, const char* signature, const char* doc = nullptr) {
    return {signature, f, -1, -1, doc};
}

} // namespace alpenglow::rslplugin

/// Once in a plug-in, at file level: its functions.
#define ALPENGLOW_RSL_PLUGIN(...)                                                                                                \
    extern "C" __attribute__((visibility("default"))) const AlpenglowRslPlugin* alpenglow_rsl_plugin(                            \
        const AlpenglowRslHost* offered) {                                                                                       \
        static const AlpenglowRslEntry entries[] = {__VA_ARGS__};                                                                \
        static const AlpenglowRslPlugin plugin = {ALPENGLOW_RSL_PLUGIN_ABI, sizeof entries / sizeof entries[0], entries};        \
        alpenglow::rslplugin::host() = offered;                                                                                  \
        return &plugin;                                                                                                          \
    }

#endif
