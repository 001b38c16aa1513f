// Light sheets: a light sample for all points of a batch, evaluated when the first strip needs it. Most loops start at the
// surface's P and send no values, so the result does not depend on the loop; strips then look up their points. The numbers equal
// those that strips would compute one by one.
#include "services/services.h"
#include "world/cloudsite.h"
#include <bit>

namespace alpenglow::services {

bool hasSheets(const BoundLight& l) {
    // A sky depends on the loop's cone; lights that send samples, write AOVs, trace, print or bake run only for points that
    // request them.
    if (!l.kernel || l.kind == LightKind::Environment || l.sentCl >= 0 || l.channels || l.kernel.kernel->facts().suspends)
        return false;
    return std::none_of(l.kernel.sites.begin(), l.kernel.sites.end(), [](const SiteInfo& s) {
        return s.kind == SiteKind::Trace || s.kind == SiteKind::Transmission || s.kind == SiteKind::Occlusion ||
               s.kind == SiteKind::Gather || s.site->op == "printf" || (s.cloud && s.cloud->writes);
    });
}

int Services::sheetNumber(int light, int turn) {
    if (sheetNumbers_.size() != world_->lights().size()) {
        sheetNumbers_.assign(world_->lights().size(), -1);
        for (size_t i = 0; i < sheetNumbers_.size(); ++i) {
            const BoundLight& l = world_->lights()[i];
            if (!hasSheets(l) || size_t(sheets_) + size_t(l.samples) > limits::kLightCache) continue;
            sheetNumbers_[i] = sheets_;
            sheets_ += l.samples;
        }
    }
    const int number = sheetNumbers_[size_t(light)];
    return number < 0 ? -1 : number + turn;
}

const LightSheet* Services::sheetOf(KernelRun& c, const LightLoop& loop, int li, int turn, int first, uint64_t mask, int lanes) {
    if (loop.setup >= 0 || loop.refresh || c.light || c.volume) return nullptr;
    const int number = sheetNumber(li, turn);
    if (number < 0) return nullptr;
    if (loop.depth > 1 && sampledAnew(world_->lights()[size_t(li)], world_->settings().hider == Hider::Path)) return nullptr;
    for (int lane = 0; lane < lanes && first + lane < int(c.points.size()); ++lane) {
        if (!(mask >> lane & 1)) continue;
        const Vec3& P = c.points[size_t(first + lane)].P;
        for (int r = 0; r < 3; ++r)
            if (std::bit_cast<uint32_t>(loop.rows[size_t(r) * size_t(lanes) + size_t(lane)]) != std::bit_cast<uint32_t>(P[r]))
                return nullptr;
    }
    if (c.sheets.size() < size_t(sheets_)) c.sheets.resize(size_t(sheets_));
    LightSheet& sheet = c.sheets[size_t(number)];
    if (sheet.refused) return nullptr;
    if (!sheet.made) {
        // If few points of this strip need it, few others will.
        const int asking = std::popcount(mask), all = std::min(lanes, int(c.points.size()) - first);
        sheet.refused = 2 * asking < all;
        if (sheet.refused) return nullptr;
        fillSheet(c, loop, li, turn, sheet);
    }
    return &sheet;
}

void Services::fillSheet(KernelRun& c, const LightLoop& loop, int li, int turn, LightSheet& sheet) {
    const BoundLight& light = world_->lights()[size_t(li)];
    const size_t n = c.points.size(), width = size_t(light.valueWidth);
    sheet.made = true;
    sheet.size = int(n);
    sheet.out.resize(9 * n);
    sheet.reach.assign(n, {});
    sheet.values.assign(n * width, 0);
    sheet.lit.assign(n, 0);
    std::vector<ShadePoint>& q = sheetRoom_.q;
    std::vector<int>& of = sheetRoom_.of;
    std::vector<float>& factor = sheetRoom_.factor;
    q.clear();
    of.clear();
    factor.clear();
    for (size_t i = 0; i < n; ++i) {
        float f = 1;
        ShadePoint& p = q.emplace_back();
        if (!lightQuery(c, li, int(i), c.points[i].P, {}, float(kPi), turn, light.samples, drawOf(loop), p, &f)) {
            q.pop_back();
            continue;
        }
        of.push_back(int(i));
        factor.push_back(f);
    }
    std::vector<LightValue>& v = sheetRoom_.v;
    std::vector<float>& values = sheetRoom_.values;
    v.assign(q.size(), {});
    values.assign(q.size() * width, 0);
    LightCall call;
    LitSurface lit;
    call.values = &values;
    if (light.asksSurface) lit = litSurface(c, loop, of, 0, int(n)), call.lit = &lit;
    lightEvaluator_->evaluateLight(light, q, v, call);
    if (light.shadows) lightEvaluator_->shadowLight(c, light, 0, drawOf(loop), q, of, v);
    for (size_t k = 0; k < q.size(); ++k) {
        const size_t i = size_t(of[k]);
        std::copy_n(values.begin() + long(k * width), width, sheet.values.begin() + long(i * width));
        if (!v[k].lit) continue;
        const Vec3 toLight = -v[k].L;
        const Color Cl = v[k].Cl * factor[k];
        for (int r = 0; r < 3; ++r) {
            sheet.out[size_t(r) * n + i] = toLight[r];
            sheet.out[size_t(r + 3) * n + i] = Cl[r];
            sheet.out[size_t(r + 6) * n + i] = v[k].Ol[r];
        }
        sheet.reach[i] = {light.kind == LightKind::Distant ? 1e38f : length(toLight), v[k].shadowRadius};
        sheet.lit[i] = 1;
    }
}

const std::vector<Color>& Services::ambientOf(KernelRun& c) {
    if (!c.ambient.empty() || c.points.empty()) return c.ambient;
    c.ambient.assign(c.points.size(), Color(0));
    std::vector<ShadePoint>& q = sheetRoom_.q;
    std::vector<LightValue>& v = sheetRoom_.v;
    for (int li : world_->skies()) {
        const BoundLight& l = world_->lights()[size_t(li)];
        if (l.kind != LightKind::Ambient || !c.binding->lights.contains(li)) continue;
        q = c.points;
        for (size_t i = 0; i < q.size(); ++i) {
            q[i].Ps = c.points[i].P;
            q[i].lit = &c.points[i].surface;
            q[i].Ns = c.points[i].N;
            q[i].shape = nullptr;
        }
        v.assign(q.size(), {});
        lightEvaluator_->evaluateLight(l, q, v, {});
        for (size_t i = 0; i < q.size(); ++i) c.ambient[i] += v[i].Cl;
    }
    return c.ambient;
}

bool Services::allAmbientHaveSheets(const SurfaceBinding& b) const {
    return std::all_of(world_->skies().begin(), world_->skies().end(), [&](int li) {
        const BoundLight& l = world_->lights()[size_t(li)];
        return l.kind != LightKind::Ambient || !b.lights.contains(li) || hasSheets(l);
    });
}

} // namespace alpenglow::services
