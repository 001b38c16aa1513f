// Lookups a second in one thread, beside OpenImageIO's TextureSystem on the same file and the same footprints, in turns of one
// run. texture_bench [FOLDER]: maps are made there (default: the folder of temporary files).
#include "display/imageio.h"
#include "texture/maketexture.h"
#include "texture/texture.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <random>
#include <unistd.h>
#ifdef ALPENGLOW_HAS_OPENIMAGEIO
#include <OpenImageIO/texture.h>
#endif

using namespace alpenglow;
using namespace alpenglow::texture;

namespace {

double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// What a frame asks: places and their changes from pixel to pixel.
struct Set {
    const char* name;
    std::vector<float> s, t, dsdx, dtdx, dsdy, dtdy;
    size_t size() const { return s.size(); }
    void add(float a, float b, float c, float d, float e, float f) {
        s.push_back(a), t.push_back(b), dsdx.push_back(c), dtdx.push_back(d), dsdy.push_back(e), dtdy.push_back(f);
    }
};

constexpr int kSide = 2048;

/// A plane that is turned by 30 degrees, in rows of pixels: `texels` of level 0 to a pixel along a row, `ratio` times as many
/// across.
Set plane(const char* name, float texels, float ratio) {
    Set p{name, {}, {}, {}, {}, {}, {}};
    const float step = texels / kSide, c = .8660254f, si = .5f;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const float u = float(x) * step, v = float(y) * step * ratio;
            p.add(.1f + u * c - v * si, .2f + u * si + v * c, step * c, step * si, -step * ratio * si, step * ratio * c);
        }
    return p;
}

/// Places without order, as after bounces of rays; footprints from half a texel to 64.
Set scattered() {
    Set p{"scattered", {}, {}, {}, {}, {}, {}};
    std::mt19937 random(1);
    const auto number = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
    for (int i = 0; i < 65536; ++i) {
        const float a = 6.2831853f * number(), x = std::exp2(-1 + 7 * number()) / kSide, y = x * (1 + number());
        p.add(3 * number(), 3 * number(), x * std::cos(a), x * std::sin(a), -y * std::sin(a), y * std::cos(a));
    }
    return p;
}

double ours(Handle map, const Set& p, double& sum) {
    const double begin = cpuSeconds();
    LookupLanes l;
    l.set({});
    l.mask = 0xffff;
    for (size_t i = 0; i + 16 <= p.size(); i += 16) {
        std::copy_n(&p.s[i], 16, l.s), std::copy_n(&p.t[i], 16, l.t);
        std::copy_n(&p.dsdx[i], 16, l.dsdx), std::copy_n(&p.dtdx[i], 16, l.dtdx);
        std::copy_n(&p.dsdy[i], 16, l.dsdy), std::copy_n(&p.dtdy[i], 16, l.dtdy);
        lookup2DLanes(map, 0, 3, true, l);
        sum += double(l.out[0][3] + l.out[1][7] + l.out[2][11]);
    }
    return double(p.size()) / (cpuSeconds() - begin) / 1e6;
}

double oursOneByOne(Handle map, const Set& p, double& sum) {
    const double begin = cpuSeconds();
    LookupOptions o;
    o.asLight = true;
    for (size_t i = 0; i < p.size(); ++i) {
        float v[3];
        lookup2D(map, 0, 3, p.s[i], p.t[i], p.dsdx[i], p.dtdx[i], p.dsdy[i], p.dtdy[i], o, v);
        sum += double(v[0]);
    }
    return double(p.size()) / (cpuSeconds() - begin) / 1e6;
}

#ifdef ALPENGLOW_HAS_OPENIMAGEIO
struct Theirs {
    OIIO::TextureSystem* system = OIIO::TextureSystem::create(false);
    OIIO::TextureSystem::TextureHandle* map = nullptr;
    OIIO::TextureSystem::Perthread* thread = nullptr;
    explicit Theirs(const std::string& file) {
        system->attribute("max_memory_MB", 2048.0f);
        system->attribute("automip", 0);
        thread = system->get_perthread_info();
        map = system->get_texture_handle(OIIO::ustring(file), thread);
    }
    ~Theirs() { OIIO::TextureSystem::destroy(system); }
    double time(const Set& p, double& sum) {
        OIIO::TextureOpt o;
        o.swrap = o.twrap = OIIO::TextureOpt::WrapPeriodic;
        o.interpmode = OIIO::TextureOpt::InterpBilinear; // the quicker of its two, and what ours are
        o.mipmode = OIIO::TextureOpt::MipModeAniso;
        o.anisotropic = 32;
        const double begin = cpuSeconds();
        for (size_t i = 0; i < p.size(); ++i) {
            float v[3] = {};
            system->texture(map, thread, o, p.s[i], p.t[i], p.dsdx[i], p.dtdx[i], p.dsdy[i], p.dtdy[i], 3, v);
            sum += double(v[0]);
        }
        return double(p.size()) / (cpuSeconds() - begin) / 1e6;
    }
    double timeBatch(const Set& p, double& sum) {
        OIIO::TextureOptBatch o;
        using OIIO::Tex::BatchWidth;
        o.swrap = o.twrap = OIIO::Tex::Wrap::Periodic;
        o.interpmode = OIIO::Tex::InterpMode::Bilinear;
        o.mipmode = OIIO::Tex::MipMode::Aniso;
        o.anisotropic = 32;
        for (int k = 0; k < BatchWidth; ++k) { // its constructor leaves them open
            o.sblur[k] = o.tblur[k] = o.rblur[k] = 0;
            o.swidth[k] = o.twidth[k] = o.rwidth[k] = 1;
        }
        const double begin = cpuSeconds();
        for (size_t i = 0; i + BatchWidth <= p.size(); i += BatchWidth) {
            alignas(64) float v[3 * BatchWidth] = {};
            system->texture(map, thread, o, OIIO::Tex::RunMaskOn, &p.s[i], &p.t[i], &p.dsdx[i], &p.dtdx[i], &p.dsdy[i],
                            &p.dtdy[i], 3, v);
            sum += double(v[0]);
        }
        return double(p.size()) / (cpuSeconds() - begin) / 1e6;
    }
};
#endif

template <class T> double middle(std::vector<T> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

} // namespace

int main(int argc, char** argv) {
    const std::string folder =
        argc > 1 ? argv[1] : (std::filesystem::temp_directory_path() / ("texture_bench-" + std::to_string(getpid()))).string();
    std::filesystem::create_directories(folder);
    Diagnostics d;
    display::Image m = display::makeImage(kSide, kSide, display::defaultChannels(3));
    std::mt19937 random(1);
    for (float& v : m.data) v = float(random() % 1024) / 1024.0f;
    display::WriteOptions w;
    w.sample = display::Sample::Half;
    w.policy.allowWrite = true;
    MakeOptions make;
    make.swrap = make.twrap = "periodic";
    make.policy.allowWrite = true;
    const std::string picture = folder + "/picture.exr", file = folder + "/map.exr";
    if (!display::writeImage(picture, m, w, d) || !makeTexture(picture, file, make, d))
        return std::fprintf(stderr, "no map\n"), 1;
    TextureSystem maps(d);
    const Handle map = maps.open(file);
    if (!map) return std::fprintf(stderr, "no map\n"), 1;
    double sum = 0;
    bool missed = false; // wanted: 4 times
    std::printf("%d x %d, 3 channels, half, tiled, all levels; million lookups a second of one thread, middle of 3 turns\n",
                kSide, kSide);
    std::printf("%-34s %10s %10s %10s %10s %8s\n", "footprints", "ours x16", "ours x1", "OIIO", "OIIO x16", "ratio");
    for (const Set& p :
         {plane("half a texel", .5f, 1), plane("1.5 texels", 1.5f, 1), plane("1.5 texels, 4 times as long", 1.5f, 4),
          plane("1.5 texels, 16 times as long", 1.5f, 16), scattered()}) {
        std::vector<double> a, b, c, e;
#ifdef ALPENGLOW_HAS_OPENIMAGEIO
        Theirs theirs(file);
        theirs.time(p, sum); // what is read is there
#endif
        ours(map, p, sum);
        for (int turn = 0; turn < 3; ++turn) {
            a.push_back(ours(map, p, sum));
            b.push_back(oursOneByOne(map, p, sum));
#ifdef ALPENGLOW_HAS_OPENIMAGEIO
            c.push_back(theirs.time(p, sum));
            e.push_back(theirs.timeBatch(p, sum));
#else
            c.push_back(0), e.push_back(0);
#endif
        }
        const double best = std::max(middle(c), middle(e));
        missed |= best > 0 && middle(a) < 4 * best;
        std::fflush(stdout);
        std::printf("%-34s %10.2f %10.2f %10.2f %10.2f %8.1f\n", p.name, middle(a), middle(b), middle(c), middle(e),
                    best > 0 ? middle(a) / best : 0);
    }
    std::printf("(sum of what was read: %g)\n", sum);
    if (argc < 2) std::filesystem::remove_all(folder);
    return missed;
}
