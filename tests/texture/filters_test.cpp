// Filters against sums over the footprint: many points in the parallelogram, weighed by the filter as RISpec has it, each the
// interpolated picture itself, for every wrap mode; environments likewise over directions. The lookups have the filter's mean and
// variance, not its shape (docs/maps.md): on waves that are longer than the footprint that is a few thousandths.
#include "base/exact.h"
#include "pictures.h"
#include <cmath>
#include <random>

namespace filters_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::texture::test;
using display::Image;

namespace {

constexpr double kTurn = 6.283185307179586;

double weightOf(Filter f, double a, double b) {
    if (f == Filter::Box) return std::fabs(a) <= .5 && std::fabs(b) <= .5 ? 1 : 0;
    if (f == Filter::Triangle) return std::max(0.0, 1 - std::fabs(a)) * std::max(0.0, 1 - std::fabs(b));
    return std::exp(-2 * (a * a + b * b));
}

/// The sum of value(a, b) over the filter; a and b run over the two sides of the footprint.
template <class Value> double overFilter(Filter f, Value value) {
    constexpr int n = 96; // along -1 to 1
    double sum = 0, weights = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double a = (i + .5) * 2 / n - 1, b = (j + .5) * 2 / n - 1, w = weightOf(f, a, b);
            if (w > 0) sum += w * value(a, b);
            weights += w;
        }
    return sum / weights;
}

/// Waves of the map's length, which go on in a periodic map; a clamped or mirrored copy differs from a periodic one.
Image waves(int n) {
    Image m = display::makeImage(n, n, {"y"});
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double s = (x + .5) / n, t = (y + .5) / n;
            m.pixel(x, y)[0] = float(.5 + .25 * std::cos(kTurn * s + .4) + .25 * std::sin(kTurn * t + .9));
        }
    return m;
}

/// The map at any place, by its wrap mode: what interpolation of an endless picture would give.
double endless(const Image& m, const std::string& wrap, double s, double t) {
    const auto texel = [&](long x, long y) {
        const auto place = [&](long i, long n) -> long {
            if (wrap == "periodic") return ((i % n) + n) % n;
            if (wrap == "clamp") return std::clamp(i, 0l, n - 1);
            if (wrap == "mirror") {
                const long k = ((i % (2 * n)) + 2 * n) % (2 * n);
                return k < n ? k : 2 * n - 1 - k;
            }
            return i < 0 || i >= n ? -1 : i;
        };
        const long a = place(x, m.width), b = place(y, m.height);
        return a < 0 || b < 0 ? 0.0 : double(m.pixel(int(a), int(b))[0]);
    };
    const double x = s * m.width - .5, y = t * m.height - .5, fx = std::floor(x), fy = std::floor(y), u = x - fx, v = y - fy;
    const long i = long(fx), j = long(fy);
    return (1 - v) * ((1 - u) * texel(i, j) + u * texel(i + 1, j)) + v * ((1 - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
}

} // namespace

TEST(Filters, AreSumsOverTheFootprintForEveryWrap) {
    const Image m = waves(64);
    for (const char* wrap : {"black", "clamp", "periodic", "mirror"})
        for (Filter f : {Filter::Box, Filter::Triangle, Filter::Gaussian}) {
            const auto t = makeTextureFrom(withWrap(m, wrap));
            std::mt19937 random(11);
            const auto number = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
            double sum = 0, worst = 0;
            constexpr int n = 120;
            for (int k = 0; k < n; ++k) {
                const double s = number(-.6, 1.6), tt = number(-.6, 1.6), turn = number(0, kTurn), a = number(.02, .2),
                             b = a * number(.1, 1);
                const double ax = a * std::cos(turn), ay = a * std::sin(turn), bx = -b * std::sin(turn), by = b * std::cos(turn);
                const double expected = overFilter(
                    f, [&](double p, double q) { return endless(m, wrap, s + p * ax + q * bx, tt + p * ay + q * by); });
                LookupOptions o;
                o.filter = f;
                float v = -1;
                lookup2D(t.get(), 0, 1, float(s), float(tt), float(ax), float(ay), float(bx), float(by), o, &v);
                sum += std::fabs(double(v) - expected);
                worst = std::max(worst, std::fabs(double(v) - expected));
            }
            // Outside of a clamped map coarse levels show the mean of their outermost texel, not its edge: off by half a texel
            // of up to 0.17 of the map, of waves with a slope of 1.6. At the edge of a black map the shape of the filter shows.
            const bool edge = std::string(wrap) == "black" || std::string(wrap) == "clamp";
            EXPECT_LT(sum / n, edge ? .02 : .006) << wrap << " " << int(f);
            EXPECT_LT(worst, edge ? .14 : .035) << wrap << " " << int(f);
        }
}

TEST(Filters, EachAxisHasItsWrap) {
    Image m = waves(64);
    m.metadata["wrapmodes"] = "mirror,black";
    const auto t = makeTextureFrom(m);
    for (double s : {-.3, .4, 1.2, 1.7})
        for (double y : {.1, .5, .93}) {
            float v = -1, beside = -1;
            lookup2D(t.get(), 0, 1, float(s), float(y), 0, 0, 0, 0, {}, &v);
            EXPECT_NEAR(v, endless(m, "mirror", s, y), 1e-5);
            lookup2D(t.get(), 0, 1, float(s), float(y) + 1.2f, 0, 0, 0, 0, {}, &beside);
            EXPECT_EQ(beside, 0);
        }
}

TEST(Filters, SlopesAreThoseOfTheLookupUnderMirrors) {
    const auto t = makeTextureFrom(withWrap(waves(64), "mirror"));
    for (float s : {-.73f, -.21f, .4f, 1.31f, 1.82f}) {
        LookupOptions o;
        float v, slopes[2], before, after;
        const float step = 1.f / 64; // half a texel either side
        lookup2D(t.get(), 0, 1, s, .37f, 0, 0, 0, 0, o, &v, slopes);
        lookup2D(t.get(), 0, 1, s - step / 2, .37f, 0, 0, 0, 0, o, &before);
        lookup2D(t.get(), 0, 1, s + step / 2, .37f, 0, 0, 0, 0, o, &after);
        EXPECT_NEAR(slopes[0], (after - before) / step, 2e-4f) << s;
    }
}

namespace {

/// A smooth function of direction.
double light(const Vec3d& w) { return .5 + .3 * w.x - .2 * w.z * w.x + .25 * w.y * w.y; }

/// The mean of light over the filter, in directions.
double overDirections(const Vec3d& d, const Vec3d& dx, const Vec3d& dy) {
    return overFilter(Filter::Gaussian, [&](double a, double b) {
        const Vec3d w = d + dx * a + dy * b;
        return light(w / std::sqrt(dot(w, w)));
    });
}

Vec3d perpendicular(const Vec3d& d, double turn, double size) {
    const Vec3d beside = std::fabs(d.z) < .8 ? Vec3d(-d.y, d.x, 0) : Vec3d(0, -d.z, d.y);
    const Vec3d a = beside / std::sqrt(dot(beside, beside)),
                b(d.y * a.z - d.z * a.y, d.z * a.x - d.x * a.z, d.x * a.y - d.y * a.x);
    return (a * std::cos(turn) + b * std::sin(turn)) * size;
}

/// Mean and greatest difference of lookups in a map and sums over directions.
std::pair<double, double> differences(Handle map, double size, double highest) {
    std::mt19937 random(5);
    const auto number = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    double sum = 0, worst = 0;
    constexpr int n = 150;
    for (int k = 0; k < n; ++k) {
        const double z = number(-highest, highest), turn = number(0, kTurn), r = std::sqrt(1 - z * z), spin = number(0, kTurn);
        const Vec3d d(r * std::cos(turn), r * std::sin(turn), z), dx = perpendicular(d, spin, size),
                                                                  dy = perpendicular(d, spin + kTurn / 4, size * .5);
        float v = -1;
        environment(map, {}, 0, 1, Vec3(d), Vec3(dx), Vec3(dy), {}, &v);
        const double e = std::fabs(double(v) - overDirections(d, dx, dy));
        sum += e;
        worst = std::max(worst, e);
    }
    return {sum / n, worst};
}

} // namespace

TEST(Environments, LatLongMapsAreSumsOverDirections) {
    Image m = display::makeImage(256, 128, {"y"});
    const LatLong axes;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x)
            m.pixel(x, y)[0] = float(light(Vec3d(axes.direction((float(x) + .5f) / 256, (float(y) + .5f) / 128))));
    m.metadata["textureformat"] = "LatLong Environment";
    const auto t = makeTextureFrom(m);
    for (double size : {.02, .1, .25}) {
        const auto [mean, worst] =
            differences(t.get(), size, .8); // nearer to the poles footprints are no parallelograms on the map
        EXPECT_LT(mean, .004) << size;
        EXPECT_LT(worst, .02) << size;
    }
}

TEST(Environments, CubeMapsAreSumsOverDirectionsAcrossEdges) {
    const int n = 64;
    Image m = display::makeImage(n, 6 * n, {"y"});
    // Rows of faces as cubeFace() has them: found by asking it about directions, so only its inverse is written here.
    const Vec3d right[6] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    const Vec3d up[6] = {{0, 1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
    const Vec3d out[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const Vec3d w = out[f] + right[f] * ((x + .5) * 2 / n - 1) + up[f] * (1 - (y + .5) * 2 / n);
                m.pixel(x, f * n + y)[0] = float(light(w / std::sqrt(dot(w, w))));
            }
    m.metadata["textureformat"] = "CubeFace Environment";
    m.metadata["fovcot"] = "1";
    const auto t = makeTextureFrom(m);
    for (double size : {.02, .1, .25}) {
        const auto [mean, worst] = differences(t.get(), size, 1);
        EXPECT_LT(mean, .004) << size;
        EXPECT_LT(worst, size < .05 ? .01 : .04)
            << size; // a footprint stays on its face, beyond whose edge the last texels go on
    }
}

} // namespace filters_test
