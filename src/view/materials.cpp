#include "view/materials.h"
#include "scene/scene.h"
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace alpenglow::view {
namespace {

using scene::Attributes;
using scene::AttributesRef;
using scene::ShaderCall;
using scene::ShaderRef;

constexpr std::pair<const char*, ShaderRef Attributes::*> kRoles[] = {{"surface", &Attributes::surface},
                                                                      {"displacement", &Attributes::displacement},
                                                                      {"atmosphere", &Attributes::atmosphere},
                                                                      {"interior", &Attributes::interior},
                                                                      {"exterior", &Attributes::exterior}};

class Collector {
public:
    explicit Collector(size_t most) : most_(most) {}
    std::vector<ShaderUse> uses;
    void take(const char* role, const ShaderRef& call, const std::string& handle = {}, bool area = false) {
        if (!call) return;
        const auto [at, fresh] = numbers_.try_emplace(call.get(), uses.size());
        if (fresh && uses.size() < most_) uses.push_back({role, call, 0, handle, area});
        else if (fresh) at->second = most_;
        if (at->second < uses.size()) ++uses[at->second].primitives;
    }
    void take(const AttributesRef& a) {
        if (!a) return;
        for (const auto& [role, member] : kRoles) take(role, (*a).*member);
        for (const auto& [handle, call] : a->coshaders) take("coshader", call, handle);
    }

private:
    size_t most_;
    std::unordered_map<const ShaderCall*, size_t> numbers_;
};

/// Copies of attributes with other shaders, each made once.
class Changer {
public:
    std::unordered_map<const ShaderCall*, ShaderRef> calls;
    ShaderRef operator()(const ShaderRef& s) const {
        const auto i = calls.find(s.get());
        return i == calls.end() ? s : i->second;
    }
    AttributesRef operator()(const AttributesRef& a) {
        if (!a) return a;
        const auto [at, fresh] = attributes_.try_emplace(a.get(), a);
        if (!fresh) return at->second;
        const bool any =
            std::any_of(std::begin(kRoles), std::end(kRoles),
                        [&](const auto& r) { return calls.contains(((*a).*r.second).get()); }) ||
            std::any_of(a->coshaders.begin(), a->coshaders.end(), [&](const auto& c) { return calls.contains(c.second.get()); });
        if (!any) return a;
        auto copy = std::make_shared<Attributes>(*a);
        for (const auto& [role, member] : kRoles) (*copy).*member = (*this)((*a).*member);
        for (auto& [handle, call] : copy->coshaders) call = (*this)(call);
        return at->second = copy;
    }
    scene::PrimitiveRef operator()(const scene::PrimitiveRef& p) {
        AttributesRef now = (*this)(p->attributes), before = (*this)(p->attributesBefore);
        if (now == p->attributes && before == p->attributesBefore) return p;
        auto copy = std::make_shared<scene::Primitive>(*p);
        copy->attributes = std::move(now);
        copy->attributesBefore = std::move(before);
        return copy;
    }

private:
    std::unordered_map<const Attributes*, AttributesRef> attributes_;
};

} // namespace

std::vector<ShaderUse> shadersOf(const scene::Frame& f, size_t most) {
    Collector c(most);
    for (const scene::Light& l : f.lights) {
        c.take("light", l.shader, l.handle, l.area);
        if (l.attributes) // co-shaders
            for (const auto& [handle, call] : l.attributes->coshaders) c.take("coshader", call, handle);
    }
    for (const scene::PrimitiveRef& p : f.primitives) c.take(p->attributes);
    for (const scene::Object& o : f.objects)
        for (const scene::PrimitiveRef& p : o.primitives) c.take(p->attributes);
    for (const scene::Instance& i : f.instances) c.take(i.attributes);
    c.take("imager", f.options.imager);
    return std::move(c.uses);
}

std::shared_ptr<const scene::Frame> changed(const std::shared_ptr<const scene::Frame>& frame, const std::vector<ShaderUse>& uses,
                                            const ParameterChanges& changes) {
    Changer change;
    for (const auto& [number, params] : changes) {
        if (number >= uses.size() || params.empty()) continue;
        auto call = std::make_shared<ShaderCall>(*uses[number].call);
        for (const scene::Param& p : params) {
            const auto same =
                std::find_if(call->params.begin(), call->params.end(), [&](const scene::Param& q) { return q.name == p.name; });
            if (same == call->params.end()) call->params.push_back(p);
            else *same = p;
        }
        change.calls[uses[number].call.get()] = call;
    }
    if (change.calls.empty()) return frame;
    auto copy = std::make_shared<scene::Frame>(*frame); // primitives by reference
    copy->options.imager = change(copy->options.imager);
    copy->options.attributes = change(copy->options.attributes);
    for (scene::Light& l : copy->lights) {
        l.shader = change(l.shader);
        l.attributes = change(l.attributes);
    }
    for (scene::PrimitiveRef& p : copy->primitives) p = change(p);
    for (scene::Object& o : copy->objects)
        for (scene::PrimitiveRef& p : o.primitives) p = change(p);
    for (scene::Instance& i : copy->instances) i.attributes = change(i.attributes);
    return copy;
}

} // namespace alpenglow::view
