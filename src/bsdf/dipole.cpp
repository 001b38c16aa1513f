// Diffusion models of subsurface(): exact for a half space of high albedo, otherwise a biased approximation.
#include "bsdf/dipole.h"
#include "base/exact.h"
#include "base/vec.h"

namespace alpenglow::bsdf {

Dipole::Dipole(const AlbedoInversion& boundary, bool better, double absorption, double scattering) {
    const double sigma = absorption + scattering;
    albedo_ = scattering / sigma;
    depth_ = 1 / sigma;
    if (better) { // d'Eon, A Better Dipole (2012): Grosjean's diffusion, boundary by both moments of the reflection
        spread_ = (2 * absorption + scattering) / (3 * sigma * sigma);
        const double c1 = boundary.first(), c2 = boundary.second(); // 2 C1 and 3 C2
        const double edge = 2 * spread_ * (1 + c2) / (1 - c1);
        image_ = depth_ + 2 * edge;
        fluence_ = (1 - c1) / 4;
        flux_ = (1 - c2) / 2;
    } else { // Jensen and others, A Practical Model for Subsurface Light Transport (2001)
        spread_ = 1 / (3 * sigma);
        const double n = boundary.index();
        const double fdr = n >= 1 ? -1.440 / (n * n) + 0.710 / n + 0.668 + 0.0636 * n
                                  : -0.4399 + 0.7099 / n - 0.3319 / (n * n) + 0.0636 / (n * n * n);
        const double a = n == 1 ? 1 : (1 + fdr) / (1 - fdr);
        image_ = depth_ + 4 * a * spread_;
        flux_ = 1;
    }
    fall_ = std::sqrt(absorption / spread_);
}

double Dipole::at(double r) const {
    const auto part = [&](double z, double& fluence) {
        const double d = std::sqrt(r * r + z * z), e = exact::exp(-fall_ * d);
        fluence = e / d;
        return z * (1 + fall_ * d) * e / (d * d * d);
    };
    double below, above;
    const double flux = part(depth_, below) + part(image_, above);
    return albedo_ / (4 * kPi) * (flux_ * flux + fluence_ / spread_ * (below - above));
}

// Rings of equal area, sampled at the centres of their sectors. At the point itself at() is steep, so inner rings are finer.
double Dipole::over(double distance, double radius) const {
    if (!(radius > 0)) return at(distance);
    constexpr int kRings = 6, kTurns = 6;
    static constexpr double kCos[kTurns] = {0.9659258262890683,  0.7071067811865476,  0.2588190451025207,
                                            -0.2588190451025207, -0.7071067811865476, -0.9659258262890683};
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const double a = double(i) / kRings, b = double(i + 1) / kRings; // edges of the ring: radius times their squares
        const double r = radius * 0.5 * (a * a + b * b), part = b * b * b * b - a * a * a * a;
        double ring = 0;
        for (const double c : kCos) ring += at(std::sqrt(std::max(0.0, distance * distance + r * r - 2 * distance * r * c)));
        sum += part * ring / kTurns;
    }
    return sum;
}

double Dipole::total() const {
    const double below = exact::exp(-fall_ * depth_), above = exact::exp(-fall_ * image_);
    const double fluence = fall_ > 1e-9 ? (below - above) / fall_ : image_ - depth_;
    return albedo_ / 2 * (flux_ * (below + above) + fluence_ / spread_ * fluence);
}

// Mixture: half by the exponential falloff far away, half by the distance to the source below.
double Dipole::choose(float which, float u) const {
    if (which < 0.5f && fall_ > 0) return -exact::log(1 - std::min(double(u), 1 - 0x1p-24)) / fall_;
    const double c = 1 - std::min(double(u), 1 - 0x1p-24);
    return depth_ * std::sqrt(1 / (c * c) - 1);
}

double Dipole::density(double r) const {
    const double d2 = r * r + depth_ * depth_, near = depth_ / (2 * kPi * d2 * std::sqrt(d2));
    if (!(fall_ > 0)) return near;
    return 0.5 * near + 0.5 * fall_ * exact::exp(-fall_ * r) / (2 * kPi * std::max(r, 1e-30));
}

} // namespace alpenglow::bsdf
