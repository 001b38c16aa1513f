// What reaches the frame: lights, primitives, instances; and the current transformation.
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/motion.h"
#include "scene/primitivekinds.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {

void Interpreter::replaceCtm(const scene::Transform& m, const Call& call) {
    for (const Matrix& k : m.keys) {
        if (!finite(k)) {
            reporter.error(Rie::Range, call.place, fmt::format("{}: the transformation is not finite", call.request->name));
            return;
        }
        if (determinant3(k) == 0 && determinant(k) == 0)
            reporter.once("ri:singular", Severity::Warning, Rie::Math, call.place,
                          "the transformation is singular: what it holds is flattened");
    }
    state.ctm = m;
}

void Interpreter::concat(const scene::Transform& m, const Call& call) { replaceCtm(compose(m, state.ctm), call); }

void Interpreter::nameSystem(const std::string& name, bool scoped) {
    if (scoped) {
        auto s = std::make_shared<NamedSystems>(*state.scoped);
        (*s)[name] = state.ctm;
        state.scoped = std::move(s);
        systems_.insert({name, state.ctm}); // shaders look names up in one list: the first scoped one is there too
        return;
    }
    systems_[name] = state.ctm;
}

std::optional<scene::Transform> Interpreter::namedSystem(const std::string& name) const {
    if (auto i = state.scoped->find(name); i != state.scoped->end()) return i->second;
    if (auto i = systems_.find(name); i != systems_.end()) return i->second;
    if (name == "current" || name == "object" || name == "shader") return state.ctm;
    if (name == "camera" || name == "eye") return inWorld() ? inverse(worldToCamera_) : scene::Transform();
    if (name == "world" && inWorld()) return scene::Transform();
    return {};
}

void Interpreter::light(const Call& call, bool area) {
    if (area && (call.text(0).empty() || call.text(0) == "null")) {
        attributes().areaLight = -1;
        return;
    }
    if (lights().size() >= settings.mostLights) {
        reporter.once("ri:lights", Severity::Error, Rie::Limit, call.place, "there are too many lights");
        return;
    }
    scene::Light l;
    l.shader = shader(call);
    l.handle = call.text(1);
    l.area = area;
    // A light does not need the list of lights. Without it, the time for n lights in a row is not quadratic in n.
    auto own = std::make_shared<scene::Attributes>(*snapshot());
    own->lights.clear();
    l.attributes = std::move(own);
    int index = int(lights().size());
    const bool standard = l.shader->name.starts_with("PxrStd"); // of PRMan 19: on everywhere as those of 21
    lights().push_back(std::move(l));
    if (!call.text(1).empty()) handles_[call.text(1)] = index;
    attributes().lights.insert(index);
    if (area) attributes().areaLight = index;
    if (!standard) return;
    ris_ = true;
    globalLights_.insert(index);
}

void Interpreter::illuminate(const Call& call) {
    auto i = handles_.find(call.text(0));
    if (i == handles_.end()) {
        std::vector<std::string> known;
        for (auto& h : handles_) known.push_back(h.first);
        std::string near = nearestName(call.text(0), known);
        reporter.error(Rie::BadHandle, call.place, fmt::format("Illuminate: there is no light \"{}\"", call.text(0)),
                       near.empty() ? "" : "did you mean " + near + "?");
        return;
    }
    const bool on = call.integer(1) != 0;
    if (on == state.attributes->lights.contains(i->second)) return; // attributes stay shared
    if (on) attributes().lights.insert(i->second);
    else attributes().lights.erase(i->second);
}

namespace {
/// Exporters write meshes and clouds without a face or point for what is empty or hidden in their frame.
bool holdsNothing(const scene::Primitive& p) {
    if (!scene::has(p.kind, scene::kMayBeEmpty) || !p.ints.empty() || !p.ints2.empty() || p.params.empty()) return false;
    return std::all_of(p.params.begin(), p.params.end(), [](const scene::Param& q) {
        return (q.numbers.empty() && q.strings.empty()) || q.cls == scene::Class::Constant;
    });
}
} // namespace

/// The attributes of a primitive that is made now: in a solid, but in none of its parts, it is a part of its own.
scene::AttributesRef Interpreter::solidPart(const Call& call) {
    const std::vector<scene::SolidStep>& path = state.attributes->solid;
    if (path.empty() || path.back().operation == scene::SolidOperation::Part) return snapshot();
    reporter.once("ri:solidpart", Severity::Warning, Rie::BadSolid, call.place,
                  fmt::format("{} stands in a solid outside of SolidBegin \"primitive\": it counts as a part of its own",
                              call.request->name));
    const GraphicsState outer = state;
    shared_ = true;
    stepInto(scene::SolidOperation::Part);
    scene::AttributesRef part = snapshot();
    state = outer;
    shared_ = true;
    ++attributes().solidChildren;
    return part;
}

void Interpreter::emit(scene::Primitive p, const Call& call) {
    if (!inWorld() && !openObject()) {
        reporter.once("ri:noworld", Severity::Error, Rie::NotPrims, call.place,
                      fmt::format("{} outside WorldBegin and WorldEnd is not drawn", call.request->name));
        return;
    }
    if (p.kind.empty()) p.kind = std::string(call.request->name); // those of a file or of another shape have a kind
    p.place = call.place;
    p.attributes = solidPart(call);
    p.toWorld = state.ctm;
    if (holdsNothing(p)) {
        reporter.once("ri:nothing:" + p.kind, Severity::Warning, Rie::Consistency, call.place,
                      p.kind + " is empty: there is nothing to draw");
        return;
    }
    p.params.insert(p.params.end(), everywhere_.begin(), everywhere_.end());
    if (!fitVariables(p, reporter)) return;
    const Block* object = innermost(BlockKind::Object);
    p.attributesInside = object && object->saved.attributes != state.attributes;
    if (p.attributesInside) p.attributesBefore = object->saved.attributes;
    auto ref = std::make_shared<scene::Primitive>(std::move(p));
    if (capture_) capture_->push_back(std::move(ref));
    else store(std::move(ref));
}

void Interpreter::store(std::shared_ptr<scene::Primitive> p) {
    if (settings.executed) return;
    if (scene::Object* o = openObject()) {
        o->primitives.push_back(std::move(p));
        return;
    }
    if (frame_ && frameWanted()) frame_->primitives.push_back(std::move(p));
}

scene::AttributesRef Interpreter::withoutLights(const scene::AttributesRef& a, size_t stable) {
    bool stale = a->areaLight >= int(stable) || (!a->lights.empty() && size_t(a->lights.last()) >= stable);
    if (!stale) return a;
    auto copy = std::make_shared<scene::Attributes>(*a);
    copy->lights.keepBelow(int(stable));
    if (copy->areaLight >= int(stable)) copy->areaLight = -1;
    return copy;
}

/// An object as this world sees it: lights of the world it was made in are gone in another one.
scene::Object Interpreter::forThisWorld(const StoredObject& o) const {
    if (o.world == worldSerial_) return o.object;
    scene::Object out{o.object.handle, {}};
    size_t stable = std::min(o.world == 0 ? frame_->lights.size() : o.lights, frame_->lights.size());
    for (const scene::PrimitiveRef& p : o.object.primitives) {
        scene::AttributesRef a = withoutLights(p->attributes, stable);
        if (a == p->attributes) {
            out.primitives.push_back(p);
            continue;
        }
        auto copy = std::make_shared<scene::Primitive>(*p);
        copy->attributes = std::move(a);
        for (auto& k : copy->motionKeys) {
            k = std::make_shared<scene::Primitive>(*k);
            k->attributes = copy->attributes;
        }
        out.primitives.push_back(std::move(copy));
    }
    return out;
}

void Interpreter::instance(const Call& call) {
    auto i = objects_.find(call.text(0));
    if (i == objects_.end()) {
        std::vector<std::string> known;
        for (auto& o : objects_) known.push_back(o.first);
        std::string near = nearestName(call.text(0), known);
        reporter.error(Rie::BadHandle, call.place, fmt::format("ObjectInstance: there is no object \"{}\"", call.text(0)),
                       near.empty() ? "" : "did you mean " + near + "?");
        return;
    }
    if (openObject()) { // objects are flat: an instance inside one is copied in
        for (const scene::PrimitiveRef& p : i->second->object.primitives) {
            if (++objectCopies_ > limits::kObjectCopies) { // nested objects multiply: a few lines can make any number
                reporter.once("ri:objectcopies", Severity::Error, Rie::Limit, call.place,
                              fmt::format("instances inside objects copy more than {} primitives", limits::kObjectCopies));
                return;
            }
            auto copy = std::make_shared<scene::Primitive>(*p);
            copy->toWorld = compose(p->toWorld, state.ctm);
            if (!p->attributesInside) {
                copy->attributes = snapshot();
                const Block* object = innermost(BlockKind::Object);
                copy->attributesInside = object->saved.attributes != state.attributes;
                if (copy->attributesInside) copy->attributesBefore = object->saved.attributes;
            }
            store(std::move(copy));
        }
        return;
    }
    if (!inWorld()) {
        reporter.once("ri:noworld", Severity::Error, Rie::NotPrims, call.place,
                      "ObjectInstance outside WorldBegin and WorldEnd is not drawn");
        return;
    }
    place(*i->second, call.place);
}

void Interpreter::place(const StoredObject& object, const SourcePlace& where) {
    if (settings.executed) return;
    auto [slot, fresh] = objectIndex_.try_emplace(object.serial, int(frame_->objects.size()));
    if (fresh) frame_->objects.push_back(forThisWorld(object));
    scene::Instance n;
    n.object = slot->second;
    n.toWorld = state.ctm;
    n.attributes = snapshot();
    n.place = where;
    frame_->instances.push_back(std::move(n));
}

} // namespace alpenglow::ri
