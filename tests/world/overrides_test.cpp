// Variables of primitives that do not fit the parameters of shaders: the parameters keep their values, and it is said. "shader"
// space of co-shaders by a name that is made when the shader runs. Closed forms.
#include "integrator/floorscene.h"
#include "scene/scene.h"

namespace overrides_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A unit sphere 5 before the eye, of which a ray meets the middle.
Color seen(const std::string& variable, const std::string& surface, std::string& messages) {
    Scene s("WorldBegin\nSurface \"" + surface + "\"\nTranslate 0 0 5\nSphere 1 -1 1 360 " + variable + "\nWorldEnd\n",
            under(Hider::Hidden));
    const Color c = s.one(rayTo({0, 0, 0}, {0, .1f, 5}));
    messages = s.messages();
    return c;
}

/// The world of a scene in which there are errors.
std::shared_ptr<const World> built(const std::string& rib, Diagnostics& d) {
    struct Kept final : scene::FrameConsumer {
        std::shared_ptr<const scene::Frame> frame;
        void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
        void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&,
                         const SourcePlace&) override {}
    } kept;
    ri::RibReader reader({}, kept, d);
    reader.readMemory(rib, "test.rib");
    Settings settings;
    settings.shaderPaths.push_back(shaderFolder());
    return buildWorld(kept.frame, settings, d);
}

TEST(Overrides, OnlyWhatFits) {
    writeShader(
        "overridden",
        "surface overridden(varying float number = 1; color tint = 2; string word = \"a\"; varying float list[2] = {1, 2};) {\n"
        "    Oi = 1; Ci = number + tint + list[1]; if (word == \"b\") Ci = 100;\n}\n");
    const struct {
        const char* variable;
        Color want;
        bool fits;
    } all[] = {
        {"\"constant float number\" [3]", Color(7), true},
        {"\"constant color tint\" [5 6 7]", Color(8, 9, 10), true},
        {"\"constant float[3] tint\" [5 6 7]", Color(8, 9, 10), true},
        {"\"constant float[2] list\" [5 6]", Color(9), true},
        {"\"constant string word\" [\"b\"]", Color(100), true},
        {"\"constant string number\" [\"b\"]", Color(5), false},
        {"\"varying string number\" [\"b\" \"b\" \"b\" \"b\"]", Color(5), false},
        {"\"constant string tint\" [\"b\"]", Color(5), false},
        {"\"constant float tint\" [7]", Color(5), false},
        {"\"constant color number\" [5 6 7]", Color(5), false},
        {"\"constant float[2] number\" [5 6]", Color(5), false},
        {"\"constant float list\" [5]", Color(5), false},
        {"\"constant string[2] list\" [\"b\" \"c\"]", Color(5), false},
        {"\"constant float word\" [5]", Color(5), false},
        {"\"constant string[2] word\" [\"b\" \"b\"]", Color(5), false},
    };
    for (const auto& a : all) {
        std::string messages;
        const Color c = seen(a.variable, "overridden", messages);
        for (int k = 0; k < 3; ++k) EXPECT_FLOAT_EQ(c[k], a.want[k]) << a.variable;
        EXPECT_EQ(messages.find("does not fit the parameter of shader \"overridden\"") == std::string::npos, a.fits)
            << a.variable << messages;
    }
}

TEST(Overrides, MoreThanSixteenNumbers) {
    writeShader("longlist",
                "surface longlist(varying float list[20] = 0;) { Oi = 1; Ci = color(list[0], list[15], list[19]); }\n");
    std::string messages, numbers;
    for (int k = 1; k <= 20; ++k) numbers += std::to_string(k) + " ";
    const Color c = seen("\"constant float[20] list\" [" + numbers + "]", "longlist", messages);
    EXPECT_FLOAT_EQ(c.x, 1);
    EXPECT_FLOAT_EQ(c.y, 16);
    EXPECT_FLOAT_EQ(c.z, 20);
}

TEST(Overrides, ColoursOfPrimitivesAreColours) {
    writeShader("own", "surface own() { Oi = Os; Ci = Cs; }\n");
    std::string many;
    for (int k = 0; k < 600; ++k) many += "1 ";
    for (const std::string& v : {std::string("\"constant string Cs\" [\"red\"]"), std::string("\"constant string Os\" [\"red\"]"),
                                 std::string("\"constant matrix Cs\" [1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16]"),
                                 "\"constant color[200] Cs\" [" + many + "]"}) {
        Diagnostics d;
        const auto world =
            built("WorldBegin\nColor .5 .25 .125\nSurface \"own\"\nTranslate 0 0 5\nSphere 1 -1 1 360 " + v + "\nWorldEnd\n", d);
        ASSERT_TRUE(world);
        const CameraRay ray = rayTo({0, 0, 0}, {0, .1f, 5});
        SampleResult r;
        Integrator i(world, d);
        ASSERT_TRUE(i.trace({&ray, 1}, {&r, 1}, nullptr));
        EXPECT_FLOAT_EQ(r.color.x, .5f) << v;
        EXPECT_FLOAT_EQ(r.color.y, .25f) << v;
        EXPECT_EQ(d.errors(), 1) << v;
        ASSERT_FALSE(d.all().empty());
        EXPECT_NE(d.all()[0].message.find("is not declared as a color; the variable is ignored"), std::string::npos)
            << d.all()[0].message;
        EXPECT_GT(d.all()[0].place.line, 0);
    }
}

// Nightly: to build so many takes 8 s.
TEST(Overrides, MoreVolumesThanHaveNumbers) {
    if (!nightly()) GTEST_SKIP() << "binding 32,768 volumes takes 8 s of processor: in the nightly set";
    writeShader("dense", "volume dense(float density = 0;) { Ci *= exp(-density); }\n");
    std::string rib = "WorldBegin\nInterior \"dense\"\nTranslate 0 0 5\n";
    for (int k = 0; k < 32768; ++k) rib += "Disk 0 1 360 \"constant float density\" [" + std::to_string(k) + "]\n";
    Diagnostics d;
    ASSERT_TRUE(built(rib + "WorldEnd\n", d));
    ASSERT_EQ(d.errors(), 1); // of the last one
    EXPECT_NE(d.all()[0].message.find("no more than 32767 different interiors and exteriors"), std::string::npos)
        << d.all()[0].message;
    EXPECT_EQ(d.all()[0].place.line, 3 + 32768);
}

TEST(Overrides, TheSpaceOfACoShaderHasItsNameAtRunTimeToo) {
    writeShader("placed", R"(class placed(uniform string word = "shader";) {
    public void tell(output point a, b, c, d) {
        string made = "shader";
        if (u > 2) made = "current";
        a = transform("world", point "shader" (0, 0, 0));
        b = transform(word, "world", point(0, 0, 0));
        c = transform(made, "world", point(0, 0, 0));
        d = transform("world", made, point(1, 2, 3));
    }
}
)");
    writeShader("asksplaces", R"(class asksplaces(uniform float which = 0;) {
    public void surface(output color Ci, Oi) {
        point all[4];
        shader there = getshader("there");
        there->tell(all[0], all[1], all[2], all[3]);
        Oi = 1;
        Ci = color(all[which]);
    }
}
)");
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (int which = 0; which < 4; ++which) {
            Scene s("WorldBegin\nSides 2\nTransformBegin\nTranslate 1 2 3\nShader \"placed\" "
                    "\"there\"\nTransformEnd\nTransformBegin\nTranslate 5 6 7\n"
                    "Surface \"asksplaces\" \"float which\" [" +
                        std::to_string(which) + "]\nTransformEnd\n" + kFloor + "WorldEnd\n",
                    under(h));
            const Color c = s.one(kView); // the co-shader was named at (1, 2, 3)
            const Vec3 want = which < 3 ? Vec3(1, 2, 3) : Vec3(0, 0, 0);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], 1e-5) << which << ", hider " << int(h) << s.messages();
        }
}

} // namespace

} // namespace overrides_test
