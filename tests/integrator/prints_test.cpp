// What shaders print comes in the order of the samples: surfaces that wait, their reflections, lights.
#include "integrator/harness.h"
#include <algorithm>
#include <random>
#include <thread>

namespace prints_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string talkers() {
    writeShader("talks", R"(surface talks() {
    normal Nf = faceforward(normalize(N), I);
    float depth = 0;
    rayinfo("depth", depth);
    printf("%d surface %.3f %.3f\n", depth, u, v);
    color seen = trace(P, reflect(normalize(I), Nf));
    if (comp(seen, 0) > .2) printf("%d bright %.3f\n", depth, u);
    Oi = Os;
    Ci = .5 * seen + Cs * diffuse(Nf);
}
)");
    writeShader("lamp", R"(light lamp(float intensity = 5; point from = point (0, 3, 3);) {
    illuminate(from) {
        printf("  lamp %.3f\n", L . L);
        Cl = intensity / (L . L);
    }
}
)");
    return "WorldBegin\nAttribute \"visibility\" \"integer specular\" 1\nSides 2\nLightSource \"lamp\" 1\n"
           "Surface \"talks\"\nTransformBegin\nTranslate -.5 0 4\nSphere .6 -.6 .6 360\nTransformEnd\n"
           "TransformBegin\nTranslate .6 0 4.4\nSphere .6 -.6 .6 360\nTransformEnd\nWorldEnd\n";
}

std::vector<CameraRay> rays(int n) {
    std::vector<CameraRay> list;
    std::mt19937_64 rng(7);
    std::uniform_real_distribution<float> u(-.25f, .25f);
    for (int i = 0; i < n; ++i) {
        CameraRay r = rayTo({0, 0, 0}, {u(rng), u(rng), 1});
        r.px = i % 20;
        r.py = i / 20 % 10;
        r.sample = uint32_t(i / 200);
        r.spread = .001f;
        list.push_back(r);
    }
    return list;
}

Settings settings(int lanes = 16) {
    Settings s;
    s.hider = Hider::Raytrace;
    s.lanes = lanes;
    return s;
}

template <class Run> std::string printed(const Scene& scene, Run run) {
    ::testing::internal::CaptureStdout();
    run();
    scene.world->flushPrints(true);
    return ::testing::internal::GetCapturedStdout();
}

TEST(Prints, InTheOrderOfSamples) {
    const std::string rib = talkers();
    const auto all = rays(400);
    Scene scene(rib, settings());
    ASSERT_TRUE(scene.world);
    const std::string whole = printed(scene, [&] { scene.trace(all); });
    EXPECT_GT(std::count(whole.begin(), whole.end(), '\n'), 300);
    EXPECT_NE(whole.find("1 surface"), std::string::npos) << "nothing was reflected";

    auto shuffled = all;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
    EXPECT_EQ(whole, printed(scene,
                             [&] {
                                 for (size_t i = 0; i < shuffled.size(); i += 23)
                                     scene.trace(std::span(shuffled).subspan(i, std::min<size_t>(23, shuffled.size() - i)));
                             }))
        << "small calls in another order";
    EXPECT_EQ(whole, printed(scene,
                             [&] {
                                 std::vector<std::thread> threads;
                                 for (int t = 0; t < 3; ++t)
                                     threads.emplace_back([&, t] {
                                         Integrator mine(scene.world, scene.diagnostics);
                                         std::vector<SampleResult> results(50);
                                         for (size_t i = size_t(t) * 50; i < all.size(); i += 150)
                                             mine.trace(std::span(all).subspan(i, 50), results, nullptr);
                                     });
                                 for (auto& t : threads) t.join();
                             }))
        << "threads";
    for (int lanes : {4, 8}) {
        Scene other(rib, settings(lanes));
        EXPECT_EQ(whole, printed(other, [&] { other.trace(all); })) << lanes << " lanes";
    }
}

} // namespace

} // namespace prints_test
