// The examples of shadeops that need more than a point (Example::when), each in the scene that it speaks of. The text of the
// example runs as it stands in the manual, in a surface or a light called "example".
#include "integrator/floorscene.h"
#include "integrator/maps.h"
#include "rsl/front/ast.h"
#include <functional>
#include <map>

namespace examples_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A map of one colour in the folder of the test's shaders.
void oneColour(const std::string& name, Color c, bool sky = false) { writeMap(name, sky ? 32 : 16, 16, c); }

struct Stage {
    std::string before, inside; ///< the frame before the world, and the world up to the surface that is seen
    std::string shape = kFloor;
    CameraRay ray = kView;
    bool light = false; ///< the example runs in a light
};

const std::string kSky = "LightSource \"oneabove\" 1\n";

/// By the words of the manual.
const std::map<std::string, Stage>& stages() {
    static const std::map<std::string, Stage> all = [] {
        const std::string ball = "Translate 0 0 4\nSphere 1 -1 1 360\n";
        const CameraRay toBall = rayTo({0, 0, 0}, {0, 0, 4});
        // Up to where N points: the floor is seen from the side of its normal.
        const auto roof = [](const char* height) {
            const std::string h = std::string(" ") + height + " ";
            return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1 \"transmission\" 1\nSurface \"constant\"\nPolygon \"P\" "
                   "[-900" +
                   h + "-900  -900" + h + "900  900" + h + "900  900" + h + "-900]\nAttributeEnd\n";
        };
        std::map<std::string, Stage> m;
        m["one light with Cl = 1 stands straight over N"] = {"", kSky};
        m["there is one light \"ambientlight\" of intensity 0.2"] = {"", "LightSource \"ambientlight\" 1 \"intensity\" .2\n"};
        m["all rays meet a surface with Ci = 1"] = {"", roof("2")};
        m["a surface stands 2 away along N"] = {"", roof("2")};
        m["nothing stands there"] = {};
        m["two lights are on"] = {"", kSky + "LightSource \"oneabove\" 2\n"};
        m["lights of intensity 1 and 2 are on"] = {
            "", "LightSource \"distantlight\" 1 \"intensity\" 1 \"from\" [0 1 0] \"to\" [0 0 0]\n"
                "LightSource \"distantlight\" 2 \"intensity\" 2 \"from\" [0 1 0] \"to\" [0 0 0]\n"};
        m["one light of category key and one of another are on"] = {
            "", "LightSource \"oneabove\" 1 \"string __category\" \"key\"\nLightSource \"oneabove\" 2 \"string __category\" "
                "\"fill\"\n"};
        m["a light asks and nothing stands between it and Ps"] = {"", "", kFloor, kView, true};
        m["a light asks and the surface shader has a parameter Kd of 0.5"] = {"", "", kFloor, kView, true};
        m["the displacement shader has a parameter amount of 0.5"] = {"", "Displacement \"moved\" \"amount\" .5\n"};
        m["the volume shader has a parameter density of 0.5"] = {"", "Atmosphere \"thick\" \"density\" .5\n"};
        m["the volume before the surface has a parameter density of 0.5"] = {"", "Exterior \"thick\" \"density\" .5\n", ball,
                                                                             toBall};
        m["the volume behind the surface has a parameter density of 0.5"] = {"", "Interior \"thick\" \"density\" .5\n", ball,
                                                                             toBall};
        m["Attribute \"user\" \"float size\" 2 is set"] = {"", "Attribute \"user\" \"float size\" 2\n"};
        m["Option \"user\" \"float size\" 2 is set"] = {"Option \"user\" \"float size\" 2\n", ""};
        m["a frame is rendered"] = {};
        m["the camera sees the point"] = {};
        m["P stands in the middle between the planes of clipping"] = {
            "Clipping 1 11\n", "", "Polygon \"P\" [-9 -9 6  -9 9 6  9 9 6  9 -9 6]\n", rayTo({0, 0, 1}, {.1f, 0, 6})};
        m["the map has this colour everywhere"] = {};
        m["the map is the same everywhere"] = {};
        return m;
    }();
    return all;
}

/// The type that the expression has, as `alpenglow eval` chooses it.
std::string typeOf(const shadeops::Example& e, bool light) {
    for (const std::string type : {"float", "color", "point", "string"}) {
        Diagnostics quiet;
        const std::string text = std::string(light ? "light" : "surface") + " probe(output varying " + type +
                                 " r = " + (type == "string" ? "\"\"" : "0") + ";) {\n" + e.setup + "\nr = " + e.expression +
                                 ";\n}\n";
        if (rsl::compileText(text, "probe", {}, quiet)) return type;
    }
    return "";
}

TEST(Examples, ThoseThatNeedAScene) {
    writeShader("oneabove", "light oneabove(string __category = \"\";) { solar(vector \"world\" (0, -1, 0), 0) Cl = 1; }\n");
    writeShader("thick", "volume thick(float density = 1;) { Ci = Ci; Oi = Oi; }\n");
    writeShader("moved", "displacement moved(float amount = 1;) { P += 0; }\n");
    writeShader("lit", "surface lit(float Kd = .5;) { color sum = 0; illuminance(P) sum += Cl; Ci = sum; Oi = 1; }\n");
    oneColour("wood.tex", {.5f, .3f, .1f});
    oneColour("sky.env", {.5f, .7f, 1}, true);
    oneColour("bumps.tex", {.5f, .5f, .5f});
    std::map<std::string, int> used;
    int ran = 0;
    for (const shadeops::Shadeop& op : shadeops::allShadeops())
        for (const shadeops::Example& e : op.examples) {
            if (e.when.empty()) continue;
            SCOPED_TRACE(op.name + " when " + e.when + ": " + e.setup + " " + e.expression);
            const auto found = stages().find(e.when);
            ASSERT_NE(found, stages().end()) << "no scene is known by these words";
            const Stage& stage = found->second;
            ++used[e.when];
            const std::string type = typeOf(e, stage.light), name = "example" + std::to_string(ran++);
            ASSERT_NE(type, "");
            // As a colour: strings by whether they are what the manual says.
            const std::string shown = type == "float"    ? "color(" + e.expression + ")"
                                      : type == "color"  ? "(" + e.expression + ")"
                                      : type == "string" ? "color((" + e.expression + " == \"" + e.value + "\") ? 1 : 0)"
                                                         : "color(xcomp(" + e.expression + "), ycomp(" + e.expression +
                                                               "), zcomp(" + e.expression + "))";
            std::string inside = stage.inside;
            if (stage.light) {
                writeShader(name, "light " + name + "() { illuminate(point \"world\" (0, 3, 0)) {\n" + e.setup +
                                      "\nCl = " + shown + ";\n} }\n");
                inside += "LightSource \"" + name + "\" 9\nSurface \"lit\"\n";
            } else {
                writeShader(name, "surface " + name + "() {\n" + e.setup + "\nCi = " + shown + "; Oi = 1;\n}\n");
                inside += "Surface \"" + name + "\"\n";
            }
            Settings settings = withShaders(Hider::Raytrace);
            settings.texturePaths.push_back(shaderFolder());
            Scene s(stage.before + inWorld(inside + stage.shape), settings);
            ASSERT_TRUE(s.world);
            const Color got = s.one(stage.ray);
            Color want(1);
            if (type != "string") {
                std::istringstream in(e.value);
                float first = 0;
                in >> first;
                want = Color(first);
                for (int k = 1; k < 3; ++k)
                    if (float x; in >> x) want[k] = x;
            }
            // Rays begin a little off the surface, and go to lights in directions that are rounded.
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(got[k], want[k], 2e-3 * (1 + std::fabs(want[k]))) << "component " << k << "\n" << s.messages();
        }
    EXPECT_GE(ran, 20);
    for (const auto& [words, stage] : stages()) EXPECT_TRUE(used.count(words)) << "no example needs a scene where " << words;
}

} // namespace

} // namespace examples_test
