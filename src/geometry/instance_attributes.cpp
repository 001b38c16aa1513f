#include "geometry/instance_attributes.h"
#include "scene/motion.h"
#include "scene/scene.h"
#include <cstring>

namespace alpenglow::geometry {
namespace {

/// Takes a value that was set inside the object.
template <class T> void take(T& to, const T& inside, const T& before) {
    if (!(inside == before)) to = inside;
}
template <class T> void takeBytes(T& to, const T& inside, const T& before) {
    if (std::memcmp(&inside, &before, sizeof(T)) != 0) std::memcpy(&to, &inside, sizeof(T));
}
void takeBasis(scene::Basis& to, const scene::Basis& inside, const scene::Basis& before) {
    if (std::memcmp(inside.m, before.m, sizeof inside.m) != 0 || inside.step != before.step) to = inside;
}
void takeShader(scene::ShaderRef& to, const scene::ShaderRef& inside, const scene::ShaderRef& before,
                const scene::Transform& toWorld) {
    if (inside == before) return;
    if (!inside) {
        to = nullptr;
        return;
    }
    auto moved = std::make_shared<scene::ShaderCall>(*inside);
    moved->toWorld = scene::compose(inside->toWorld, toWorld);
    to = std::move(moved);
}
bool same(const scene::Param* a, const scene::Param* b) {
    return a && b && a->type == b->type && a->numbers == b->numbers && a->strings == b->strings;
}

} // namespace

scene::AttributesRef instanceAttributes(const scene::Primitive& p, const scene::Instance& instance) {
    if (!instance.attributes) return p.attributes;
    if (!p.attributesInside || !p.attributesBefore || !p.attributes) return instance.attributes;
    auto out = std::make_shared<scene::Attributes>(*instance.attributes);
    const scene::Attributes &in = *p.attributes, &was = *p.attributesBefore;
    take(out->color, in.color, was.color);
    take(out->opacity, in.opacity, was.opacity);
    takeShader(out->surface, in.surface, was.surface, instance.toWorld);
    takeShader(out->displacement, in.displacement, was.displacement, instance.toWorld);
    takeShader(out->atmosphere, in.atmosphere, was.atmosphere, instance.toWorld);
    takeShader(out->interior, in.interior, was.interior, instance.toWorld);
    takeShader(out->exterior, in.exterior, was.exterior, instance.toWorld);
    take(out->lights, in.lights, was.lights);
    take(out->areaLight, in.areaLight, was.areaLight);
    take(out->shadingRate, in.shadingRate, was.shadingRate);
    take(out->smoothShading, in.smoothShading, was.smoothShading);
    take(out->matte, in.matte, was.matte);
    take(out->sides, in.sides, was.sides);
    if (in.inside != was.inside || in.absoluteHandedness != was.absoluteHandedness || in.rightHanded != was.rightHanded) {
        out->inside = in.inside;
        out->absoluteHandedness = in.absoluteHandedness;
        out->rightHanded = in.rightHanded;
    }
    takeBytes(out->textureCoordinates, in.textureCoordinates, was.textureCoordinates);
    takeBytes(out->detailRange, in.detailRange, was.detailRange);
    takeBasis(out->ubasis, in.ubasis, was.ubasis);
    takeBasis(out->vbasis, in.vbasis, was.vbasis);
    take(out->bound, in.bound, was.bound);
    if (in.detail != was.detail || !(in.detailSpace == was.detailSpace)) {
        out->detail = in.detail;
        out->detailSpace = in.detailSpace * instance.toWorld.first();
    }
    take(out->trimCurve, in.trimCurve, was.trimCurve);
    if (in.solid != was.solid) {
        out->solid = in.solid;
        out->solidChildren = in.solidChildren;
    }
    take(out->part, in.part, was.part);
    take(out->level, in.level, was.level);
    for (const auto& [key, value] : in.values)
        if (!same(&value, was.value(key))) out->values[key] = value;
    for (const auto& [name, shader] : in.coshaders) {
        auto before = was.coshaders.find(name);
        takeShader(out->coshaders[name], shader, before == was.coshaders.end() ? nullptr : before->second, instance.toWorld);
    }
    return out;
}

} // namespace alpenglow::geometry
