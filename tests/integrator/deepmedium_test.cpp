// Media out of which hardly any path comes again.
#include "integrator/floorscene.h"

namespace deepmedium_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string inside(const std::string& parameters, const std::string& shape) {
    return "AttributeBegin Surface \"null\" Interior \"medium\" " + parameters + " " + shape + " AttributeEnd\n";
}

TEST(DeepMedium, PathsDeepInsideEndThoughNothingIsAbsorbed) {
    // A path could be scattered ten thousand times, whatever the numbers; a chance of 1 / k to be scattered k times makes 10 of
    // them, one of 64 / k makes 64 (1 + log(10000 / 64)).
    for (const auto& [sigma, most] : {std::pair{"2147483648", 30.}, {"1e5", 30.}, {"400", 450.}}) {
        Scene s(inWorld("LightSource \"pointlight\" 1 \"from\" [0 2 0]\n" +
                        inside("\"color scattering\" [" + std::string(sigma) + " " + sigma + " " + sigma + "]",
                               "Sphere 3 -3 3 360\n")),
                withShaders(Hider::Path));
        Counters counted;
        s.estimate(rayTo({0, 0, 0}, {0, 0, 1}), 1000, &counted);
        EXPECT_LT(double(counted.diffuse) / 1000, most) << sigma;
    }
}

TEST(DeepMedium, TheGlowDeepInsideIsEmissionOverAbsorption) {
    // Where a medium has no end its radiance is even, and what is absorbed of it is what is sent: emission / absorption.
    for (const auto& [radius, g] : {std::pair{400., 0.}, {1000., .6}, {1e5, 0.}}) {
        Scene s(
            inWorld(inside("\"color scattering\" [.96 .96 .96] \"color absorption\" [.04 .04 .04] \"color emission\" [.02 .02 "
                           ".02] \"anisotropy\" " +
                               std::to_string(g),
                           "Sphere " + std::to_string(radius) + " -" + std::to_string(radius) + " " + std::to_string(radius) +
                               " 360\n")),
            withShaders(Hider::Path));
        expectMean(s.estimate(rayTo({0, 0, 0}, {0, 0, 1}), samples(6000)), .5, .06, std::to_string(radius));
    }
}

} // namespace

} // namespace deepmedium_test
