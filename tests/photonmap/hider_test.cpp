// Photons as a user has them: maps written, read, damaged, made on demand; more than there is room for; the same bits over
// threads.
#include "base/vec.h"
#include "cli/command_folder.h"
#include "display/imageio.h"
#include "photonmap/limits.h"
#include "statistics/nightly.h"
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace hider_test {

namespace {

using namespace alpenglow;

class PhotonHider : public cli::testing::CommandFolder {
protected:
    const std::string room =
        "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 0 1]\n"
        "Attribute \"photon\" \"string globalmap\" \"room.photons\" \"string causticmap\" \"room.photons\"\n";
    const std::string ball = "Sides 2\nSphere 5 -5 5 360\nWorldEnd\n";
    const std::string use = "Display \"use.tif\" \"tiff\" \"rgb\"\nFormat 16 16 1\nWorldBegin\n";
    void writeEmission(const std::string& count) {
        write("emit.rib",
              "Hider \"photon\" \"int emit\" " + count + "\nWorldBegin\n" + room + "Surface \"matte\" \"float Kd\" .5\n" + ball);
    }
};

TEST_F(PhotonHider, WritesMapsThatShadersRead) {
    writeEmission("20000");
    run("render emit.rib", "2>&1");
    EXPECT_EQ(status, 0);
    ASSERT_TRUE(std::filesystem::exists(dir / "room.photons"));
    run("render emit.rib", "2>&1"); // over the one that is there
    EXPECT_EQ(status, 0);
    write("use.rib", use + room + "LightSource \"causticlight\" 2\nSurface \"matte\"\n" + ball);
    EXPECT_EQ(run("render use.rib", "2>&1").find("error: "), std::string::npos);
    EXPECT_EQ(status, 0);
    std::filesystem::resize_file(dir / "room.photons", 5000);
    EXPECT_NE(run("render use.rib", "2>&1").find("room.photons\" cannot be read: it is cut short"), std::string::npos);
    std::filesystem::remove(dir / "room.photons");
    EXPECT_NE(run("render use.rib", "2>&1").find("there is no photon map \"room.photons\""), std::string::npos);
    write("use.rib", use + "Attribute \"light\" \"int emitphotons\" 1\n" + room +
                         "LightSource \"causticlight\" 2\nSurface \"matte\" \"float Kd\" .5\n" + ball);
    EXPECT_EQ(run("render use.rib", "2>&1").find("there is no photon map"), std::string::npos); // made for the picture
    EXPECT_EQ(status, 0);
}

TEST_F(PhotonHider, NothingToDo) {
    write("none.rib", "Hider \"photon\"\nWorldBegin\nLightSource \"pointlight\" 1\n" + ball);
    EXPECT_NE(run("render none.rib", "2>&1").find("names a photon map"), std::string::npos);
    EXPECT_NE(status, 0);
    write("dark.rib", "Hider \"photon\"\nWorldBegin\nAttribute \"photon\" \"string globalmap\" \"a.photons\"\nLightSource "
                      "\"ambientlight\" 1\n" +
                          ball);
    EXPECT_NE(run("render dark.rib", "2>&1").find("no light of the frame emits photons"), std::string::npos);
    EXPECT_NE(status, 0);
}

TEST_F(PhotonHider, TooManyAreToldAndAnInterruptEndsThem) {
    writeEmission("1000000000");
    const std::string said = run("render emit.rib", "2>&1 & p=$!; sleep 1; kill -INT $p; wait $p");
    EXPECT_NE(said.find("no more than " + std::to_string(limits::kPhotonsEmitted)), std::string::npos) << said;
    EXPECT_NE(said.find("interrupted while photons were emitted"), std::string::npos) << said;
    EXPECT_EQ(status, 130);
    EXPECT_FALSE(std::filesystem::exists(dir / "room.photons"));
    write("pass.rib", "Hider \"path\" \"int caustics\" 1 \"int emit\" -1\nPixelSamples 1 1\n" + use + room +
                          "Surface \"matte\" \"float Kd\" .5\n" + ball);
    EXPECT_NE(run("render pass.rib", "2>&1").find("1 to " + std::to_string(limits::kPhotonsOfPass)), std::string::npos);
    EXPECT_GE(limits::kPhotons, limits::kPhotonsOfPass); // a map holds a pass
    write("pass.rib", "Hider \"path\" \"int caustics\" 1 \"float causticwidth\" -1\nPixelSamples 1 1\n" + use + room +
                          "Surface \"matte\" \"float Kd\" .5\n" + ball);
    EXPECT_NE(run("render pass.rib", "2>&1").find("\"causticwidth\" must be an angle of 0 to 0.5 radians"), std::string::npos);
}

// As many photons as may be asked for, where all come to rest: a point light above a mirror in a room.
TEST_F(PhotonHider, PassesHoldNoMoreThanTheyMay) {
    EXPECT_LE(8 * limits::kPhotonsAtRest * 48, size_t(1) << 30);
    if (!teststat::nightly()) GTEST_SKIP() << "36 million photons";
    const int samples = 8;
    write("many.rib", "Hider \"path\" \"int caustics\" 1 \"int emit\" 4000000\nPixelSamples " + std::to_string(samples) +
                          " 1\nFormat 8 8 1\nDisplay \"many.tif\" \"tiff\" \"rgb\"\nWorldBegin\n"
                          "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 -4.9 0]\nAttributeBegin Surface "
                          "\"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [1 1 1]\n"
                          "Sides 2 Polygon \"P\" [-9 -4.95 -9  -9 -4.95 9  9 -4.95 9  9 -4.95 -9] AttributeEnd\nSurface "
                          "\"matte\" \"float Kd\" .5\n" +
                          ball);
    const std::string said = run("render --stats many.json many.rib", "2>&1");
    EXPECT_EQ(status, 0) << said;
    EXPECT_EQ(said.find("error: "), std::string::npos) << said;
    const double held = double(nlohmann::json::parse(std::ifstream(dir / "many.json"))["peakMemoryBytes"]);
    EXPECT_LT(held, double(1 << 30)) << said; // 1.87 GiB before
}

TEST_F(PhotonHider, SameCausticsOverThreadsAndParts) {
    const std::string scene =
        "Format 24 24 1\nHider \"path\" \"int caustics\" 1\nPixelSamples 2 2\nProjection \"perspective\"\nTranslate 0 0 "
        "3\nWorldBegin\n"
        "LightSource \"pointlight\" 1 \"float intensity\" 9 \"point from\" [.5 3 .2]\nSides 2\nAttributeBegin Surface "
        "\"slmaterial\" "
        "\"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5\nSphere .6 -.6 .6 360 AttributeEnd\n"
        "Surface \"matte\"\nPolygon \"P\" [-3 -1 -3  -3 -1 3  3 -1 3  3 -1 -3]\nWorldEnd\n";
    for (const char* threads : {"1", "3"}) {
        write("a.rib", std::string("Display \"a") + threads + ".exr\" \"openexr\" \"rgba\"\n" + scene);
        run(std::string("render a.rib -t ") + threads, "2>&1");
        EXPECT_EQ(status, 0);
    }
    run("diff a1.exr a3.exr", "2>&1");
    EXPECT_EQ(status, 0);
    write("a.rib", "Display \"p.exr\" \"openexr\" \"rgba\"\n" + scene);
    std::string without = scene;
    without.replace(without.find("\"int caustics\" 1"), 16, "");
    write("b.rib", "Display \"b.exr\" \"openexr\" \"rgba\"\n" + without);
    run("render b.rib", "2>&1");
    run("diff a1.exr b.exr", "2>&1"); // photons find what paths cannot
    EXPECT_EQ(status, 1);
}

// Narrow lobes, whose shaders run twice, and photons of times.
TEST_F(PhotonHider, SameNarrowLobesInMotionOverThreadsAndParts) {
    write("rough.sl", "surface rough() { Oi = 1; Ci = trace(P, normalize(N), \"distribution\", \"glass-ggx\", \"roughness\", "
                      ".06, \"eta\", 1.5, \"samplearealights\", 1, "
                      "\"type\", \"specular\"); }\n");
    write("coat.sl", "surface coat() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = .3 * diffuse(n) + 4 * specular(n, "
                     "-normalize(I), .02); }\n");
    const std::string scene =
        "Format 24 24 1\nPixelSamples 3 2\nShutter 0 1\nProjection \"perspective\"\nTranslate 0 0 3\nWorldBegin\n"
        "AttributeBegin AreaLightSource \"slrect\" 1 \"float intensity\" 20 Translate .5 2 .2 Polygon \"P\" [-.3 0 -.3  -.3 0 .3 "
        " .3 0 .3  .3 0 -.3] AttributeEnd\n"
        "Illuminate 1 1\nLightSource \"pointlight\" 2 \"float intensity\" 3 \"point from\" [-.5 2 .2]\nSides 2\n"
        "AttributeBegin Surface \"rough\" MotionBegin [0 1] Translate 0 0 0 Translate .3 .2 0 MotionEnd Sphere .6 -.6 .6 360 "
        "AttributeEnd\n"
        "AttributeBegin Surface \"coat\" Polygon \"P\" [1.2 -1 -1  1.2 -1 1  1.2 2 1  1.2 2 -1] AttributeEnd\n"
        "Surface \"matte\"\nPolygon \"P\" [-3 -1 -3  -3 -1 3  3 -1 3  3 -1 -3]\nWorldEnd\n";
    const auto render = [&](const std::string& name, const std::string& hider, const std::string& how) {
        write(name + ".rib",
              "Display \"" + name + ".exr\" \"openexr\" \"rgba\"\nHider \"path\" \"int caustics\" 1" + hider + "\n" + scene);
        const std::string said = run("render " + how + " " + name + ".rib", "2>&1");
        EXPECT_EQ(status, 0) << said;
    };
    const auto differ = [&](const std::string& other) {
        run("diff one.exr " + other, "2>&1");
        return status;
    };
    render("one", "", "-t 1");
    for (const char* threads : {"2", "3"}) {
        if (!teststat::nightly() && threads[0] == '2') continue; // as many render the parts
        render("more", "", std::string("-t ") + threads);
        EXPECT_EQ(differ("more.exr"), 0) << threads;
    }
    for (const char* part : {"1", "2"}) render(std::string("part") + part, "", std::string("-t 2 --part ") + part + "/2");
    run("merge -o merged.exr part1.exr.part part2.exr.part", "2>&1");
    EXPECT_EQ(differ("merged.exr"), 0);
    render("mirrors", " \"float causticwidth\" 0", "-t 2");
    EXPECT_EQ(differ("mirrors.exr"), 1); // photons followed some
}

std::string read(const std::filesystem::path& name) {
    std::ifstream f(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(f), {}};
}

/// A ball of glass between a lamp and a floor. `hider`: parameters.
std::string glassRoom(const std::string& hider = "") {
    return "Format 60 45 1\nProjection \"perspective\" \"fov\" 50\nHider \"path\" " + hider +
           "\nTranslate 0 -.5 4\nRotate -20 1 0 0\nWorldBegin\nSides 2\n"
           "AttributeBegin AreaLightSource \"slrect\" 1 \"float intensity\" 5 Surface \"constant\" Color 0 0 0 Polygon \"P\" "
           "[-.3 2 -.3  .3 2 -.3  .3 2 .3  -.3 2 .3] AttributeEnd\nIlluminate 1 1\n"
           "AttributeBegin Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5 "
           "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n"
           "Surface \"slmaterial\" \"color diffusecolor\" [.8 .6 .4] Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\nWorldEnd\n";
}

double meanLuminance(const std::filesystem::path& file) {
    Diagnostics diagnostics;
    const auto picture = display::readImage(file.string(), diagnostics);
    if (!picture) return NAN;
    const size_t width = picture->channels.size();
    double sum = 0;
    for (size_t i = 0; i + 2 < picture->data.size(); i += width)
        sum += double(luminance(Color{picture->data[i], picture->data[i + 1], picture->data[i + 2]}));
    return sum * double(width) / double(picture->data.size());
}

TEST_F(PhotonHider, GuidedPathsAreTheSameHoweverTheyAreSplit) {
    write("glass.rib", glassRoom());
    const auto picture = [&](const std::string& options, const std::string& name = "a.exr") {
        std::filesystem::remove(dir / name);
        run("render glass.rib -q --spp 12 -o " + name + " " + options, "2>&1");
        EXPECT_EQ(status, 0) << options;
        return read(dir / name);
    };
    const std::string whole = picture("--threads 1 --stats s.json");
    const auto stats = nlohmann::json::parse(read(dir / "s.json"));
    EXPECT_GT(stats["guide"]["photons"], 100);
    EXPECT_GT(stats["guide"]["cells"], 5);
    EXPECT_GT(stats["guide"]["rays"], 1000);
    const uint64_t lit = stats["guide"]["lit"];
    EXPECT_GT(lit, 100u);
    EXPECT_LT(lit, stats["guide"]["rays"].get<uint64_t>());
    // The caustic is a part of the light of the picture.
    const double light = stats["guide"]["light"], all = meanLuminance(dir / "a.exr");
    EXPECT_GT(light, 0.001 * all);
    EXPECT_LT(light, all);
    run("render glass.rib -q --spp 12 -o a.exr --threads 3 --stats t.json", "2>&1");
    EXPECT_EQ(nlohmann::json::parse(read(dir / "t.json"))["guide"], stats["guide"]);
    const std::vector<const char*> ways = {"--threads 5 --lanes 4", "--threads 2", "--lanes 16 --threads 3"};
    for (const char* options : std::span(ways).first(teststat::nightly() ? ways.size() : 1))
        EXPECT_TRUE(picture(options) == whole) << options;
    for (const char* k : {"1", "2", "3"}) picture(std::string("--part ") + k + "/3", std::string("p") + k + ".exr");
    run("merge p3.exr p1.exr p2.exr -o m.exr", "2>&1");
    EXPECT_TRUE(read(dir / "m.exr") == whole) << "parts";
    run("render glass.rib -q --spp 5 -o c.exr --checkpoint c.part", "2>&1");
    EXPECT_TRUE(picture("--checkpoint c.part --resume") == whole) << "resumed";
}

TEST_F(PhotonHider, GuideCanBeRefused) {
    write("glass.rib", glassRoom("\"int guide\" 0"));
    run("render glass.rib -q --spp 4 -o a.exr --stats s.json", "2>&1");
    EXPECT_EQ(status, 0);
    const auto stats = nlohmann::json::parse(read(dir / "s.json"));
    EXPECT_EQ(stats["guide"]["cells"], 0);
    EXPECT_EQ(stats["guide"]["rays"], 0);
}

// A wide lamp that a room sees through a small hole in its ceiling.
TEST_F(PhotonHider, LightGuideCanBeRefused) {
    const auto room = [](const std::string& hider) {
        return "Format 200 150 1\nProjection \"perspective\" \"fov\" 70\nHider \"path\" " + hider +
               "\nTranslate 0 -1 1.9\nWorldBegin\nSides 2\n"
               "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" 5 Surface \"constant\" Color 0 0 0 "
               "Polygon \"P\" [-3 3 -3  3 3 -3  3 3 3  -3 3 3] AttributeEnd\nIlluminate 1 1\n"
               "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Color .7 .7 .7\n"
               "PointsGeneralPolygons [2] [4 4] [0 1 2 3 4 5 6 7] \"P\" [-2 2 -2  2 2 -2  2 2 2  -2 2 2  -.3 2 -.3  .3 2 -.3  "
               ".3 2 .3  -.3 2 .3]\n"
               "PointsPolygons [4 4 4 4 4] [0 1 2 3  0 4 5 1  3 2 6 7  0 3 7 4  1 5 6 2] \"P\" [-2 0 -2  2 0 -2  2 0 2  -2 0 2  "
               "-2 2 -2  2 2 -2  2 2 2  -2 2 2]\nWorldEnd\n";
    };
    for (const bool refused : {false, true}) {
        write("room.rib", room(refused ? "\"int guide\" 0" : ""));
        run("render room.rib -q --spp 4 -o a.exr --stats s.json", "2>&1");
        EXPECT_EQ(status, 0);
        const auto stats = nlohmann::json::parse(read(dir / "s.json"));
        EXPECT_EQ(stats["lightGuide"]["used"] > 0, !refused) << stats["lightGuide"];
    }
}

// Photons that are to teach paths alone print nothing, bake nothing and are not complained of.
TEST_F(PhotonHider, LearningIsSilent) {
    write("says.sl",
          "surface says() { printf(\"here\\n\"); Oi = 1; if (comp(trace(P, reflect(normalize(I), normalize(N))), 0) > .1) "
          "Ci = 1; else Ci = .5 * diffuse(normalize(N)); }");
    std::string room = glassRoom();
    room.insert(room.find("WorldEnd"), "Surface \"says\" Translate 0 1 1.5 Sphere .3 -.3 .3 360\n");
    write("glass.rib", room);
    const std::string guided = run("render glass.rib -q --spp 2 -o a.exr --threads 1", "2>&1");
    room.insert(room.find("\"path\"") + 6, " \"int guide\" 0");
    write("glass.rib", room);
    const auto count = [](const std::string& text) {
        size_t n = 0;
        for (size_t at = text.find("here"); at != std::string::npos; at = text.find("here", at + 1)) ++n;
        return n;
    };
    const size_t plain = count(run("render glass.rib -q --spp 2 -o a.exr --threads 1", "2>&1"));
    EXPECT_GT(plain, 10u);
    EXPECT_LT(std::fabs(double(count(guided)) - double(plain)), .2 * double(plain)) << "guided rays meet it, photons say nothing";
    EXPECT_EQ(guided.find("makes no caustics"), std::string::npos) << guided;
}

} // namespace

} // namespace hider_test
