// A view without its page: what is rendered after what was asked for, against what render makes of the same scene.
#include "display/imageio.h"
#include "sanitized.h"
#include "session.h"
#include "view/viewserver.h"
#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace session_test {
using namespace alpenglow;
using namespace alpenglow::view;
using Json = nlohmann::json;

namespace {

TEST_F(ViewSession, ShowsWhatRenderMakesToTheLastBit) {
    ASSERT_TRUE(open());
    const auto p = done();
    ASSERT_TRUE(p);
    EXPECT_EQ(difference(*p->planes[0].image, rendered(scene)), 0);
    EXPECT_EQ(p->figures.spp, 8);
    EXPECT_GT(p->figures.raysPerMS, 0);
    EXPECT_GT(p->figures.noiseRSE, 0);
    EXPECT_NEAR(p->figures.efficiency, 1 / (p->figures.noiseRSE * p->figures.noiseRSE * p->figures.seconds),
                1e-6 * p->figures.efficiency);
}

TEST_F(ViewSession, GoesOnWhereItWasWhenMoreSamplesAreAskedFor) {
    ASSERT_TRUE(open(false, {{"continuous", false}, {"spp", 3}}));
    ASSERT_TRUE(done());
    set({{"spp", 8}});
    const auto p = done();
    EXPECT_EQ(difference(*p->planes[0].image, rendered(scene)), 0);
    set({{"spp", 2}}); // fewer: anew
    render::RenderSettings two;
    two.spp = 2;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, two)), 0);
}

TEST_F(ViewSession, SwitchesAreThoseOfRender) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    set({{"indirect", false}});
    render::RenderSettings s;
    s.indirect = false;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, s)), 0);
    set({{"indirect", true}, {"direct", false}});
    s.indirect = true;
    s.direct = false;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, s)), 0);
    set({{"direct", true}, {"depth", 0}, {"clamp", 0.05}});
    s.direct = true;
    s.maxDepth = 0;
    s.sampleClamp = 0.05f;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, s)), 0);
    set({{"depth", -1}, {"clamp", 0}, {"factor", 0.5}});
    s.maxDepth = -1;
    s.sampleClamp = 0;
    s.resolutionFactor = 0.5;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, s)), 0);
    set({{"factor", 1}, {"hider", "raytrace"}, {"spp", 4}});
    s = {};
    s.hider = "raytrace";
    s.spp = 4;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, s)), 0);
}

TEST_F(ViewSession, WhatIsCroppedComesFirst) {
    scene = with(kScene, "Format 40 30", "Format 160 120");
    ASSERT_TRUE(open(false, {{"continuous", false}, {"spp", 16}, {"crop", {0.25, 0.5, 0.25, 0.75}}}));
    std::vector<std::string> phases;
    double least = 1e9;
    ASSERT_TRUE(until([&] {
        const Session::Shot shot = session->look("picture");
        const Json s = session->state(0, 0);
        const std::string phase = s["phase"];
        if (phases.empty() || phases.back() != phase) phases.push_back(phase);
        if (phase == "whole" && shot.picture) least = std::min(least, shot.picture->figures.spp);
        return s["done"] == true;
    }));
    const auto at = [&](const char* name) { return std::find(phases.begin(), phases.end(), name) - phases.begin(); };
    EXPECT_LT(at("crop"), at("whole"));
    EXPECT_LT(size_t(at("whole")), phases.size());
    render::RenderSettings s;
    s.spp = 16;
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene, s)), 0); // and the same in the end
}

TEST_F(ViewSession, MovesTheCamera) {
    ASSERT_TRUE(open());
    const auto first = done();
    EXPECT_EQ(session->act({{"do", "camera"}, {"orbit", {90, 0}}, {"drag", true}}), Json({{"ok", true}}));
    EXPECT_EQ(session->act({{"do", "camera"}, {"settle", true}}), Json({{"ok", true}}));
    EXPECT_TRUE(until([&] { return session->state(0, 0)["moved"] == true; }));
    const auto moved = done();
    EXPECT_GT(difference(*moved->planes[0].image, *first->planes[0].image), 0.05f);
    // The pivot is the nearest point of the sphere, 4 away: the scene turns about (0 0 4), the left goes to the front.
    const std::string same = with(kScene, "Translate 0 0 5\n", "Translate 0 0 4\nRotate -90 0 1 0\nTranslate 0 0 1\n");
    const display::Image expected = rendered(same);
    double sum = 0, all = 0;
    for (size_t i = 0; i < expected.data.size(); ++i) all += std::fabs(expected.data[i]);
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x)
            for (int k = 0; k < 3; ++k) sum += std::fabs(expected.pixel(x, y)[k] - moved->planes[0].image->pixel(x, y)[k]);
    EXPECT_LT(sum, 1e-3 * all); // the pivot's depth is a mean over the pixel
    EXPECT_EQ(session->act({{"do", "camera"}, {"reset", true}, {"settle", true}}), Json({{"ok", true}}));
    ASSERT_TRUE(until([&] { return session->state(0, 0)["moved"] == false; }));
    EXPECT_EQ(difference(*done()->planes[0].image, *first->planes[0].image), 0);
}

TEST_F(ViewSession, OutputsAndTheMapOfTheNoise) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    set({{"channels", {"N", "albedo"}}});
    const auto p = done("N");
    ASSERT_TRUE(p);
    const display::Image& n = *p->plane("N")->image;
    ASSERT_EQ(n.channels.size(), 3u);
    EXPECT_NEAR(n.pixel(20, 12)[2], -1, 0.35f);                     // the sphere looks back at the eye
    EXPECT_EQ(difference(*p->planes[0].image, rendered(scene)), 0); // outputs change no picture
    set({{"channels", {"lpe:C<RD>L", "lpe:C<RD><RD>+L"}}});
    const auto paths = done("lpe:C<RD>L");
    ASSERT_TRUE(paths);
    EXPECT_GT(paths->plane("lpe:C<RD>L")->image->pixel(24, 10)[0], 0.1f);
    EXPECT_LE(paths->plane("lpe:C<RD>L")->image->pixel(24, 10)[0], paths->planes[0].image->pixel(24, 10)[0] * 1.00001f);
    const auto noisy = done("noise");
    EXPECT_GT(noisy->plane("noise")->image->pixel(20, 12)[0], 0);
    EXPECT_EQ(noisy->plane("noise")->image->pixel(0, 0)[0], 0);
}

TEST_F(ViewSession, LightsAreDimmedWithoutANewRender) {
    ASSERT_TRUE(open(false, {{"continuous", false}, {"spp", 64}, {"lights", true}}));
    const auto p = done();
    ASSERT_TRUE(p);
    ASSERT_TRUE(p->plane("light:key"));
    ASSERT_TRUE(p->plane("light:fill"));
    const uint64_t generation = session->state(0, 0)["generation"];
    set({{"dim", {{"key", 0.0}}}});
    EXPECT_EQ(session->state(0, 0)["generation"], generation);
    const Session::Shot shot = session->look("picture");
    EXPECT_EQ(shot.dim.at("key"), 0);
    const display::Image without = dimmed(*shot.picture, shot.dim);
    render::RenderSettings s;
    s.spp = 64;
    const display::Image expected = rendered(with(kScene, "\"intensity\" 20", "\"intensity\" 0"), s);
    double sum = 0, all = 0;
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x) {
            sum += without.pixel(x, y)[0] - expected.pixel(x, y)[0];
            all += expected.pixel(x, y)[0];
        }
    EXPECT_NEAR(sum / all, 0, 0.02); // two estimates of the same
    set({{"dim", {{"fill", 0.0}}}});
    const Session::Shot dark = session->look("picture");
    for (float v : dimmed(*dark.picture, dark.dim).data)
        if (v < 1e30f) ASSERT_LT(std::fabs(v), 1e-5f + 6);
    const display::Image black = dimmed(*dark.picture, dark.dim);
    EXPECT_NEAR(black.pixel(20, 12)[0], 0, 1e-5);
}

TEST_F(ViewSession, ParametersOfShadersAreChanged) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    const Json shaders = session->scene()["shaders"];
    ASSERT_EQ(shaders.size(), 4u);
    EXPECT_EQ(shaders[2]["name"], "matte");
    EXPECT_EQ(shaders[2]["values"]["Kd"], Json({0.5}));
    EXPECT_EQ(shaders[2]["place"]["line"], 10);
    EXPECT_EQ(session->act({{"do", "parameter"}, {"shader", 2}, {"name", "Kd"}, {"type", "float"}, {"value", {0.9}}}),
              Json({{"ok", true}}));
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(with(kScene, "\"Kd\" 0.5", "\"Kd\" 0.9"))), 0);
    // One that the call does not name.
    EXPECT_EQ(
        session->act({{"do", "parameter"}, {"shader", 3}, {"name", "specularcolor"}, {"type", "color"}, {"value", {1, 0, 0}}}),
        Json({{"ok", true}}));
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(with(with(kScene, "\"Kd\" 0.5", "\"Kd\" 0.9"), "\"plastic\"",
                                                                 "\"plastic\" \"color specularcolor\" [1 0 0]"))),
              0);
}

TEST_F(ViewSession, SavesWhatRenderWouldWrite) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    for (const char* type : {"exr", "exr", "png"})
        EXPECT_EQ(session->act({{"do", "save"}, {"type", type}, {"gain", 1}, {"gamma", 2.2}, {"srgb", false}}),
                  Json({{"ok", true}}));
    ASSERT_TRUE(until([&] { return session->state(0, 0)["saved"].size() == 3; }));
    EXPECT_EQ(session->state(0, 0)["saved"], Json({"Pathtraced_8_0.exr", "Pathtraced_8_1.exr", "Pathtraced_8_0.png"}));
    Diagnostics diags;
    const auto a = display::readImage("Pathtraced_8_0.exr", diags);
    ASSERT_TRUE(a);
    const display::Image expected = rendered(scene);
    EXPECT_EQ(a->channels, expected.channels);
    EXPECT_EQ(a->data, expected.data);
    render::RenderSettings s;
    s.gamma = 2.2f;
    s.output = "x.png";
    const auto png = display::readImage("Pathtraced_8_0.png", diags);
    ASSERT_TRUE(png);
    // The code of a pixel by SLProject's formula, from the linear picture; dither is half a code.
    const double code = std::pow(std::clamp(double(expected.pixel(20, 12)[0]), 0.0, 1.0), 1 / 2.2);
    EXPECT_NEAR(png->pixel(20, 12)[0], code, 1.01 / 255);
    EXPECT_FALSE(std::filesystem::exists("x.exr")); // a view leaves the scene's own pictures alone
}

// An imager works on what Exposure made: the page shows what it gives, and its own curve comes behind.
TEST_F(ViewSession, ImagersWorkOnWhatExposureMade) {
    write("square.sl", "imager square() { Ci = Ci * Ci + 0.125 * alpha; }\n");
    scene = with(kScene, "Hider", "Exposure 2 1.5\nImager \"square\"\nHider");
    ASSERT_TRUE(open());
    const auto p = done();
    ASSERT_TRUE(p);
    const display::Image expected = rendered(scene);
    EXPECT_GT(expected.pixel(20, 12)[0], .125f);
    EXPECT_EQ(difference(*p->planes[0].image, expected), 0);
    const Json curve = session->state(0, 0)["curve"];
    EXPECT_EQ(curve, Json({{"gain", 1.0}, {"gamma", 1.0}, {"srgb", false}})); // as render writes it
    const auto save = [&](const char* type, double gain, double gamma) {
        const size_t before = session->state(0, 0)["saved"].size();
        EXPECT_EQ(session->act({{"do", "save"}, {"type", type}, {"gain", gain}, {"gamma", gamma}, {"srgb", false}}),
                  Json({{"ok", true}}));
        EXPECT_TRUE(until([&] { return session->state(0, 0)["saved"].size() > before; }));
        Diagnostics diags;
        return *display::readImage(session->state(0, 0)["saved"].back(), diags);
    };
    EXPECT_EQ(save("exr", 1, 1).data, expected.data);
    render::RenderSettings s;
    s.output = "expected.png";
    EXPECT_EQ(save("png", curve["gain"], curve["gamma"]).data, rendered(scene, s).data);
    // The page's own curve, of what it shows.
    const display::Image dark = save("png", .5, 2);
    for (int x = 0; x < 40; x += 3)
        EXPECT_NEAR(dark.pixel(x, 12)[0], std::sqrt(std::clamp(.5f * expected.pixel(x, 12)[0], 0.f, 1.f)), 1.01 / 255) << x;
}

// Without an imager the page shows light, and what is saved as numbers is what render writes.
TEST_F(ViewSession, SavesNumbersAsExposureMadeThem) {
    scene = with(kScene, "Hider", "Exposure 2 1.5\nHider");
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    EXPECT_EQ(session->act({{"do", "save"}, {"type", "exr"}}), Json({{"ok", true}}));
    ASSERT_TRUE(until([&] { return session->state(0, 0)["saved"].size() == 1; }));
    Diagnostics diags;
    const auto a = display::readImage("Pathtraced_8_0.exr", diags);
    ASSERT_TRUE(a);
    EXPECT_EQ(a->data, rendered(scene).data);
}

// Tiles of the whole over the coarse picture, more and more of them.
TEST_F(ViewSession, PicturesOfHiddenGrowTileByTile) {
    write("busy.sl", "surface busy() { float i, s = 0; for (i = 0; i < 40; i += 1) s += noise(90 * s + 40 * transform(\"NDC\", "
                     "P) * (1, 1, 0) + i);\n"
                     "Ci = mod(s, 1); Oi = 1; }\n");
    scene =
        "Display \"x.exr\" \"openexr\" \"rgba\"\nFormat 320 240 1\nPixelFilter \"box\" 1 1\nHider \"hidden\"\nPixelSamples 4 4\n"
        "Projection \"perspective\" \"fov\" 40\nTranslate 0 0 5\nWorldBegin\nSurface \"busy\"\n"
        "Polygon \"P\" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]\nWorldEnd\n";
    // On a busy machine a short render may be over before a picture of its middle is seen: then a longer one.
    size_t between = 0;
    for (int spp = 36; between == 0 && spp <= 576; spp *= 4) {
        std::vector<std::shared_ptr<const Picture>> seen;
        ASSERT_TRUE(open(false, {{"continuous", false}, {"spp", spp}}));
        ASSERT_TRUE(until([&] {
            const auto p = session->look("picture").picture;
            if (p && (seen.empty() || seen.back() != p)) seen.push_back(p);
            return session->state(0, 0)["done"] == true;
        }));
        seen.push_back(done());
        const display::Image& last = *seen.back()->planes[0].image;
        EXPECT_EQ(difference(last, rendered(scene, {.spp = uint32_t(spp)})), 0);
        size_t before = 0, black = 0;
        for (const auto& p : seen) {
            const display::Image& image = *p->planes[0].image;
            if (image.width != last.width) continue; // the first coarse one
            size_t same = 0;
            for (int i = 0; i < last.width * last.height; ++i) {
                const int x = i % last.width, y = i / last.width;
                same += image.pixel(x, y)[0] == last.pixel(x, y)[0];
                black += image.pixel(x, y)[3] == 0;
            }
            EXPECT_GE(same, before);
            between += same > 76800 / 20 && same < 76800 * 19 / 20;
            before = same;
        }
        EXPECT_EQ(black, 0u); // what is not there is the coarse picture
    }
    EXPECT_GE(between, 1u); // half done
}

TEST_F(ViewSession, EndsWhileTheSceneIsRead) {
    stop = 1; // Ctrl-C
    EXPECT_FALSE(open());
    EXPECT_TRUE(said.empty()) << said[0];
}

TEST_F(ViewSession, GoesOnWhenASceneDoesNotFitIntoMemory) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    noMemory = true;
    EXPECT_EQ(session->act({{"do", "reload"}}), Json({{"ok", true}}));
    ASSERT_TRUE(
        until([&] { return session->state(0, 0)["messages"].dump().find("given up: out of memory") != std::string::npos; }));
    noMemory = false;
    EXPECT_EQ(session->act({{"do", "reload"}}), Json({{"ok", true}}));
    ASSERT_TRUE(until([&] { return session->state(0, 0)["messages"].empty(); }));
    EXPECT_EQ(difference(*done()->planes[0].image, rendered(scene)), 0);
}

// Who has a picture is known by its tag, which no later one may have, wherever it lies in memory.
TEST_F(ViewSession, EachPictureHasATagOfItsOwn) {
    ASSERT_TRUE(open(false, {{"continuous", true}}));
    std::string fault;
    const auto http = HttpServer::listen(0, &fault);
    ASSERT_TRUE(http) << fault;
    ViewServer server(*session, *http, "token");
    HttpRequest r;
    r.method = "GET";
    r.path = "/token/picture";
    r.host = "127.0.0.1:" + std::to_string(http->port());
    std::map<std::string, double> at; // samples that the picture of a tag had
    ASSERT_TRUE(until([&] {
        bool known = false;
        const auto answer = server.answer(r, true, &known);
        uint32_t n;
        std::memcpy(&n, answer->body.data(), 4);
        const Json s = Json::parse(answer->body.substr(4, n));
        if (s.contains("tag") && s["figures"]["spp"].get<double>() > 1) {
            const double spp = s["figures"]["spp"];
            EXPECT_EQ(at.try_emplace(s["tag"], spp).first->second, spp);
        }
        return at.size() >= 12;
    }));
}

TEST_F(ViewSession, WatchesItsFilesAndKeepsTheCamera) {
    write("mine.sl", "surface mine() { Ci = color(1, 0, 0); Oi = 1; }\n");
    scene = with(kScene, "Surface \"matte\" \"Kd\" 0.5", "Surface \"mine\"");
    ASSERT_TRUE(open(true));
    const auto red = done();
    EXPECT_GT(red->planes[0].image->pixel(20, 12)[0], 0.9f);
    session->act({{"do", "camera"}, {"pan", {0.01, 0}}, {"settle", true}});
    ASSERT_TRUE(done());
    const auto begun = std::chrono::steady_clock::now();
    write("new.sl", "surface mine() { Ci = color(0, 1, 0); Oi = 1; }\n");
    std::filesystem::rename("new.sl", "mine.sl");
    ASSERT_TRUE(until([&] {
        const auto p = session->look("picture").picture;
        return p && p->stepX == 1 && p->planes[0].image->pixel(20, 12)[1] > 0.9f;
    }));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10)); // one, on a machine that is not busy
    EXPECT_EQ(session->state(0, 0)["moved"], true);
    ASSERT_TRUE(done());
    write("s.rib", "Format 8 8 1\nWorldBegin\nSphere 1 -1\n"); // broken: said with its place, and mended again
    EXPECT_TRUE(until([&] {
        const Json s = session->state(0, 0);
        for (const Json& m : s["messages"])
            if (m["severity"] == "error" && m["place"]["file"] == "s.rib" && m["place"]["line"] >= 3) return true;
        return false;
    }));
    write("s.rib", scene);
    ASSERT_TRUE(until([&] { return session->state(0, 0)["width"] == 40 && session->state(0, 0)["messages"].empty(); }));
}

TEST_F(ViewSession, WhatCannotBeIsSaidAndChangesNothing) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(done());
    const Json before = session->state(0, 0)["wishes"];
    const Json wrong[] = {Json(7),
                          Json::array(),
                          {{"do", "nothing"}},
                          {{"do", 3}},
                          {{"do", "set"}, {"wishes", {{"spp", 0}}}},
                          {{"do", "set"}, {"wishes", {{"spp", 2.5}}}},
                          {{"do", "set"}, {"wishes", {{"spp", 1e99}}}},
                          {{"do", "set"}, {"wishes", {{"hider", "../x"}}}},
                          {{"do", "set"}, {"wishes", {{"crop", {0.5, 0.2, 0, 1}}}}},
                          {{"do", "set"}, {"wishes", {{"crop", {0, 1}}}}},
                          {{"do", "set"}, {"wishes", {{"channels", {"a b"}}}}},
                          {{"do", "set"}, {"wishes", {{"channels", Json::array({1})}}}},
                          {{"do", "set"}, {"wishes", {{"unknown", 1}}}},
                          {{"do", "set"}, {"wishes", {{"dim", {{"key", -1}}}}}},
                          {{"do", "set"}, {"wishes", {{"direct", "no"}}}},
                          {{"do", "set"}, {"wishes", 3}},
                          {{"do", "save"}, {"type", "../../x.png"}},
                          {{"do", "save"}, {"type", "png"}, {"gamma", 0}},
                          {{"do", "parameter"}, {"shader", 99}, {"name", "Kd"}, {"value", {1}}},
                          {{"do", "parameter"}, {"shader", 2}, {"name", "Kd"}, {"value", {1, 2}}},
                          {{"do", "parameter"}, {"shader", 2}, {"name", "Kd"}, {"value", {"x"}}},
                          {{"do", "parameter"}, {"shader", -1}, {"name", "Kd"}, {"value", {1}}},
                          {{"do", "parameter"}, {"shader", 2}, {"name", 5}, {"value", {1}}},
                          {{"do", "parameter"}}};
    for (const Json& j : wrong) EXPECT_TRUE(session->act(j).contains("error")) << j;
    const Json strange[] = {
        {{"do", "camera"}, {"orbit", "x"}}, {{"do", "camera"}, {"orbit", {1e300, 0}}}, {{"do", "camera"}, {"dolly", -5}}};
    for (const Json& j : strange) session->act(j);
    EXPECT_EQ(session->state(0, 0)["wishes"], before);
    ASSERT_TRUE(done());
}

TEST_F(ViewSession, ASceneThatCannotBeReadIsSaid) {
    scene = "this is no RIB\n";
    EXPECT_FALSE(open());
    ASSERT_FALSE(said.empty());
    std::string all;
    for (const std::string& s : said) all += s;
    EXPECT_NE(all.find("s.rib:1:1"), all.npos) << all;
    EXPECT_NE(all.find("there is no picture in the scene"), all.npos) << all;
}

TEST_F(ViewSession, EndsWhileItRenders) {
    scene = with(kScene, "Format 40 30", "Format 2000 1500");
    ASSERT_TRUE(open(false, {{"continuous", true}}));
    ASSERT_TRUE(until([&] { return session->look("picture").picture != nullptr; }));
    const auto begun = std::chrono::steady_clock::now();
    session.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(kSanitized ? 30 : 5)); // alone .2 s
}

} // namespace
} // namespace session_test
