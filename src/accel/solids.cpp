#include "accel/solids.h"
#include "scene/solids.h"
#include <algorithm>
#include <cmath>
#include <map>

namespace alpenglow::accel {

using scene::SolidOperation;

std::unique_ptr<Solids> Solids::of(const std::vector<geometry::ShapeRef>& shapes, Diagnostics& diag) {
    auto all = std::make_unique<Solids>();
    all->partOf_.assign(shapes.size(), kNone);
    std::map<std::pair<int, uint32_t>, uint32_t> node; // by instance and block
    for (uint32_t s = 0; s < shapes.size(); ++s) {
        const std::vector<scene::SolidStep>& path = scene::solidPath(shapes[s]->attributes());
        if (path.size() < 2 || path.back().operation != SolidOperation::Part) continue; // a single part is no solid
        uint32_t parent = kNone, root = kNone;
        for (const scene::SolidStep& step : path) {
            const auto [at, fresh] = node.try_emplace({shapes[s]->source().instance, step.id}, uint32_t(all->nodes_.size()));
            if (fresh) {
                all->nodes_.emplace_back().operation = int(step.operation);
                if (parent != kNone) {
                    Node& p = all->nodes_[parent];
                    const size_t place = size_t(std::upper_bound(p.order.begin(), p.order.end(), step.child) - p.order.begin());
                    p.order.insert(p.order.begin() + long(place), step.child);
                    p.children.insert(p.children.begin() + long(place), at->second);
                } else {
                    all->wholes_.push_back({at->second, {}});
                }
            }
            parent = at->second;
            if (root == kNone) root = parent;
        }
        uint32_t& part = all->nodes_[parent].part;
        if (part == kNone) {
            part = uint32_t(all->parts_.size());
            all->parts_.emplace_back();
            const auto whole =
                std::find_if(all->wholes_.begin(), all->wholes_.end(), [&](const Whole& w) { return w.root == root; });
            whole->parts.push_back(part);
            all->wholeOf_.push_back(uint32_t(whole - all->wholes_.begin()));
        }
        all->parts_[part].shapes.push_back(s);
        all->partOf_[s] = part;
    }
    if (all->parts_.empty()) return nullptr;
    for (Part& p : all->parts_) {
        std::vector<geometry::ShapeRef> own;
        for (uint32_t s : p.shapes) own.push_back(shapes[s]);
        p.surface = std::make_unique<Accel>(std::move(own), std::vector<uint32_t>(), diag);
    }
    return all;
}

Solids::Sides Solids::sidesOf(const Part& p, const Ray& of, double t, double near, const StopFlag* stop) const {
    constexpr int kMost = 100'000; // crossings
    Ray r = of;
    r.tnear = std::max(0.f, std::nextafter(float(t - 2 * near), 0.f));
    r.tfar = 1e38f;
    r.mask = kAll;
    r.excludeShape = r.excludePrim = kNone;
    r.passed = -1;
    r.sides = accel::Sides::Both;
    r.only = nullptr;
    bool behind = false, here = false;
    Hit h;
    for (int i = 0; i < kMost && !(stop && *stop) && p.surface->intersect(r, h); ++i) {
        if (h.distance > t + near) behind = !behind;
        else if (h.distance >= t - near) here = !here;
        r.excludeShape = h.shape;
        r.excludePrim = h.prim;
        r.passed = h.distance;
    }
    return {behind != here, behind};
}

template <class At> Solids::Sides Solids::resolve(uint32_t node, const At& at) const {
    const Node& n = nodes_[node];
    if (n.part != kNone) return at(n.part);
    if (n.children.empty()) return {false, false};
    const auto operation = SolidOperation(n.operation);
    // A difference whose first child is not drawn is empty.
    if (operation == SolidOperation::Difference && n.order[0] != 0) return {false, false};
    Sides all = resolve(n.children[0], at);
    for (size_t i = 1; i < n.children.size(); ++i) {
        const bool settled = operation == SolidOperation::Union ? all.before && all.behind : !all.before && !all.behind;
        if (settled) break;
        const Sides s = resolve(n.children[i], at);
        if (operation == SolidOperation::Union) all = {all.before || s.before, all.behind || s.behind};
        else if (operation == SolidOperation::Intersection) all = {all.before && s.before, all.behind && s.behind};
        else all = {all.before && !s.before, all.behind && !s.behind};
    }
    return all;
}

bool Solids::keeps(const Ray& r, uint32_t shape, double t, const StopFlag* stop) const {
    const uint32_t own = partOf_[shape];
    const Whole& whole = wholes_[wholeOf_[own]];
    // Distance between float coordinates that represent the same position.
    const auto norm = [](const Vec3& v) { return std::fabs(double(v.x)) + std::fabs(double(v.y)) + std::fabs(double(v.z)); };
    const double near = 4e-7 * (std::fabs(t) + norm(r.org) / std::max(norm(r.dir), 1e-300));
    int8_t few[64];
    std::fill(few, few + 64, int8_t(-1));
    std::vector<int8_t> many;
    if (whole.parts.size() > 64) many.assign(whole.parts.size(), -1);
    int8_t* const memo = many.empty() ? few : many.data();
    const auto place = [&](uint32_t part) {
        return size_t(std::lower_bound(whole.parts.begin(), whole.parts.end(), part) - whole.parts.begin());
    };
    const auto at = [&](uint32_t part) {
        int8_t& m = memo[place(part)];
        if (m < 0) {
            const Sides s = sidesOf(parts_[part], r, t, near, stop);
            m = int8_t(s.before | s.behind << 1);
        }
        return Sides{(m & 1) != 0, (m & 2) != 0};
    };
    const Sides s = resolve(whole.root, at);
    if (s.before == s.behind) return false;
    // The first part with a face here shows it.
    for (uint32_t p : whole.parts) {
        if (p == own) return true;
        if (const Sides other = at(p); other.before != other.behind) return false;
    }
    return true;
}

} // namespace alpenglow::accel
