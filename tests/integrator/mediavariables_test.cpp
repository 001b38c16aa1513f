// Variables of primitives and the shaders of Interior and Exterior; how many volumes a ray is known to be in.
#include "base/limits.h"
#include "integrator/floorscene.h"
#include "scene/scene.h"

namespace mediavariables_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char kWall[] =
    "AttributeBegin Surface \"shine\" Color 1 1 1 Polygon \"P\" [-99 -99 9  -99 99 9  99 99 9  99 -99 9] AttributeEnd\n";

class MediaVariables : public ::testing::TestWithParam<Hider> {
protected:
    void SetUp() override {
        writeShader("beer", "volume beer(float k = 1; color tint = 1; string how = \"\";) { Ci *= tint * exp(-((how == "
                            "\"twice\") ? 2 * k : k) * length(I)); }\n");
        writeShader("ahead", "surface ahead() { Oi = 1; Ci = trace(P, normalize(I)); }\n");
        writeShader("shine", "surface shine() { Oi = 1; Ci = Cs; }\n");
    }
    struct Seen {
        Color c;
        std::string messages;
    };
    /// Along z from (x, 0, -5).
    static Seen seen(const std::string& inside, float x = 0) {
        Settings settings = withShaders(GetParam());
        settings.maxDepth = 40;
        settings.roulette = false;
        Scene s("WorldBegin\nSides 2\nAttribute \"trace\" \"maxspeculardepth\" 40\nTranslate 0 0 5\n" + inside + "WorldEnd\n",
                settings);
        const Color c = s.one(rayTo({x, 0, 0}, {x, 0, 1}));
        return {c, s.messages()};
    }
    static std::string ball(float radius, const std::string& variables, const std::string& before = "") {
        const std::string r = std::to_string(radius);
        return "AttributeBegin Surface \"ahead\" " + before + " Sphere " + r + " -" + r + " " + r + " 360 " + variables +
               " AttributeEnd\n";
    }
};

// Beer's law over the chord with the k of the primitive that the ray is in; without one that of the scene.
TEST_P(MediaVariables, ConstantOnesOverride) {
    const std::string beer = "Interior \"beer\" \"k\" .6 ";
    EXPECT_NEAR(seen(kWall + ball(1, "", beer)).c[0], std::exp(-.6 * 2), 2e-5);
    const Seen own = seen(kWall + ball(1, "\"constant float k\" [.9]", beer));
    EXPECT_NEAR(own.c[0], std::exp(-.9 * 2), 2e-5);
    EXPECT_EQ(own.messages.find("override"), std::string::npos) << own.messages;
    const Color tinted = seen(kWall + ball(1, "\"constant color tint\" [1 .5 .25] \"constant string how\" [\"twice\"]", beer)).c;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(tinted[k], std::exp(-1.2 * 2) / (1 << k), 2e-5);
    // Two balls beside each other under the same Interior.
    const std::string two = std::string(kWall) + "AttributeBegin Surface \"ahead\" " + beer +
                            "Sphere 1 -1 1 360 \"constant float k\" [.2]\nTranslate 3 0 0\n"
                            "Sphere 1 -1 1 360 \"constant float k\" [.4]\nAttributeEnd\n";
    EXPECT_NEAR(seen(two).c[0], std::exp(-.2 * 2), 2e-5);
    EXPECT_NEAR(seen(two, 3).c[0], std::exp(-.4 * 2), 2e-5);
}

TEST_P(MediaVariables, OthersAreSaid) {
    const Seen s = seen(kWall + ball(1, "\"varying float k\" [.1 .2 .3 .4]", "Interior \"beer\" \"k\" .6 "));
    EXPECT_NEAR(s.c[0], std::exp(-.6 * 2), 2e-5);
    EXPECT_NE(s.messages.find("\"k\" is not the same everywhere on the primitive"), std::string::npos) << s.messages;
}

// Balls in balls, each with its own volume: as many as are known are left one after the other; of more the outermost is
// forgotten, and said.
TEST_P(MediaVariables, VolumesInVolumes) {
    for (const int deep : {limits::kMedia, limits::kMedia + 1}) {
        std::string balls;
        double through = 0;
        for (int k = 0; k < deep; ++k) { // radii 1, .9, ...: each shell is a tenth thick, on both sides
            const double radius = 1 - .1 * k, density = .1 * (k + 1);
            balls += ball(float(radius), "", "Interior \"beer\" \"k\" " + std::to_string(density));
            through += density * (k + 1 == deep ? 2 * radius : .2);
        }
        const Seen s = seen(kWall + balls);
        const bool said = s.messages.find("more than " + std::to_string(limits::kMedia) + " volumes") != std::string::npos;
        EXPECT_EQ(said, deep > limits::kMedia) << s.messages;
        // The first shell has been forgotten where the ray comes out again.
        EXPECT_NEAR(s.c[0], std::exp(-(deep > limits::kMedia ? through - .1 * .1 : through)), 2e-5) << deep;
    }
}

// N, Cs and Os are those of the surface at the end of the way, as shaders for 3Delight read them.
TEST_P(MediaVariables, OfTheSurfaceAtItsEnd) {
    writeShader("told", "volume told() { Ci = Cs * abs(zcomp(normalize(N))) * Os; }\n");
    const std::string card = "Surface \"shine\" Atmosphere \"told\" Color 1 .5 .25 Opacity .5 .5 .5\n"
                             "Polygon \"P\" [-9 -9 0  -9 9 0  9 9 0  9 -9 0]\n";
    for (const auto& [turned, cosine] : {std::pair{"", 1.}, {"Rotate 60 1 0 0\n", .5}}) {
        const Color c = seen(turned + card).c;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], .5 * cosine / (1 << k), 2e-5) << turned;
    }
}

INSTANTIATE_TEST_SUITE_P(Hiders, MediaVariables, ::testing::Values(Hider::Raytrace, Hider::Path),
                         [](const auto& i) { return i.param == Hider::Path ? "Path" : "Raytrace"; });

// getshaders() with a category made when the shader runs looks at all shaders, and says when the array is short.
TEST(ShaderLists, CategoriesMadeWhenTheShaderRuns) {
    writeShader("part", "class part(public float v = 1; string __category = \"\";) { public void nothing() {} }\n");
    const std::string parts =
        "Shader \"part\" \"h1\" \"v\" 1 \"__category\" \"b\"\nShader \"part\" \"h2\" \"v\" 10 \"__category\" \"b\"\n"
        "Shader \"part\" \"h3\" \"v\" 100 \"__category\" \"a\"\n";
    const auto shows = [&](const std::string& name, const std::string& category, std::string& messages) {
        writeShader(name, "class " + name + "() { public void surface(output color Ci, Oi) {\n    string c = \"" + category +
                              "\"; if (u > 2) c = \"z\";\n"
                              "    shader l[1] = getshaders(\"category\", c);\n    Oi = 1; Ci = l[0]->v;\n} }\n");
        Settings settings = under(Hider::Hidden);
        Diagnostics d;
        struct Keeper final : scene::FrameConsumer {
            std::shared_ptr<const scene::Frame> frame;
            void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
            void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&,
                             const SourcePlace&) override {}
        } keeper;
        settings.shaderPaths.push_back(shaderFolder());
        ri::RibReader reader({}, keeper, d);
        reader.readMemory(inWorld(parts + "Surface \"" + name + "\" " + kFloor), "test.rib");
        const auto built = buildWorld(keeper.frame, settings, d);
        std::vector<SampleResult> out(1);
        Integrator i(built, d);
        EXPECT_TRUE(i.trace({&kView, 1}, out, nullptr));
        messages.clear();
        for (const Diagnostic& m : d.all()) messages += toString(m);
        return out[0].color[0];
    };
    std::string messages;
    EXPECT_EQ(shows("takesa", "a", messages), 100);
    EXPECT_EQ(messages.find("room"), std::string::npos) << messages;
    EXPECT_EQ(shows("takesb", "b", messages), 1);
    const size_t said = messages.find("more shaders than the array has room for");
    EXPECT_NE(said, std::string::npos) << messages;
    EXPECT_EQ(messages.find("more shaders than the array has room for", said + 1), std::string::npos) << "once";
    EXPECT_NE(messages.find("takesb.sl:3"), std::string::npos) << "with its place: " << messages;
}

} // namespace

} // namespace mediavariables_test
