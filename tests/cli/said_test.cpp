// What would be a silent zero or a picture of another kind is said, with the place and what to do.
#include "base/limits.h"
#include "command_folder.h"
#include "display/imageio.h"
#include <fstream>
#include <gtest/gtest.h>

namespace said_test {

namespace {

class Said : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string text(const char* name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string errors() const { return text("err"); }
    bool says(const std::string& words) const { return errors().find(words) != std::string::npos; }
    int times(const std::string& words) const {
        const std::string e = errors();
        int n = 0;
        for (size_t at = e.find(words); at != std::string::npos; at = e.find(words, at + 1)) ++n;
        return n;
    }
    /// A picture of 8 x 8 that shows one sphere, with these requests before and in the world.
    void scene(const std::string& options, const std::string& world, const char* name = "a.rib") const {
        write(name, "Format 8 8 1\nProjection \"perspective\" \"fov\" [30]\n" + options + "Translate 0 0 5\nWorldBegin\n" +
                        world + "Sphere 1 -1 1 360\nWorldEnd\n");
    }
};

const std::string kPng = "\x89PNG", kJpeg = "\xff\xd8\xff", kExr = "\x76\x2f\x31\x01", kTiff = "II*";

} // namespace

// A ball encloses its medium; a cylinder without lids does not.
TEST_F(Said, OpenMedia) {
    const auto fog = [&](const std::string& shape) {
        scene(
            "Hider \"path\"\nPixelSamples 4 4\n",
            "LightSource \"envlight\" 1\nAttributeBegin Surface \"null\" Interior \"medium\" \"color scattering\" [.5 .5 .5]\n" +
                shape + "\nAttributeEnd\nTranslate 5 0 0\n");
        run("render a.rib -o a.exr");
        EXPECT_EQ(status, 0);
    };
    fog("Sphere 1.5 -1.5 1.5 360");
    EXPECT_FALSE(says("does not enclose it")) << errors();
    fog("Rotate 90 1 0 0 Cylinder 1.5 -1 1 360");
    EXPECT_TRUE(says("does not enclose it")) << errors();
    EXPECT_TRUE(says("a.rib:")) << errors();
    EXPECT_EQ(times("rays in the medium"), 1) << errors();
}

TEST_F(Said, ExtensionsThatNobodyWrites) {
    scene("", "Surface \"constant\"\n");
    for (const char* name : {"a.gif", "a", "a.pic", "a.exr.bak"}) {
        run(std::string("render -o ") + name + " a.rib");
        EXPECT_EQ(status, 2) << name;
        EXPECT_TRUE(says(".exr .tif .tiff .png .jpg .jpeg")) << errors();
        EXPECT_FALSE(std::filesystem::exists(dir / name));
    }
    run("merge a.part b.part -o a.gif");
    EXPECT_EQ(status, 2);
    run("diff a.exr b.exr -o a.gif");
    EXPECT_EQ(status, 2);
}

TEST_F(Said, Jpeg) {
    scene("Display \"d.jpg\" \"jpeg\" \"rgba\"\nDisplay \"+f.jpeg\" \"file\" \"rgb\"\nDisplay \"+g.bmp\" \"file\" "
          "\"rgb\"\nExposure 1 1\n",
          "Surface \"constant\"\nColor [1 .5 .25]\nScale 4 4 1\n"); // fills the picture
    run("render a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(text("d.jpg").substr(0, 3), kJpeg);
    EXPECT_EQ(text("f.jpeg").substr(0, 3), kJpeg);
    EXPECT_EQ(text("g.bmp").substr(0, 3), kTiff);
    EXPECT_TRUE(says("a.rib:5:1: warning: display \"g.bmp\": .bmp is not written here")) << errors();
    run("render -o o.jpg a.rib");
    EXPECT_EQ(text("o.jpg").substr(0, 3), kJpeg);
    run("diff d.jpg f.jpeg");
    EXPECT_EQ(status, 0);
    alpenglow::Diagnostics d;
    const auto image = alpenglow::display::readImage((dir / "d.jpg").string(), d);
    ASSERT_TRUE(image);
    ASSERT_EQ(image->channelCount(), 3);
    const float* p = image->pixel(4, 4);
    EXPECT_NEAR(p[0], 1, 3 / 255.);
    EXPECT_NEAR(p[1], .5, 3 / 255.);
    EXPECT_NEAR(p[2], .25, 3 / 255.);
}

TEST_F(Said, StandardOutput) {
    write("talks.sl", "surface talks() { if (u < 2) printf(\"words\\n\"); Ci = 1; Oi = 1; }\n");
    scene("", "Surface \"talks\"\n");
    const std::string png = run("render -o - a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(png.substr(0, 4), kPng);
    EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
    EXPECT_TRUE(says("words"));
    run("render -o a.png a.rib");
    EXPECT_EQ(text("a.png"), png);
    for (const auto& [type, magic] : {std::pair{"openexr", kExr}, {"tiff", kTiff}, {"jpeg", kJpeg}, {"framebuffer", kPng}}) {
        scene(std::string("Display \"a\" \"") + type + "\" \"rgb\"\n", "Surface \"constant\"\n");
        EXPECT_EQ(run("render -o - a.rib").substr(0, magic.size()), magic);
    }
    EXPECT_FALSE(std::filesystem::exists(dir / "-"));
    run("render --samples 0:1 --hider path -o - a.rib");
    EXPECT_EQ(status, 2);
    CommandFolder::run("render -o - a.rib", ">/dev/full 2>err");
    EXPECT_EQ(status, 5) << errors();
    // A scene's own "-" is a file.
    scene("Display \"-\" \"png\" \"rgb\"\n", "Surface \"constant\"\n");
    EXPECT_EQ(run("render a.rib"), "");
}

TEST_F(Said, UnknownParametersOfHiderAndDisplay) {
    scene("Hider \"hidden\" \"int jiter\" 0 \"int subpixel\" 1\n"
          "Display \"a.tif\" \"tiff\" \"rgb\" \"string compresion\" \"lzw\" \"string software\" \"x\"\n",
          "Surface \"constant\"\n");
    run("render a.rib");
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(says("a.rib:3:16: warning: Hider parameter \"jiter\" is not known")) << errors();
    EXPECT_TRUE(says("did you mean \"jitter\"?"));
    EXPECT_TRUE(says("warning: Display parameter \"compresion\" is not known"));
    EXPECT_TRUE(says("did you mean \"compression\"?"));
    EXPECT_EQ(times("warning:"), 2) << errors();
    run("render -v a.rib");
    EXPECT_TRUE(says("note: Hider parameter \"subpixel\" does nothing here")) << errors();
    EXPECT_TRUE(says("note: Display parameter \"software\" does nothing here")) << errors();
}

TEST_F(Said, UnknownOptionsAndAttributes) {
    scene("Option \"trace\" \"int maxdpth\" 3\nOption \"trase\" \"int maxdepth\" 3\nOption \"user\" \"int mine\" 3\n"
          "Option \"limits\" \"int gridsise\" 3\nOption \"visibility\" \"int camera\" 1\n",
          "Attribute \"visibilty\" \"int trace\" 1\nAttribute \"visibility\" \"int tracee\" 1\nAttribute \"visibilty\" \"int "
          "trace\" 0\n"
          "Attribute \"trace\" \"float bias\" .1\nSurface \"constant\"\n");
    run("render -o a.png a.rib");
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(says("a.rib:3:16: warning: Option \"trace\" \"maxdpth\" is not known")) << errors();
    EXPECT_TRUE(says("did you mean \"maxdepth\"?"));
    EXPECT_TRUE(says("a.rib:4:16: warning: Option \"trase\" \"maxdepth\" is not known"));
    EXPECT_TRUE(says("did you mean \"trace\"?"));
    EXPECT_TRUE(says("a.rib:7:21: warning: Option \"visibility\" \"camera\" is not known"));
    EXPECT_TRUE(says("it is an Attribute"));
    EXPECT_EQ(times("Attribute \"visibilty\" \"trace\" is not known"), 1) << errors();
    EXPECT_TRUE(says("did you mean \"visibility\"?"));
    EXPECT_TRUE(says("Attribute \"visibility\" \"tracee\" is not known"));
    EXPECT_EQ(times("warning:"), 5) << errors();
    run("render -v -o a.png a.rib");
    EXPECT_TRUE(says("note: Option \"limits\" \"gridsise\" does nothing here")) << errors();
    EXPECT_FALSE(says("\"mine\""));
}

TEST_F(Said, ParametersOfAnotherTypeOrLength) {
    scene("", "Surface \"plastic\" \"color Kd\" [1 0 0]\nSurface \"plastic\" \"Kd\" [1 2]\nSurface \"plastic\" \"uniform string "
              "Kd\" \"hello\"\n"
              "Surface \"plastic\" \"string roughness\" [\"a\"] \"float specularcolor\" .5\n"
              "Surface \"plastic\" \"uniform point specularcolor\" [1 1 1] \"specularcolor\" .3\n");
    // Only the last one is bound: the others are overwritten before there is a primitive.
    run("render -o a.png a.rib");
    EXPECT_TRUE(says("parameter \"specularcolor\" of shader \"plastic\" is a color, not a point; its numbers are taken"))
        << errors();
    const std::pair<const char*, const char*> cases[] = {
        {"\"color Kd\" [1 0 0]", "is a float, not a color; its default is used"},
        {"\"Kd\" [1 2]", "is a float: it takes 1 number, not 2; its default is used"},
        {"\"Kd\" \"hello\"", "is a float, not a string; its default is used"},
        {"\"Kd\" []", "\"Kd\" needs 1 number, not 0"},
        {"\"string roughness\" \"a\"", "is a float, not a string"},
        {"\"uniform float[2] specularcolor\" [1 1]", "is a color, not a float[2]; its default is used"}};
    for (const auto& [given, message] : cases) {
        scene("", std::string("LightSource \"ambientlight\" 1\nSurface \"plastic\" ") + given + "\n");
        run("render -o a.png a.rib");
        EXPECT_EQ(status, 1) << given;
        EXPECT_TRUE(says(message)) << given << errors();
        EXPECT_TRUE(says("a.rib:6:19: error:")) << errors();
        EXPECT_TRUE(says("  Surface \"plastic\" \"")) << errors(); // the line, and below it the caret
        EXPECT_TRUE(says("                    ^")) << errors();
    }
    for (const char* fine : {"\"uniform float Kd\" .5", "\"specularcolor\" [1 1 1]", "\"int Kd\" 1"}) {
        scene("", std::string("LightSource \"ambientlight\" 1\nSurface \"plastic\" ") + fine + "\n");
        run("render -o a.png a.rib");
        EXPECT_EQ(status, 0) << fine;
        EXPECT_EQ(errors().find("parameter"), std::string::npos) << errors();
    }
}

// Zero and null are not the same as missing: the default holds, as if nothing had been given.
TEST_F(Said, OfAWrongParameterTheDefaultHolds) {
    write("grey.sl", "surface grey(float k = .25;) { Ci = k; Oi = 1; }\n");
    scene("", "Scale 4 4 1\nSurface \"grey\" \"color k\" [1 0 0]\n", "wrong.rib");
    scene("", "Scale 4 4 1\nSurface \"grey\"\n", "plain.rib");
    run("render -o wrong.exr wrong.rib");
    run("render -o plain.exr plain.rib");
    run("diff wrong.exr plain.exr");
    EXPECT_EQ(status, 0);
}

TEST_F(Said, MissingCoShaders) {
    write("layer.sl", "class layer(color c = 1;) { public void getColor(output color to) { to = c; } }\n");
    write("coat.sl", "class coat(shader layers[2] = {null, null}; shader one = null; output varying float nulls = 0;) {\n"
                     "    public void surface(output color Ci, Oi) {\n        uniform float i; Ci = 0; Oi = 1;\n"
                     "        for (i = 0; i < 2; i += 1) { color c = 0;\n"
                     "            if (layers[i] != null) { layers[i]->getColor(c); Ci += c; } else Ci += color(0, .5, 0); }\n"
                     "        if (one == null) Ci += color(0, 0, .25);\n    }\n}\n");
    scene("", "Scale 4 4 1\nShader \"layer\" \"l1\" \"color c\" [.5 0 0]\nSurface \"coat\" \"string[2] layers\" [\"l1\" \"l2\"] "
              "\"string one\" \"nobody\"\n");
    run("render -o a.exr a.rib");
    EXPECT_EQ(status, 1);
    EXPECT_TRUE(says("a.rib:7:16: error: there is no co-shader \"l2\": \"layers[1]\" of shader \"coat\" is null")) << errors();
    EXPECT_TRUE(says("did you mean \"l1\"?"));
    EXPECT_TRUE(says("there is no co-shader \"nobody\": \"one\" of shader \"coat\" is null"));
    EXPECT_EQ(times("error:"), 2) << errors();
    alpenglow::Diagnostics d;
    const auto image = alpenglow::display::readImage((dir / "a.exr").string(), d);
    ASSERT_TRUE(image);
    const float* p = image->pixel(4, 4);
    EXPECT_NEAR(p[0], .5, 1e-6);
    EXPECT_NEAR(p[1], .5, 1e-6);
    EXPECT_NEAR(p[2], .25, 1e-6);
}

TEST_F(Said, ChannelsThatNobodyWrites) {
    write("gives.sl", "surface gives(output varying color specAOV = 0;) { specAOV = color(1, .5, 0); Ci = specAOV; Oi = 1; }\n");
    const std::string head = "Display \"a.exr\" \"openexr\" \"rgba\"\n";
    scene(head + "Display \"+b.exr\" \"openexr\" \"varying color specAVO,N,z\"\n", "Surface \"gives\"\n");
    run("render a.rib");
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(says("a.rib:4:1: warning: display \"b.exr\": no shader outputs \"specAVO\"; its channels are 0")) << errors();
    EXPECT_TRUE(says("did you mean \"specAOV\"?"));
    EXPECT_EQ(times("no shader outputs"), 1);
    scene(head + "Display \"+b.exr\" \"openexr\" \"varying color specAOV,N\"\n", "Surface \"gives\"\n");
    run("render a.rib");
    EXPECT_EQ(errors().find("no shader outputs"), std::string::npos) << errors();
}

TEST_F(Said, DirectLightOnly) {
    write("capped.sl", "surface capped(float Kd = 1;)\n{\n    Oi = Os;\n    Ci = min(Cs * Kd * diffuse(normalize(N)), 1);\n}\n");
    scene("", "LightSource \"pointlight\" 1 \"intensity\" 10 \"from\" [0 0 -3]\nSurface \"capped\"\n");
    run("render --hider path --spp 8 -o a.exr a.rib");
    EXPECT_EQ(status, 0) << errors();
    EXPECT_EQ(times("capped.sl:4:"), 1) << errors();
    EXPECT_TRUE(says("warning: shader \"capped\" under path: diffuse() brings direct light only, for it is used non-linearly"))
        << errors();
    EXPECT_TRUE(says("use its light in sums and products only"));
    run("render --spp 8 -o a.exr a.rib"); // from the cache
    run("render --hider path --spp 8 -o a.exr a.rib");
    EXPECT_EQ(times("direct light only"), 1) << errors();
    run("render --hider hidden -o a.exr a.rib");
    EXPECT_EQ(times("direct light only"), 0) << errors();
    run("compile -W --path capped.sl");
    EXPECT_TRUE(says("it brings direct light only")) << errors();
    write("good.sl", "surface good(float Kd = 1;) { Oi = Os; Ci = Oi * Cs * Kd * diffuse(normalize(N)) + .1; }\n");
    scene("", "LightSource \"pointlight\" 1 \"intensity\" 10 \"from\" [0 0 -3]\nSurface \"good\"\n");
    run("render --hider path --spp 8 -o a.exr a.rib");
    EXPECT_EQ(errors().find("warning"), std::string::npos) << errors();
}

TEST_F(Said, PicturesWithNothingInThem) {
    const std::string look = "Format 8 8 1\nProjection \"perspective\"\nDisplay \"a.exr\" \"openexr\" \"rgba\"\n",
                      ball = "Sphere 1 -1 1 360\nWorldEnd\n";
    const std::string lamp = "LightSource \"pointlight\" 1 \"from\" [0 0 -3]\n";
    for (const char* hider : {"hidden", "path"}) {
        const auto render = [&](const std::string& text) {
            write("e.rib", text);
            run(std::string("render --hider ") + hider + " --spp 4 e.rib");
            EXPECT_EQ(status, 0) << errors();
        };
        render(look + "Translate 0 0 -5\nWorldBegin\n" + lamp + "Surface \"matte\"\n" + ball);
        EXPECT_EQ(times("the picture is empty"), 1) << errors();
        EXPECT_TRUE(says("everything is behind the camera")) << errors();
        render(look + "Translate 50 0 5\nWorldBegin\n" + lamp + ball);
        EXPECT_TRUE(says("1 shape of 1 lies before it")) << errors();
        render(look + "WorldBegin\n" + lamp + "WorldEnd\n");
        EXPECT_TRUE(says("no primitives")) << errors();
        render("Imager \"background\" \"color\" [1 0 0]\n" + look + "WorldBegin\nWorldEnd\n"); // what imagers paint is a picture
        EXPECT_EQ(times("the picture is"), 0) << errors();
        render(look + "Translate 0 0 5\nWorldBegin\nSurface \"matte\"\n" + ball);
        EXPECT_TRUE(says("the picture is black: the scene has no lights")) << errors();
        render(look + "Translate 0 0 5\nWorldBegin\nAttributeBegin\n" + lamp + "AttributeEnd\nSurface \"matte\"\n" + ball);
        EXPECT_TRUE(says("surfaces are seen, but the light does not show on them")) << errors();
        render(look + "Translate 0 0 5\nWorldBegin\n" + lamp + "Surface \"matte\"\n" + ball);
        EXPECT_EQ(times("the picture is"), 0) << errors();
        render(look + "Translate 0 0 5\nWorldBegin\nSurface \"constant\"\n" + ball);
        EXPECT_EQ(times("the picture is"), 0) << errors();
        render(look + "CropWindow 0 .1 0 .1\nTranslate 0 0 5\nWorldBegin\n" + lamp + "Surface \"matte\"\n" + ball);
        EXPECT_EQ(times("the picture is"), 0) << errors();
    }
}

TEST_F(Said, ALightThatEndsBeforeAnythingIsLit) {
    const std::string look =
                          "Projection \"perspective\" \"fov\" 40\nFormat 8 8 1\nPixelSamples 1 1\nTranslate 0 0 5\nWorldBegin\n"
                          "LightSource \"distantlight\" 1\nSurface \"matte\"\n",
                      ball = "Sphere 1 -1 1 360\nWorldEnd\n",
                      block = "AttributeBegin\nTranslate 0 3 0\nLightSource \"pointlight\" 2\nAttributeEnd\n";
    const auto said = [&](const std::string& inside) {
        write("s.rib", look + inside + ball);
        run("render --progress none -o s.png s.rib");
        return times("light \"pointlight\" shines on nothing");
    };
    EXPECT_EQ(said(block), 1) << errors();
    EXPECT_TRUE(says("s.rib:10:")) << errors();
    EXPECT_EQ(said(block + "Illuminate 2 1\n"), 0) << errors();
    EXPECT_EQ(said("LightSource \"pointlight\" 2\nIlluminate 2 0\n"), 0) << errors(); // switched off
    EXPECT_EQ(said("AttributeBegin\nLightSource \"pointlight\" 2\nDisk 0 1 360\nAttributeEnd\n"), 0) << errors();
    EXPECT_EQ(said("ObjectBegin 1\nSphere 1 -1 1 360\nObjectEnd\nAttributeBegin\nLightSource \"pointlight\" 2\n"
                   "ObjectInstance 1\nAttributeEnd\n"),
              0)
        << errors();
}

TEST_F(Said, NormalsOnBothSides) {
    write("s.rib", "Projection \"perspective\" \"fov\" 40\nFormat 8 8 1\nPixelSamples 1 1\nTranslate 0 0 5\nWorldBegin\n"
                   "LightSource \"distantlight\" 1\nSurface \"matte\"\n"
                   "PointsPolygons [3 3] [0 1 2 0 2 3] \"P\" [-1 -1 0  -1 1 0  1 1 0  1 -1 0] "
                   "\"facevarying normal N\" [0 0 1 0 0 1 0 0 1  0 0 -1 0 0 -1 0 0 -1]\nWorldEnd\n");
    run("render --progress none -o s.png s.rib");
    EXPECT_TRUE(says("s.rib:8:")) << errors();
    EXPECT_TRUE(says("on the front of some faces and on the back of others (1 of 2 places looked at)")) << errors();
}

TEST_F(Said, LoopsWithoutEnd) {
    // Each turn adds 1; floats hold ten million exactly.
    for (const char* lanes : {"4", "8", "16"}) {
        EXPECT_EQ(run(std::string("eval --lanes ") + lanes + " --setup 'float n = 0;\nwhile (1 < 2) n += 1;' n"), "1e+07\n");
        EXPECT_EQ(status, 1);
        EXPECT_EQ(times("expression:3:"), 1) << errors();
        EXPECT_TRUE(says("this loop is left after " + std::to_string(alpenglow::limits::kLoopIterations) + " turns at one point"))
            << errors();
        EXPECT_TRUE(says("[loop-limit]")) << errors();
    }
    EXPECT_EQ(run("eval --setup 'float n = 0; while (n < 9999999) n += 1;' n"), "9999999\n");
    EXPECT_EQ(status, 0) << errors();
    // Points that leave keep what they have.
    write("some.sl", "surface some()\n{\n    float n = 0, x = 0;\n    while (u < .5 || n < 3) { n += 1; x = n; }\n    Ci = x / "
                     "1e7; Oi = 1;\n}\n");
    for (const char* lanes : {"4", "16"}) {
        run(std::string("shade --patch some.sl -o ") + lanes + ".exr --format 8x2 --lanes " + lanes);
        EXPECT_EQ(status, 1);
        EXPECT_EQ(times("some.sl:4:"), 1) << errors();
    }
    run("diff 4.exr 16.exr");
    EXPECT_EQ(status, 0);
    alpenglow::Diagnostics d;
    const auto image = alpenglow::display::readImage((dir / "4.exr").string(), d);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->pixel(0, 0)[0], 1);
    EXPECT_EQ(image->pixel(7, 0)[0], 3 / 1e7f);
}

TEST_F(Said, NestedLoopsWithoutEndHaveATotal) {
    // 1,000 turns inside and one of its own make 1,001 of each turn outside: 9,990 of them are fewer than ten million.
    for (const char* lanes : {"4", "16"}) {
        EXPECT_EQ(run(std::string("eval --lanes ") + lanes +
                      " --setup 'float n = 0, i;\nwhile (1 < 2) {\n n += 1; for (i = 0; i < 1000; i += 1) n += 0; }' n"),
                  "9991\n");
        EXPECT_EQ(status, 1);
        EXPECT_EQ(times("this loop is left"), 1) << errors();
        EXPECT_EQ(times("expression:3:"), 1) << errors();
    }
    // Three deep, and a function that loops: the outermost loop is the one that is named.
    run("eval --setup 'float n = 0, i, j; while (1 < 2)\n for (i = 0; i < 1e6; i += 1) for (j = 0; j < 1e6; j += 1) n = j;' n");
    EXPECT_EQ(status, 1);
    EXPECT_EQ(times("this loop is left"), 1) << errors();
    // Points that leave keep what they have, those beside them go on: 2 turns by 3.
    write("nest.sl", "surface nest()\n{\n    float n = 0, x = 0, i;\n    while (u < .5 || n < 2) {\n        n += 1;\n"
                     "        for (i = 0; i < 3 + 996 * step(u, .5); i += 1) x += 1;\n    }\n    Ci = n; Oi = x;\n}\n");
    for (const char* lanes : {"4", "16"}) {
        run(std::string("shade --patch nest.sl -o ") + lanes + ".exr --format 8x2 --lanes " + lanes);
        EXPECT_EQ(status, 1);
        EXPECT_EQ(times("nest.sl:4:"), 1) << errors();
    }
    run("diff 4.exr 16.exr");
    EXPECT_EQ(status, 0);
    alpenglow::Diagnostics d;
    const auto image = alpenglow::display::readImage((dir / "4.exr").string(), d);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->pixel(0, 0)[0], 10'000); // 999 and 1 a turn
    EXPECT_EQ(image->pixel(7, 0)[0], 2);
}

TEST_F(Said, ABallByDefault) {
    write("look.sl",
          "surface look(color tint = 1; string words = \"\";) { normal n = normalize(N); Oi = Os; Ci = tint * diffuse(n); }\n");
    std::filesystem::create_directory(dir / "sub");
    std::ofstream(dir / "sub" / "push.sl")
        << "displacement push(float a = .1;) { P += a * sin(20 * u) * normalize(N); N = calculatenormal(P); }\n";
    const auto mean = [&](const char* name) {
        alpenglow::Diagnostics d;
        const auto image = alpenglow::display::readImage((dir / name).string(), d);
        EXPECT_TRUE(image) << name;
        std::array<double, 3> m{};
        for (size_t i = 0; image && i < image->data.size(); ++i) m[i % size_t(image->channelCount()) % 3] += image->data[i];
        return m;
    };
    run("shade look.sl -o a.png --format 32x32 --spp 4");
    EXPECT_EQ(status, 0);
    EXPECT_EQ(errors(), "");
    const auto white = mean("a.png");
    EXPECT_GT(white[0], 32 * 32 * .1);
    run("shade look.sl --param tint=1,0,0 --param 'words=a \"b\" \\c' -o b.png --format 32x32 --spp 4");
    EXPECT_EQ(errors(), "");
    EXPECT_LT(mean("b.png")[1], white[1]); // the ball is red: less green
    EXPECT_NEAR(mean("b.png")[0], white[0], .1 * white[0]);
    for (const char* s : {"sub/push.sl", "pointlight", "fog", "background", "matte"}) {
        run(std::string("shade ") + s + " -o c.png --format 16x16 --spp 2");
        EXPECT_EQ(status, 0) << s << errors();
        EXPECT_EQ(errors(), "") << s;
    }
    EXPECT_EQ(run("shade look.sl -o - --format 8x8 --spp 1").substr(0, 4), kPng);
    run("shade look.sl --param nosuch=1 -o a.png");
    EXPECT_EQ(status, 2);
    write("bad.sl", "surface bad() { Ci = nois(P); }\n");
    run("shade bad.sl -o a.png");
    EXPECT_EQ(status, 3);
    EXPECT_EQ(times("error:"), 1) << errors();
}

// Messages about what was read long ago fetch their lines again, but not without end.
TEST_F(Said, LinesOfManyMessages) {
    const int many = alpenglow::limits::kSourceLines + 20;
    std::string world;
    for (int i = 0; i < many; ++i) world += "Surface \"plastic\" \"float q" + std::to_string(i) + "\" [1]\nSphere 1 -1 1 360\n";
    scene("", world);
    run("render -v --spp 1 -o a.png a.rib"); // -v: each of the warnings that repeat
    EXPECT_EQ(times("has no parameter"), many) << errors().substr(0, 600);
    EXPECT_EQ(times("^"), alpenglow::limits::kSourceLines);
}

} // namespace said_test
