// trace()'s "glass-ggx": reflection and refraction at rough facets. axis = normal; wo may lie on either side. part 0: reflection
// alone, 1: refraction alone. A facet is drawn by its slope; reflection or refraction by Fresnel's share at the normal, kept away
// from 0 and 1.
#pragma once
#include "lobes/kinds/facets.h"
#include "shadeops/bsdf/glass_ggx.h"

namespace alpenglow::transport::AL_NAMESPACE {

struct Glass {
    static constexpr const char* name = "glass-ggx";
    static constexpr const char* doc = "Reflection and refraction at facets with the distribution of Trowbridge and Reitz.";
    static constexpr bool distribution = true;
    static constexpr int needs = kNeedsWo | kNeedsHorizon | kNeedsSurface | kNeedsNumbers;
    // Own rows: the normal on the viewer's side, both tangents, indices here and there, roughness along and across, the share
    // that is drawn as reflection, the weights of both parts.
    enum : int { kSide = 0, kAlong = 3, kAcross = 6, kHere = 9, kThere, kRoughA, kRoughB, kReflect, kFirst, kSecond };
    static AL_MEMBER void prepare(const Rows& p) {
        p.common(vf(1), spreadOfRoughness(p), vf(0));
        const GlassSide<vf> s =
            glassSide(p.axis(), p.wo(), p.triple(kRowUdir), p.number(kRowRoughness), p.number(kRowRoughnessV), p.number(kRowEta));
        const vf f = dielectricReflectance(minLanes(absLanes(dot(s.n, s.o)), vf(1)), s.here / s.there), part = p.number(kRowPart);
        const vf count = p.number(kRowCount);
        p.own(kSide, s.n), p.own(kAlong, s.t.a), p.own(kAcross, s.t.b), p.own(kHere, s.here), p.own(kThere, s.there);
        p.own(kRoughA, s.a), p.own(kRoughB, s.b);
        p.own(kReflect, select(part == 0, vf(1), select(part == 1, vf(0), minLanes(maxLanes(f, vf(0.1f)), vf(0.9f)))));
        p.own(kFirst, where(part != 1, select(count > 0, p.number(kRowLobes), vf(1))));
        p.own(kSecond, where(part != 0, select(count > 1, p.number(kRowLobes + 1), vf(1))));
    }
    static AL_MEMBER GlassSide<vf> sideOf(const Given& p) {
        return {p.wo(),         p.ownTriple(kSide), {p.ownTriple(kAlong), p.ownTriple(kAcross)}, p.own(kHere), p.own(kThere),
                p.own(kRoughA), p.own(kRoughB)};
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const GlassValue<vf> v = glassValue(sideOf(p), w);
        const vf first = where(aboveHorizon(p, w), v.reflected) * p.own(kFirst), reflect = p.own(kReflect);
        return grey(mad(v.refracted, p.own(kSecond), first), select(v.reflects, reflect, vf(1) - reflect) * v.density);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const GlassSide<vf> s = sideOf(p);
        const vf reflect = p.own(kReflect);
        const vm reflects = u.a < reflect;
        const vf again = select(reflects, divide(u.a, reflect), divide(u.a - reflect, vf(1) - reflect));
        const vf r = rootLanes(again / maxLanes(vf(1) - again, vf(1e-7f)));
        const Pair<vf> d = unitCircle(u.b);
        const Direction h = toWorld(Basis{s.t.a, s.t.b, s.n}, normalize(Direction{s.a * r * d.a, s.b * r * d.b, vf(1)}));
        const vf oh = dot(s.o, h), e = s.here / s.there, k = mad(-e * e, mad(-oh, oh, vf(1)), vf(1));
        const Direction mirrored = mad3(h, oh * vf(2), -s.o), bent = mad3(h, mad(e, oh, -rootOf(k)), times(-s.o, e));
        w = normalize(select3(reflects, mirrored, bent));
        const vf side = dot(s.n, w);
        const vm meant = select(reflects, side, (k > 0 ? -side : vf(0))) > 0;
        return (oh > 1e-6f) & meant & (~reflects | aboveHorizon(p, w));
    }
};

} // namespace alpenglow::transport::AL_NAMESPACE
