// Begin and End: what each block saves, how crossed and forgotten Ends are mended, how a world becomes a frame.
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/motion.h"
#include "ri/userprojection.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

constexpr const char* kBegins[] = {"FrameBegin", "WorldBegin",  "AttributeBegin", "TransformBegin",
                                   "SolidBegin", "ObjectBegin", "ResourceBegin",  "EditBegin"};
constexpr const char* kEnds[] = {"FrameEnd", "WorldEnd",  "AttributeEnd", "TransformEnd",
                                 "SolidEnd", "ObjectEnd", "ResourceEnd",  "EditEnd"};

/// Takes over what requests set, but keeps the place within a solid.
void takeAll(scene::Attributes& to, const scene::Attributes& from) {
    scene::Attributes restored = from;
    restored.solid = std::move(to.solid);
    restored.solidChildren = to.solidChildren;
    to = std::move(restored);
}

/// A block that an End of something smaller must not close.
bool encloses(BlockKind k) { return k == BlockKind::Frame || k == BlockKind::World || k == BlockKind::Object; }

} // namespace

const char* beginName(BlockKind k) { return kBegins[int(k)]; }
const char* endName(BlockKind k) { return kEnds[int(k)]; }

const Interpreter::Block* Interpreter::innermost(BlockKind kind) const {
    for (auto b = blocks_.rbegin(); b != blocks_.rend(); ++b)
        if (b->kind == kind) return &*b;
    return nullptr;
}

bool Interpreter::begin(BlockKind kind, const Call& call) {
    int& depth = depth_[size_t(kind)];
    if ((overflow_ > 0 || depth >= limits::kStackDepth) && kind != BlockKind::World) { // worlds do not nest
        if (overflow_++ == 0)
            reporter.error(
                Rie::Limit, call.place,
                fmt::format("{} is nested deeper than {}: deeper blocks save nothing", beginName(kind), limits::kStackDepth));
        return false;
    }
    ++depth;
    Block b;
    b.kind = kind;
    b.place = call.place;
    shared_ = true;
    b.saved = state;
    if (kind == BlockKind::Frame || kind == BlockKind::World) {
        b.options = std::make_unique<scene::Options>(options);
        b.lights = lights_.size();
        b.handles = handles_;
        b.systems = systems_;
    }
    if (kind == BlockKind::Resource) b.resources = resources_;
    blocks_.push_back(std::move(b));
    return true;
}

void Interpreter::end(BlockKind kind, const Call& call) {
    bool outer = kind == BlockKind::Frame || kind == BlockKind::World;
    if (making_ && outer) {
        reporter.error(Rie::Nesting, call.place, fmt::format("{} inside a procedural", endName(kind)));
        return;
    }
    if (overflow_ > 0 && kind != BlockKind::World) {
        --overflow_;
        return;
    }
    size_t lowest = outer || barriers_.empty() ? 0 : barriers_.back();
    size_t i = blocks_.size();
    bool found = false;
    while (i > lowest) {
        --i;
        if (blocks_[i].kind == kind) {
            found = true;
            break;
        }
        if (encloses(blocks_[i].kind) && !outer && kind != BlockKind::Object) break;
        if (kind == BlockKind::Object && blocks_[i].kind == BlockKind::World) break;
        if (kind == BlockKind::World && blocks_[i].kind == BlockKind::Frame && !inWorld()) break;
    }
    if (!found) {
        reporter.error(Rie::Nesting, call.place, fmt::format("{} without {}", endName(kind), beginName(kind)));
        return;
    }
    overflow_ = 0;
    while (blocks_.size() > i + 1) {
        Block& b = blocks_.back();
        reporter.error(
            Rie::Nesting, call.place,
            fmt::format("{} comes before the {} of line {} is closed", endName(kind), beginName(b.kind), b.place.line));
        pop();
    }
    pop();
    for (size_t& b : barriers_) b = std::min(b, blocks_.size());
}

/// Closes blocks down to `depth` because the stream is over: an error for each, but where reading was stopped. keepWorld:
/// frames and worlds stay open (an archive may open them).
void Interpreter::unwind(size_t depth, const SourcePlace& where, bool keepWorld) {
    while (blocks_.size() > depth) {
        Block& b = blocks_.back();
        if (keepWorld && !b.inner && (b.kind == BlockKind::World || b.kind == BlockKind::Frame)) {
            reporter.once("ri:openarchive", Severity::Warning, Rie::Nesting, b.place,
                          fmt::format("{} is left open by an archive", beginName(b.kind)));
            return;
        }
        if (!stopped())
            reporter.error(
                Rie::Nesting, where,
                fmt::format("{} ends before the {} of line {} is closed", where.file, beginName(b.kind), b.place.line));
        announceName(b.inner ? "AttributeEnd" : endName(b.kind), where);
        pop();
    }
}

void Interpreter::dropBlocks(size_t count) {
    for (; blocks_.size() > count; blocks_.pop_back())
        --depth_[size_t(blocks_.back().inner ? BlockKind::Attribute : blocks_.back().kind)];
}

void Interpreter::pop() {
    Block b = std::move(blocks_.back());
    dropBlocks(blocks_.size() - 1);
    shared_ = true;
    switch (b.kind) {
    case BlockKind::Transform:
        state.ctm = b.saved.ctm;
        return;
    case BlockKind::Resource:
        resources_ = std::move(b.resources);
        return;
    case BlockKind::Edit:
        return;
    case BlockKind::World:
        if (!b.inner) worldEnd(b);
        break;
    case BlockKind::Object:
        if (b.object) objects_[b.object->object.handle] = b.object;
        break;
    case BlockKind::Frame:
        options = std::move(*b.options);
        if (!inWorld()) { // a frame opened inside a world leaves that world's lights alone
            lights_.resize(std::min(lights_.size(), b.lights));
            handles_ = std::move(b.handles);
            systems_ = std::move(b.systems);
        }
        break;
    case BlockKind::Attribute:
        noteEnded(b);
        break;
    default:
        break;
    }
    state = std::move(b.saved);
}

bool Interpreter::frameWanted() const {
    if (settings.frames.empty() || !innermost(BlockKind::Frame)) return true;
    return std::find(settings.frames.begin(), settings.frames.end(), options.frameNumber) != settings.frames.end();
}

/// Shader spaces of calls made before WorldBegin lead to camera; from now on they lead to world.
void Interpreter::rebase(scene::Attributes& a, const scene::Transform& cameraToWorld) {
    auto move = [&](scene::ShaderRef& s) {
        if (!s) return;
        auto copy = std::make_shared<scene::ShaderCall>(*s);
        copy->toWorld = compose(s->toWorld, cameraToWorld);
        s = std::move(copy);
    };
    for (scene::ShaderRef* s : {&a.surface, &a.displacement, &a.atmosphere, &a.interior, &a.exterior}) move(*s);
    for (auto& [handle, s] : a.coshaders) move(s);
}

void Interpreter::worldBegin(const Call& call) {
    if (inWorld()) {
        if (making_) return reporter.error(Rie::Nesting, call.place, "WorldBegin inside a procedural: it is ignored");
        if (innerWorld(call)) return;
        reporter.error(Rie::Nesting, call.place, "WorldBegin inside a world: the open one ends here");
        end(BlockKind::World, call);
    }
    begin(BlockKind::World, call);
    bool singular = false;
    scene::Transform cameraToWorld = inverse(state.ctm, &singular);
    if (singular) {
        reporter.error(Rie::Math, call.place, "the camera transformation is singular: the identity is used");
        state.ctm = cameraToWorld = scene::Transform();
    }
    worldToCamera_ = state.ctm;
    std::erase_if(globalLights_, [&](int l) { return l >= int(lights_.size()); });
    const bool projected = takeProjection(worldToCamera_, options);
    frame_ = std::make_shared<scene::Frame>();
    ++worldSerial_;
    objectIndex_.clear();
    for (const scene::Light& l : lights_) {
        scene::Light moved = l;
        auto s = std::make_shared<scene::ShaderCall>(*l.shader);
        s->toWorld = compose(l.shader->toWorld, cameraToWorld);
        moved.shader = std::move(s);
        frame_->lights.push_back(std::move(moved));
    }
    worldCameraSystems_ = systems_;
    if (projected) // they led to the screen
        for (auto& [name, t] : worldCameraSystems_) t = compose(compose(t, cameraToWorld), worldToCamera_);
    for (auto& [name, t] : systems_) t = compose(t, cameraToWorld);
    if (!state.scoped->empty()) {
        auto scoped = std::make_shared<NamedSystems>(*state.scoped);
        for (auto& [name, t] : *scoped) t = compose(t, cameraToWorld);
        state.scoped = std::move(scoped);
    }
    rebase(attributes(), cameraToWorld);
    options.attributes = snapshot();
    state.ctm = scene::Transform();
}

void Interpreter::worldEnd(Block& b) {
    nameWaiting(0);
    if (!waiting_.empty()) ahead_.forget();
    shelf_.forgetPlaces();
    std::shared_ptr<scene::Frame> frame = std::move(frame_);
    frame_.reset();
    frame->options = std::move(options);
    frame->options.worldToCamera = worldToCamera_;
    frame->options.cameraSpaces = std::move(worldCameraSystems_);
    frame->coordinateSystems.insert(systems_.begin(), systems_.end());
    worldCameraSystems_.clear();
    // What the world set is over: lights, handles, systems, and options that did not belong here.
    options = std::move(*b.options);
    handles_ = std::move(b.handles);
    systems_ = std::move(b.systems);
    objectIndex_.clear();
    sharedArchives_.clear();
    if (!frameWanted()) return ended_.clear(), consumer.passOver(frame->options);
    if (aborted()) return ended_.clear(), waiting_.clear(), consumer.passOver(frame->options);
    frame->options.abortsOnError = errorStyle_ == ErrorStyle::Abort;
    risOptions(frame->options);
    if (settings.overrides) settings.overrides(frame->options);
    addHeadlight(*frame);
    overrideAttributes(*frame);
    sayUnlit(*frame);
    consumer.render(std::move(frame));
    waiting_.clear();
    partsWithin_ = 0;
}

void Interpreter::objectBegin(const Call& call) {
    if (begin(BlockKind::Object, call)) beginObject(call.text(0));
}

ObjectRef Interpreter::beginObject(const std::string& handle) {
    Block& b = blocks_.back();
    b.object = std::make_shared<StoredObject>();
    b.object->object.handle = handle;
    b.object->serial = ++objectSerial_;
    b.object->world = inWorld() ? worldSerial_ : 0;
    b.object->lights = lights_.size();
    state.ctm = scene::Transform(); // an object has a space of its own
    return b.object;
}

/// Goes a block of a solid down in the path that primitives keep.
void Interpreter::stepInto(scene::SolidOperation operation) {
    scene::Attributes& a = attributes();
    a.solid.push_back({++solidSerial_, operation, a.solidChildren});
    a.solidChildren = 0;
}

void Interpreter::beginSolid(scene::SolidOperation operation, const Call& call) {
    const std::vector<scene::SolidStep>& outer = state.attributes->solid;
    const bool inOther = !outer.empty();
    if (inOther && outer.back().operation == scene::SolidOperation::Part) {
        reporter.error(Rie::BadSolid, call.place, "SolidBegin inside a \"primitive\": what it holds belongs to that part");
        begin(BlockKind::Solid, call);
        return;
    }
    if (!begin(BlockKind::Solid, call)) return;
    stepInto(operation);
    // The block around it remembers that it has one child more.
    if (!inOther) return;
    GraphicsState& saved = blocks_.back().saved;
    saved.attributes = std::make_shared<scene::Attributes>(*saved.attributes);
    ++saved.attributes->solidChildren;
}

scene::Object* Interpreter::openObject() {
    const Block* b = innermost(BlockKind::Object);
    return b ? &b->object->object : nullptr;
}

namespace {

/// Takes attributes of some classes as they are in `from`.
void takeValues(scene::Attributes& to, const scene::Attributes& from, std::initializer_list<const char*> classes) {
    auto in = [&](const std::string& key) {
        return std::any_of(classes.begin(), classes.end(), [&](const char* c) { return key.starts_with(std::string(c) + ":"); });
    };
    std::erase_if(to.values, [&](const auto& v) { return in(v.first); });
    for (const auto& v : from.values)
        if (in(v.first)) to.values.insert(v);
}

// The subsets of Resource "attributes" "restore".

void takeShading(scene::Attributes& to, const scene::Attributes& from) {
    to.color = from.color;
    to.opacity = from.opacity;
    to.surface = from.surface;
    to.atmosphere = from.atmosphere;
    to.interior = from.interior;
    to.exterior = from.exterior;
    to.lights = from.lights;
    to.areaLight = from.areaLight;
    to.shadingRate = from.shadingRate;
    to.smoothShading = from.smoothShading;
    to.coshaders = from.coshaders;
    std::copy(std::begin(from.textureCoordinates), std::end(from.textureCoordinates), to.textureCoordinates);
    takeValues(to, from, {"shade", "trace", "light", "user", "irradiance", "photon", "subsurface", "shadow"});
}

void takeGeometryModification(scene::Attributes& to, const scene::Attributes& from) {
    to.displacement = from.displacement;
    to.trimCurve = from.trimCurve;
    takeValues(to, from, {"displacementbound", "trimcurve", "dice", "stitch", "GeometricApproximation"});
}

void takeGeometryDefinition(scene::Attributes& to, const scene::Attributes& from) {
    to.ubasis = from.ubasis;
    to.vbasis = from.vbasis;
    to.bound = from.bound;
    to.detail = from.detail;
    to.detailSpace = from.detailSpace;
    std::copy(std::begin(from.detailRange), std::end(from.detailRange), to.detailRange);
}

void takeHiding(scene::Attributes& to, const scene::Attributes& from) {
    to.sides = from.sides;
    to.matte = from.matte;
    to.inside = from.inside;
    to.absoluteHandedness = from.absoluteHandedness;
    to.rightHanded = from.rightHanded;
    takeValues(to, from, {"visibility", "sides", "cull", "hider", "grouping"});
}

} // namespace

void Interpreter::resource(const Call& call) {
    const std::string& handle = call.text(0);
    const std::string& type = call.text(1);
    std::string operation, subset = "all";
    for (const scene::Param& p : bind(call, Use::Other)) {
        if (p.strings.empty()) continue;
        if (p.name == "operation") operation = p.strings[0];
        if (p.name == "subset") subset = p.strings[0];
    }
    if (type != "attributes") return incapable(call, fmt::format("Resource of type \"{}\" has no effect", type));
    if (operation == "save") {
        shared_ = true;
        resources_[handle] = state;
        return;
    }
    if (operation != "restore") {
        reporter.error(Rie::BadToken, call.place,
                       fmt::format("Resource: operation \"{}\" is neither save nor restore", operation));
        return;
    }
    auto i = resources_.find(handle);
    if (i == resources_.end()) {
        reporter.error(Rie::BadHandle, call.place, fmt::format("Resource \"{}\" was not saved", handle));
        return;
    }
    const scene::Attributes& from = *i->second.attributes;
    bool all = subset == "all", known = all;
    scene::Attributes& to = attributes();
    auto part = [&](const char* name) {
        if (subset == name) known = true;
        return all || subset == name;
    };
    if (part("shading")) takeShading(to, from);
    if (part("geometrymodification")) takeGeometryModification(to, from);
    if (part("geometrydefinition")) takeGeometryDefinition(to, from);
    if (part("hiding")) takeHiding(to, from);
    if (part("transform")) state.ctm = i->second.ctm;
    if (all) takeAll(to, from);
    if (!part_.empty()) markPart(to);
    // Saved in a world that is over: its lights are gone.
    to.lights.keepBelow(int(lights().size()));
    if (to.areaLight >= int(lights().size())) to.areaLight = -1;
    if (!known) reporter.error(Rie::BadToken, call.place, fmt::format("Resource: unknown subset \"{}\"", subset));
}

} // namespace alpenglow::ri
