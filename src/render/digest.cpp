#include "render/digest.h"
#include "base/digest.h"
#include "scene/primitive.h"
#include "scene/scene.h"
#include <type_traits>
#include <unordered_map>
#include <utility>

namespace alpenglow::render {
namespace {

class SceneDigest {
public:
    uint64_t value() const { return digest_.value(); }

    void bits(uint64_t v) { digest_.add(&v, sizeof v); }
    template <class T>
        requires(std::is_arithmetic_v<T>)
    void add(T v) {
        digest_.add(&v, sizeof v);
    }
    void add(const std::string& s) { bytes(s.data(), s.size()); }
    template <class T> void add(const std::vector<T>& v) {
        bits(v.size());
        for (const T& e : v) add(e);
    }
    void add(const std::vector<float>& v) { bytes(v.data(), v.size() * sizeof(float)); }
    void add(const scene::LightSet& s) { add(s.runs()); }
    void add(const std::vector<int>& v) { bytes(v.data(), v.size() * sizeof(int)); }
    template <class T> void add(const std::optional<T>& v) {
        bits(v.has_value());
        if (v) add(*v);
    }
    void add(const Matrix& m) { bytes(m.m, sizeof m.m); }
    template <class T> void add(const Vec3T<T>& v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
    template <class T> void add(const scene::Moving<T>& m) {
        add(m.times);
        add(m.keys);
    }
    void add(const scene::Param& p) {
        add(p.name);
        bits(uint64_t(p.cls) << 40 | uint64_t(p.type) << 32 | uint32_t(p.arrayLength));
        add(p.numbers);
        add(p.strings);
    }
    template <class A, class B> void add(const std::pair<A, B>& p) {
        add(p.first);
        add(p.second);
    }
    template <class V> void add(const std::map<std::string, V>& m) {
        bits(m.size());
        for (const auto& [k, v] : m) {
            add(k);
            add(v);
        }
    }
    void add(const scene::Basis& b) { bytes(b.m, sizeof b.m), bits(uint64_t(b.step)); }
    void add(const scene::ShaderCall& s) {
        add(s.name);
        add(s.params);
        bits(s.connections.size());
        for (const scene::Connection& c : s.connections) {
            for (const std::string* t : {&c.parameter, &c.handle, &c.output}) add(*t);
            bits(uint64_t(c.element + 1));
        }
        add(s.toWorld);
    }
    void add(const scene::Attributes& a) {
        add(a.color);
        add(a.opacity);
        for (const auto& s : {a.surface, a.displacement, a.atmosphere, a.interior, a.exterior}) add(s);
        add(a.lights);
        bits(uint64_t(a.areaLight + 1));
        add(a.shadingRate);
        bits(uint64_t(a.smoothShading) << 16 | uint64_t(a.matte) << 8 | uint64_t(a.sides) << 4 | uint64_t(a.inside) << 2 |
             uint64_t(a.absoluteHandedness) << 1 | uint64_t(a.rightHanded));
        for (float t : a.textureCoordinates) add(t);
        add(a.ubasis);
        add(a.vbasis);
        add(a.bound);
        add(a.detail);
        add(a.detailSpace);
        for (float t : a.detailRange) add(t);
        add(a.values);
        for (const scene::SolidStep& s : a.solid) bits(uint64_t(s.id) << 32 | uint64_t(s.child) << 2 | uint64_t(s.operation));
        add(a.coshaders);
        add(a.trimCurve);
    }
    /// Shared objects are traversed once; after that their digest represents them.
    template <class T> void add(const std::shared_ptr<const T>& p) {
        if (!p) return bits(0);
        auto [i, fresh] = known_.try_emplace(p.get(), 0);
        if (fresh) {
            const Digest outer = std::exchange(digest_, Digest());
            add(*p);
            known_[p.get()] = value(); // the traversal may have moved the table
            digest_ = outer;
        }
        bits(known_[p.get()]);
    }
    void add(const scene::Primitive& p) {
        add(p.kind);
        add(p.numbers);
        add(p.ints);
        add(p.ints2);
        add(p.ints3);
        add(p.strings);
        add(p.params);
        add(p.attributes);
        add(p.toWorld);
        add(p.motionTimes);
        bits(p.motionKeys.size());
        for (const auto& k : p.motionKeys)
            if (k) add(*k);
        bits(p.attributesInside);
    }
    void add(const scene::Light& l) {
        add(l.shader);
        add(l.handle);
        bits(l.area);
        add(l.attributes);
    }
    void add(const scene::Object& o) { add(o.primitives); }
    void add(const scene::Instance& i) {
        bits(uint64_t(i.object + 1));
        add(i.toWorld);
        add(i.attributes);
    }
    void add(const scene::Options& o) {
        bits(uint64_t(uint32_t(o.xres)) << 32 | uint32_t(o.yres));
        for (float v : {o.pixelAspect, o.fov, o.clipNear, o.clipFar, o.fstop, o.focalLength, o.focalDistance, o.shutterOpen,
                        o.shutterClose, o.filter.xwidth, o.filter.ywidth, o.relativeDetail})
            add(v);
        add(o.frameAspect);
        add(o.screenWindow);
        add(o.projection);
        add(o.projectionParams);
        add(o.clippingPlanes);
        add(o.filter.name);
        add(o.hiderParams);
        for (const auto& [key, v] : o.values)
            if (key.rfind("searchpath:", 0) != 0 && key.rfind("statistics:", 0) != 0 && key.rfind("limits:", 0) != 0 &&
                key.rfind("render:", 0) != 0)
                add(v);
        add(o.worldToCamera);
    }

private:
    void bytes(const void* data, size_t n) {
        bits(n);
        digest_.add(data, n);
    }
    Digest digest_;
    std::unordered_map<const void*, uint64_t> known_;
};

} // namespace

std::string sceneDigest(const scene::Frame& f, const std::string& extra) {
    SceneDigest d;
    d.add(extra);
    d.add(f.options);
    d.add(f.lights);
    d.add(f.primitives);
    d.add(f.objects);
    d.add(f.instances);
    d.add(f.coordinateSystems);
    return digestText(d.value());
}

} // namespace alpenglow::render
