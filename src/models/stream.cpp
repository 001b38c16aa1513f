#include "models/stream.h"
#include <cstring>
#include <type_traits>

namespace alpenglow::models {

namespace {

constexpr uint32_t kStamp = 0xa1f0e5; ///< another whenever a structure changes

/// The members of each structure, in the order of the stream.
template <class S> void members(S& s, Image& x) { s(x.name, x.file, x.bytes); }
template <class S> void members(S& s, Texture& x) { s(x.image, x.set, x.s, x.t, x.scale, x.offset, x.rotation); }
template <class S> void members(S& s, Material& x) {
    s(x.name, x.unlit, x.alphaMode, x.baseColor, x.alphaCutoff, x.metalness, x.roughness, x.normalScale, x.ior, x.emission,
      x.specular, x.specularColor, x.coat, x.coatRoughness, x.transmission, x.thickness, x.attenuationDistance,
      x.attenuationColor, x.sheenColor, x.sheenRoughness);
    s(x.baseColorMap, x.metalRoughMap, x.normalMap, x.emissionMap, x.coatMap, x.coatRoughnessMap, x.transmissionMap,
      x.specularMap, x.specularColorMap, x.sheenColorMap, x.sheenRoughnessMap);
}
template <class S> void members(S& s, MorphTarget& x) { s(x.P, x.N); }
template <class S> void members(S& s, Part& x) {
    s(x.kind, x.material, x.counts, x.corners, x.P, x.N, x.color, x.st, x.influences, x.joints, x.weights, x.targets);
}
template <class S> void members(S& s, Mesh& x) { s(x.name, x.parts, x.weights, x.skin); }
template <class S> void members(S& s, Skin& x) { s(x.joints, x.bindings); }
template <class S> void members(S& s, Camera& x) { s(x.name, x.perspective, x.yfov, x.aspect, x.halfHeight, x.near, x.far); }
template <class S> void members(S& s, Light& x) { s(x.name, x.kind, x.color, x.intensity, x.inner, x.outer); }
template <class S> void members(S& s, Node& x) {
    s(x.name, x.parent, x.hasMatrix, x.matrix, x.translation, x.rotation, x.scale, x.meshes, x.skin, x.camera, x.light,
      x.weights);
}
template <class S> void members(S& s, Channel& x) { s(x.node, x.path, x.interpolation, x.times, x.values); }
template <class S> void members(S& s, Animation& x) { s(x.name, x.channels); }
template <class S> void members(S& s, Note& x) { s(x.error, x.text); }
template <class S> void members(S& s, Model& x) {
    s(x.generator, x.images, x.materials, x.meshes, x.skins, x.cameras, x.lights, x.nodes, x.roots, x.animations, x.notes);
}

template <class T> struct IsVector : std::false_type {};
template <class T> struct IsVector<std::vector<T>> : std::true_type {};

/// What is stored as its bytes: numbers, enumerations, arrays of them, matrices.
template <class T>
constexpr bool kPlain = std::is_arithmetic_v<std::remove_all_extents_t<T>> || std::is_enum_v<T> || std::is_same_v<T, Matrix>;

class Sender {
public:
    std::vector<uint8_t> bytes;
    template <class... T> void operator()(T&... x) { (put(x), ...); }

private:
    void raw(const void* at, size_t n) {
        const auto* b = static_cast<const uint8_t*>(at);
        bytes.insert(bytes.end(), b, b + n);
    }
    void count(uint64_t n) { raw(&n, sizeof n); }
    template <class T> void put(T& x) {
        if constexpr (std::is_same_v<T, std::string>) {
            count(x.size());
            raw(x.data(), x.size());
        } else if constexpr (IsVector<T>::value) {
            count(x.size());
            if constexpr (kPlain<typename T::value_type>) raw(x.data(), x.size() * sizeof(typename T::value_type));
            else
                for (auto& e : x) put(e);
        } else if constexpr (kPlain<T>) {
            raw(&x, sizeof x);
        } else {
            members(*this, x);
        }
    }
};

class Receiver {
public:
    explicit Receiver(std::span<const uint8_t> b) : left_(b) {}
    bool good() const { return good_; }
    bool done() const { return good_ && left_.empty(); }
    template <class... T> void operator()(T&... x) { (get(x), ...); }

private:
    void raw(void* to, size_t n) {
        if (n > left_.size()) good_ = false;
        if (!good_ || n == 0) return;
        std::memcpy(to, left_.data(), n);
        left_ = left_.subspan(n);
    }
    /// Of elements that take `bytes` at least.
    size_t count(size_t bytes) {
        uint64_t n = 0;
        raw(&n, sizeof n);
        if (n > left_.size() / bytes) good_ = false;
        return good_ ? size_t(n) : 0;
    }
    template <class T> void get(T& x) {
        if constexpr (std::is_same_v<T, std::string>) {
            x.resize(count(1));
            raw(x.data(), x.size());
        } else if constexpr (IsVector<T>::value) {
            using E = typename T::value_type;
            if constexpr (kPlain<E>) {
                x.resize(count(sizeof(E)));
                raw(x.data(), x.size() * sizeof(E));
            } else { // each has a count or a number at least; memory follows what is there
                const size_t n = count(sizeof(int32_t));
                for (size_t i = 0; i < n && good_; ++i) get(x.emplace_back());
            }
        } else if constexpr (std::is_same_v<T, bool>) {
            uint8_t b = 0;
            raw(&b, 1);
            x = b != 0;
        } else if constexpr (kPlain<T>) {
            raw(&x, sizeof x);
        } else {
            members(*this, x);
        }
    }
    std::span<const uint8_t> left_;
    bool good_ = true;
};

} // namespace

std::vector<uint8_t> toBytes(const Model& m) {
    Sender s;
    uint32_t stamp = kStamp;
    s(stamp, const_cast<Model&>(m)); // members() serves both ways; a Sender changes nothing
    return std::move(s.bytes);
}

std::optional<Model> fromBytes(std::span<const uint8_t> bytes) {
    Receiver r(bytes);
    uint32_t stamp = 0;
    Model m;
    r(stamp);
    if (stamp != kStamp) return {};
    r(m);
    if (!r.done()) return {};
    return m;
}

} // namespace alpenglow::models
