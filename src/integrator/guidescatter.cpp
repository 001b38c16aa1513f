#include "integrator/guidescatter.h"
#include "integrator/guiderays.h"
#include "integrator/lightpathstates.h"
#include "integrator/lobeselection.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include <algorithm>

namespace alpenglow::integrator {

GuideScatter::GuideScatter(const StageSet& s, const VertexLobes& v, const LobeSelection& selection)
    : VertexStage(s, v), selection_(selection), guide_(s.guide), paths_(s.paths), media_(s.media) {}

/// Whether the lobe's ray is an ordinary one, samples lights, and adds to the light of its point.
bool GuideScatter::mayGuide(const LobeVertex& l) const {
    return l.followed && l.chosen > 0 && l.lights && !l.delta && !l.elsewhere && !l.ownsTarget && l.below < 0 && !(l.base > 0) &&
           l.indirect > 0 && !l.fade.fades() && !l.rays->gathersPhotons;
}

int GuideScatter::guidedLobe(size_t point) const {
    int found = -1;
    float most = 0;
    for (const int i : lobesOf(point)) {
        const LobeVertex& l = requests_.lobes[size_t(i)];
        if (!mayGuide(l)) continue;
        const float gives = luminance(absolute(l.weight)) * l.albedo;
        if (gives > most) found = i, most = gives;
    }
    return found;
}

void GuideScatter::run(Sched& sched) {
    if (!guide_.on() || c_->between) return;
    sent_.clear();
    std::vector<GuideRays::Aim> aims;
    for (size_t point = 0; point < c_->points.size(); ++point) {
        const PathRay& from = c_->rays[point];
        if (begin_[point] == begin_[point + 1] || from.guided() || from.quiet) continue;
        const int lobe = guidedLobe(point);
        if (lobe < 0) continue;
        LobeVertex& l = requests_.lobes[size_t(lobe)];
        const ShadePoint& p = c_->points[point];
        const float brings = luminance(absolute(from.weight * l.weight)) * l.albedo;
        const GuideRays::Aim aim = guide_.aimAt(p.P, p.surface.n, from.dir, brings);
        l.guide = aim.trail();
        Vec3 w;
        if (!guide_.draws(from, aim, p.P, w)) continue;
        requests_.rows.ask(l.place, w);
        sent_.push_back({lobe, w});
        aims.push_back(aim);
    }
    requests_.rows.evaluate();
    for (size_t k = 0; k < sent_.size(); ++k) {
        const LobeVertex& l = requests_.lobes[size_t(sent_[k].lobe)];
        const Vec3& w = sent_[k].w;
        const PathRay& from = rayOf(l);
        const ShadePoint& p = c_->points[size_t(l.point)];
        LobeValue value = requests_.rows.value(l.place);
        value.pdf = l.beside.density(w, value.pdf);
        const float indirect = (l.lobeOfShader ? selection_.indirectScale[size_t(l.point)] : 1) * l.indirect;
        guide_.send({from, l.target, p.P, l.weight, indirect, l.chosen, requests_.rows.spread(l.place), l.rays, shareOf(l),
                     l.importance, l.maxDistance},
                    aims[k], w, value, origin(l, w), paths_.atLobe(l, p, from, w), media_.towards(*c_, l.point, w), sched);
    }
}

} // namespace alpenglow::integrator
