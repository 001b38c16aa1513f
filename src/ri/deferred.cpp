// Procedurals whose content is made while their frame is rendered, once a ray comes to their bound. What is in one depends on
// the scene and on what it stands in, never on which others were made before: names that one declares are its own.
#include "ri/deferred.h"
#include "scene/scene.h"
#include <algorithm>
#include <map>
#include <utility>

namespace alpenglow::ri {

using scene::PrimitiveRef;

void Interpreter::putWaiting(Waiting w, std::vector<float> grown) {
    w.state = state;
    w.archives = openArchives_;
    w.replaying = replaying_;
    w.part = part_ + (part_.empty() ? "" : "/") + std::to_string(partsWithin_++);
    scene::Primitive p;
    p.kind = scene::kDeferred;
    p.ints = {int(waiting_.size()), 0};
    p.numbers = std::move(grown);
    p.strings.push_back(w.kind);
    p.strings.insert(p.strings.end(), w.arguments.begin(), w.arguments.end());
    p.attributes = snapshot();
    p.toWorld = state.ctm;
    p.place = w.call.place;
    waiting_.push_back(std::make_shared<Waiting>(std::move(w)));
    frame_->primitives.push_back(std::make_shared<scene::Primitive>(std::move(p)));
}

void Interpreter::restore(const Lasting& l) {
    declarations = l.declarations;
    options = l.options;
    state = l.state;
    nRGB = l.nRGB;
    lights_ = l.lights;
    handles_ = l.handles;
    systems_ = l.systems;
    resources_ = l.resources;
    objects_ = l.objects;
    inlineArchives_ = l.inlineArchives;
    if (errorStyle_ != l.errorStyle) setErrorStyle(l.errorStyle);
    errorsBefore_ = l.errorsBefore;
    errorsOfAllBefore_ = l.errorsOfAllBefore;
}

/// Procedurals from this number on refer to objects, lights and spaces by their current names.
void Interpreter::nameWaiting(size_t from) {
    if (from >= waiting_.size()) return;
    const auto names = std::make_shared<const Lasting>(lasting());
    for (size_t i = from; i < waiting_.size(); ++i) {
        auto w = std::make_shared<Waiting>(*waiting_[i]);
        w->names = names;
        waiting_[i] = std::move(w);
    }
}

/// Marks attributes with the part that they belong to.
void Interpreter::markPart(scene::Attributes& a) const { a.part = part_; }

/// Content of one that waits, behind what is there.
void Interpreter::makeWaiting(const Waiting& w, std::vector<PrimitiveRef>& out, const Wanted& wanted) {
    restore(*w.names);
    state = w.state;
    shared_ = true;
    part_ = w.part;
    partsWithin_ = 0;
    markPart(attributes());
    openArchives_ = w.archives;
    replaying_ = w.replaying;
    objectIndex_.clear(); // objects are shared within a part
    const size_t blocks = blocks_.size(), first = waiting_.size();
    std::vector<PrimitiveRef> content = std::move(frame_->primitives);
    frame_->primitives.clear();
    makeNow(w.kind, w.arguments, w.bound, w.call);
    nameWaiting(first);
    dropBlocks(blocks); // reported when the content ended
    content.swap(frame_->primitives);
    deeper([&] { putMade(content, out, wanted); });
}

void Interpreter::putMade(const std::vector<PrimitiveRef>& from, std::vector<PrimitiveRef>& out, const Wanted& wanted) {
    for (const PrimitiveRef& p : from) {
        if (!scene::isDeferred(*p) || !wanted(scene::deferredNumber(*p))) {
            out.push_back(p);
            continue;
        }
        auto made = std::make_shared<scene::Primitive>(*p);
        made->ints[1] = 1;
        out.push_back(std::move(made));
        const std::shared_ptr<const Waiting> w = waiting_[size_t(scene::deferredNumber(*p))];
        makeWaiting(*w, out, wanted);
    }
}

/// Orders instances by their parts, in the order of the scene.
void Interpreter::orderInstances(scene::Frame& f) const {
    std::map<std::string, size_t> order{{"", 0}};
    for (const PrimitiveRef& p : f.primitives)
        if (scene::isProcedural(*p)) order.try_emplace(waiting_[size_t(scene::deferredNumber(*p))]->part, order.size());
    std::vector<std::pair<size_t, scene::Instance>> of;
    for (scene::Instance& i : f.instances) of.emplace_back(order[scene::partOf(*i.attributes)], std::move(i));
    std::stable_sort(of.begin(), of.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t k = 0; k < of.size(); ++k) f.instances[k] = std::move(of[k].second);
}

std::shared_ptr<scene::Frame> Interpreter::makeSome(const scene::Frame& from, const Wanted& wanted) {
    const Lasting now = lasting();
    const scene::Transform camera = std::exchange(worldToCamera_, from.options.worldToCamera);
    auto conditions = std::exchange(conditions_, {});
    const int deepConditions = std::exchange(deepConditions_, 0);
    auto archives = std::exchange(openArchives_, {});
    auto barriers = std::exchange(barriers_, {blocks_.size() + 1});
    const bool replaying = replaying_;
    making_ = true;
    Block world;
    world.kind = BlockKind::World;
    blocks_.push_back(std::move(world));
    frame_ = std::make_shared<scene::Frame>(from);
    frame_->primitives.clear();
    std::vector<PrimitiveRef> all;
    putMade(from.primitives, all, wanted);
    frame_->primitives = std::move(all);
    std::shared_ptr<scene::Frame> made = std::move(frame_);
    frame_.reset();
    made->coordinateSystems.insert(systems_.begin(), systems_.end());
    overrideAttributes(*made);
    if (made->instances.size() > from.instances.size()) orderInstances(*made);
    blocks_.pop_back();
    making_ = false;
    replaying_ = replaying;
    barriers_ = std::move(barriers);
    openArchives_ = std::move(archives);
    conditions_ = std::move(conditions);
    deepConditions_ = deepConditions;
    worldToCamera_ = camera;
    part_.clear();
    partsWithin_ = 0;
    objectIndex_.clear();
    restore(now);
    shared_ = true;
    return made;
}

std::shared_ptr<const scene::Frame> Interpreter::make(const scene::Frame& frame, std::span<const int> which) {
    if (waiting_.empty() || inWorld()) return nullptr;
    const auto all = [](int) { return true; };
    if (which.empty()) return makeSome(frame, all);
    const std::set<int> some(which.begin(), which.end());
    const auto before = waiting_;
    std::shared_ptr<const scene::Frame> made = makeSome(frame, [&](int n) { return some.count(n) > 0; });
    if (made->lights.size() == frame.lights.size()) return made;
    // Lights have numbers by the order in which they were declared: that of the scene, whatever a ray meets first.
    waiting_ = before;
    return makeSome(frame, all);
}

} // namespace alpenglow::ri
