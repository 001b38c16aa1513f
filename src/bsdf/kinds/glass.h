// trace()'s "glass-ggx": reflection and refraction at rough facets. axis = normal; wo may be on either side. part 0: reflection
// only, 1: refraction only. Samples a visible facet, then reflection or refraction by Fresnel: the value is at most the larger
// weight times the density.
#pragma once
#include "bsdf/kinds/smith.h"
#include "shadeops/bsdf/glass_ggx.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// The lobe "glass-ggx": reflection and refraction, chosen by Fresnel's law.
struct Glass {
    static constexpr const char* name = "glass-ggx";
    static constexpr const char* doc = "Reflection and refraction at facets with the distribution of Trowbridge and Reitz.";
    static constexpr bool distribution = true;
    static constexpr int needs = kNeedsWo | kNeedsHorizon | kNeedsSurface | kNeedsNumbers;
    static constexpr int traits = kCosineOfAxis | kSameFromBoth | kRefracts;
    static constexpr float eta = kGlassEta;
    // Rows of its own: normal on the viewer's side, both tangents, indices of refraction here and beyond, roughness along and
    // across, weights of both parts.
    enum : int { kSide = 0, kAlong = 3, kAcross = 6, kHere = 9, kThere, kRoughA, kRoughB, kFirst, kSecond };
    static AL_MEMBER void prepare(const Rows& p) {
        const GlassSide<vf> s =
            glassSide(p.axis(), p.wo(), p.triple(kRowUdir), p.number(kRowRoughness), p.number(kRowRoughnessV), p.number(kRowEta));
        const vf part = p.number(kRowPart);
        const vf count = p.number(kRowCount);
        p.own(kSide, s.n), p.own(kAlong, s.t.a), p.own(kAcross, s.t.b), p.own(kHere, s.here), p.own(kThere, s.there);
        p.own(kRoughA, s.a), p.own(kRoughB, s.b);
        p.own(kFirst, where(part != 1, select(count > 0, p.number(kRowLobes), vf(1))));
        p.own(kSecond, where(part != 0, select(count > 1, p.number(kRowLobes + 1), vf(1))));
        const vf f =
            dielectricReflectance(minLanes(absLanes(dot(s.o, s.n)), vf(1)), s.here / s.there); // of the mean facet, about
        const vf both = mad(absLanes(p.own(kFirst)), f, absLanes(p.own(kSecond)) * (vf(1) - f));
        p.common(maxLanes(both, vf(.02f)), spreadOfRoughness(p), vf(0));
    }
    /// The directions and indices that prepare() stored.
    static AL_MEMBER GlassSide<vf> sideOf(const Given& p) {
        return {p.wo(),         p.ownTriple(kSide), {p.ownTriple(kAlong), p.ownTriple(kAcross)}, p.own(kHere), p.own(kThere),
                p.own(kRoughA), p.own(kRoughB)};
    }
    /// Probability of choosing reflection at a facet with Fresnel reflectance f.
    static AL_MEMBER vf shareReflected(const Given& p, vf f) {
        const vf first = absLanes(p.own(kFirst)) * f, both = mad(absLanes(p.own(kSecond)), vf(1) - f, first);
        return where(both > 0, first / both);
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const GlassValue<vf> v = glassValue(sideOf(p), w);
        const vf first = where(aboveHorizon(p, w), v.reflected) * p.own(kFirst), reflect = shareReflected(p, v.fresnel);
        return grey(mad(v.refracted, p.own(kSecond), first), select(v.reflects, reflect, vf(1) - reflect) * v.density);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const GlassSide<vf> s = sideOf(p);
        const Direction o = stretched({dot(s.o, s.t.a), dot(s.o, s.t.b), dot(s.o, s.n)}, s.a, s.b);
        const Direction h = toWorld(Basis{s.t.a, s.t.b, s.n}, visibleGgx(o, o.z, s.a, s.b, u));
        const vf oh = dot(s.o, h), e = s.here / s.there, k = mad(-e * e, mad(-oh, oh, vf(1)), vf(1));
        const Direction mirrored = mad3(h, oh * vf(2), -s.o), bent = mad3(h, mad(e, oh, -rootOf(k)), times(-s.o, e));
        const vf fresnel = dielectricReflectance(minLanes(oh, vf(1)), e);
        const vm mirrors = withinTurn(u.b) < shareReflected(p, fresnel);
        w = normalize(select3(mirrors, mirrored, bent));
        const vf side = dot(s.n, w);
        const vm meant = select(mirrors, side, (k > 0 ? -side : vf(0))) > 0;
        return (oh > 1e-6f) & meant & (~mirrors | aboveHorizon(p, w));
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
