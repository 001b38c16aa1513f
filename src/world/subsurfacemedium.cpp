#include "world/subsurfacemedium.h"
#include "bsdf/dipole.h"
#include "world/impl.h"
#include <cmath>

namespace alpenglow::world {

namespace {

/// Defaults: marble, per mm (Jensen and others, A Practical Model for Subsurface Light Transport, 2001).
const Color kScattering{2.19f, 2.62f, 3.f}, kAbsorption{.0021f, .0041f, .0071f};

Color above0(const Color& c, float most) {
    Color r;
    for (int k = 0; k < 3; ++k) r[k] = c[k] > 0 ? std::min(c[k], most) : 0; // not a number: 0
    return r;
}

} // namespace

SubsurfaceValues::SubsurfaceValues(const scene::Attributes& a) {
    const auto colour = [&](const char* key, Color& to) {
        if (const scene::Param* p = a.value(key); p && p->numbers.size() >= 3)
            to = above0({float(p->numbers[0]), float(p->numbers[1]), float(p->numbers[2])}, 1e30f);
        else if (p && !p->numbers.empty()) to = above0(Color(float(p->numbers[0])), 1e30f);
    };
    const auto number = [&](const char* key, float fallback) {
        const scene::Param* p = a.value(key);
        return p && !p->numbers.empty() && std::isfinite(p->numbers[0]) ? float(p->numbers[0]) : fallback;
    };
    colour("subsurface:scattering", scattering);
    colour("subsurface:absorption", absorption);
    colour("subsurface:meanfreepath", path);
    colour("subsurface:reflectance", reflectance);
    index = number("subsurface:refractionindex", index);
    scale = number("subsurface:scale", scale);
    samples = int(std::clamp(number("subsurface:samples", -1), -1.f, 4096.f));
}

const AlbedoInversion& AlbedoInversions::of(float index) {
    const int n = int(index * 32 + 0.5f);
    return kept_.try_emplace(n, double(n) / 32).first->second;
}

double AlbedoInversions::albedoOf(const SubsurfaceMedium& b, double reflectance) {
    const AlbedoInversion& h = of(b.index);
    if (b.model == SubsurfaceSite::Model::Walk) return h.albedo(reflectance);
    double lo = 0, hi = 1;
    for (int i = 0; i < 40; ++i) {
        const double mid = 0.5 * (lo + hi);
        (Dipole(h, b.model == SubsurfaceSite::Model::BetterDipole, 1 - mid, mid).total() < reflectance ? lo : hi) = mid;
    }
    return lo;
}

SubsurfaceMedium subsurfaceMediumOf(const SubsurfaceSite& site, const SubsurfaceValues& of, const std::function<float(int)>& f,
                                    AlbedoInversions& spaces) {
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const auto colour = [&](int row, const Color& fallback) {
        return row < 0 ? fallback : above0({f(row), f(row + 1), f(row + 2)}, 1e30f);
    };
    SubsurfaceMedium b;
    b.model = site.model;
    const float index = number(site.index, of.index), scale = number(site.scale, of.scale);
    b.index = float(int((index > 1 / 3.f && index < 3 ? index : index >= 3 ? 3 : index > 0 ? 1 / 3.f : 1) * 32 + 0.5f)) / 32;
    const float g = number(site.anisotropy, 0);
    b.anisotropy = std::isfinite(g) ? std::clamp(g, -0.999f, 0.999f) : 0;
    const float perLength = scale > 0 && std::isfinite(scale) ? scale : 1;
    const bool coefficients = site.scattering >= 0 || site.absorption >= 0;
    const bool reported =
        site.reflectance >= 0 || site.path >= 0 || site.diffusePath >= 0 ||
        (!coefficients && of.scattering.x < 0 && of.absorption.x < 0 && (of.reflectance.x >= 0 || of.path.x >= 0));
    if (reported) { // for isotropic scattering, regardless of "anisotropy": the values describe the appearance
        b.anisotropy = 0;
        const Color r = above0(colour(site.reflectance, of.reflectance.x >= 0 ? of.reflectance : Color(0.8f)), 0.9999f);
        const Color path = colour(site.path, of.path.x >= 0 ? of.path : Color(1));
        const Color diffusePath = colour(site.diffusePath, Color(0));
        for (int k = 0; k < 3; ++k) {
            const double albedo = spaces.albedoOf(b, r[k]);
            double sigma = 1 / std::max(double(path[k]), 1e-6);
            if (site.diffusePath >= 0)
                sigma = 1 / (std::max(double(diffusePath[k]), 1e-6) * std::sqrt(3 * std::max(1 - albedo, 1e-6)));
            b.scattering[k] = float(sigma * albedo * perLength);
            b.absorption[k] = float(sigma * (1 - albedo) * perLength);
        }
    } else {
        b.scattering = above0(colour(site.scattering, of.scattering.x >= 0 ? of.scattering : kScattering) * perLength, 1e12f);
        b.absorption = above0(colour(site.absorption, of.absorption.x >= 0 ? of.absorption : kAbsorption) * perLength, 1e12f);
    }
    b.extinction = b.scattering + b.absorption;
    return b;
}

} // namespace alpenglow::world
