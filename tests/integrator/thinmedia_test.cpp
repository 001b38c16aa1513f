// Media through which light comes far, with lamps in them: what stands for the light of a lamp, and what shadow rays meet there.
#include "integrator/floorscene.h"
#include "world/impl.h"

namespace thinmedia_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A box from -1 to 1 whose inside is fog.
std::string box(const std::string& fog) {
    return "AttributeBegin ReverseOrientation Surface \"null\" Interior \"medium\" " + fog +
           " PointsPolygons [4 4 4 4 4 4] [0 2 6 4  1 5 7 3  0 4 5 1  2 3 7 6  0 1 3 2  4 6 7 5] \"P\" "
           "[-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1] AttributeEnd\n";
}
std::string lamp(const std::string& at, const std::string& size) {
    return "AttributeBegin AreaLightSource \"arealight\" 1 \"intensity\" 4 Surface \"constant\" Color 0 0 0 Translate " + at +
           " Scale " + size + " " + size + " 1 Polygon \"P\" [-1 -1 0  -1 1 0  1 1 0  1 -1 0] AttributeEnd\nIlluminate 1 1\n";
}
CameraRay along(float x, float y) { return rayTo({x, y, 0}, {x, y, 1}); }

} // namespace

// On thin ways points that are chosen by the angle of an emitter stand for all of its light; on others those by distance help.
TEST(ThinMedia, EveryTechniqueHasTheSameMean) {
    for (const char* sigma : {".1 .2 .4", ".5 1 3"}) // in the second the ways of some rays are thin, and those of others are not
        for (const char* at : {"0 .3 .4", ".5 1.5 0"}) {
            Moments m[3];
            for (int k = 0; k < 3; ++k) {
                Settings set = withShaders(Hider::Path);
                set.mediumSampling = MediumSampling(k);
                Scene s(inWorld("Translate 0 0 5\n" + lamp(at, ".2") +
                                box("\"color scattering\" [" + std::string(sigma) +
                                    "] \"color absorption\" [.05 .05 .05] "
                                    "\"anisotropy\" .4")),
                        set);
                m[k] = s.estimate(along(.2f, -.3f), samples(20000));
                EXPECT_GT(m[k].mean(), 10 * m[k].se()) << k;
            }
            for (int k = 1; k < 3; ++k)
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(m[k].mean(c), m[0].mean(c), kZ * (m[k].se(c) + m[0].se(c))) << sigma << at << k << c;
        }
}

// Where few surfaces let light through shadow rays look for those by themselves: with the same bits.
TEST(ThinMedia, FewBoundariesChangeNoBit) {
    const std::string pane =
                          "AttributeBegin Opacity .5 .6 .7 Surface \"matte\" Translate 0 .4 0 Polygon \"P\" [-.7 0 -.7  -.7 0 .7 "
                          " .7 0 .7  .7 0 -.7] AttributeEnd\n",
                      floor = "AttributeBegin Surface \"matte\" Translate 0 -.6 0 Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3] "
                              "AttributeEnd\n";
    std::string far = "AttributeBegin Opacity .5 .5 .5 Surface \"matte\" Translate 0 0 -900\n";
    for (int i = 0; i < 30; ++i) far += "Polygon \"P\" [0 0 0  0 1 0  1 1 0  1 0 0]\n";
    far += "AttributeEnd\n";
    std::vector<CameraRay> rays;
    for (int i = 0; i < 400; ++i) {
        rays.push_back(along(float(i % 20) * .11f - 1.1f, float(i / 20) * .1f - 1));
        rays.back().px = i % 20, rays.back().py = i / 20;
    }
    const std::string few = "Translate 0 0 5\n" + lamp("0 .9 0", ".2") +
                            "LightSource \"pointlight\" 2 \"from\" [.3 2 .2] \"intensity\" 3\n" + floor + pane +
                            box("\"color scattering\" [.3 .4 .9]");
    Scene a(inWorld(few), withShaders(Hider::Path)), b(inWorld(few + far), withShaders(Hider::Path));
    ASSERT_TRUE(std::static_pointer_cast<const WorldImpl>(a.world)->byOpacity().few);
    ASSERT_FALSE(std::static_pointer_cast<const WorldImpl>(b.world)->byOpacity().few);
    const auto one = a.trace(rays), other = b.trace(rays);
    double sum = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(one[i].color, other[i].color) << i;
        sum += one[i].color.x;
    }
    EXPECT_GT(sum, 1);
}

} // namespace thinmedia_test
