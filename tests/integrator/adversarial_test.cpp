// Programs that nobody should write over illuminance, illuminate, solar and gather: every one ends, is finite where its words
// mean something, and says what it cannot do. Values follow from the lamps: Cl of 1, 10 and 100 at heights 2, 3 and 5 straight
// above the floor.
#include "base/limits.h"
#include "integrator/floorscene.h"
#include "scene/scene.h"

namespace adversarial_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

struct Shown {
    Color colour{0};
    std::string messages;
    bool built = false;
};

/// A picture of one ray, whatever is wrong with its shaders.
Shown shown(const std::string& rib, Hider h) {
    struct Keeper final : scene::FrameConsumer {
        std::shared_ptr<const scene::Frame> frame;
        void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
        void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&,
                         const SourcePlace&) override {}
    } keeper;
    Diagnostics d;
    Shown s;
    ri::RibReader reader({}, keeper, d);
    reader.readMemory(rib, "test.rib");
    Settings settings = withShaders(h);
    settings.shaderPaths.push_back(shaderFolder());
    if (const auto built = keeper.frame ? buildWorld(keeper.frame, settings, d) : nullptr) {
        std::vector<SampleResult> out(1);
        Integrator i(built, d);
        const CameraRay ray = rayTo({.3f, .4f, -.4f}, {0, 0, 0});
        s.built = i.trace({&ray, 1}, out, nullptr);
        s.colour = out[0].color;
    }
    for (const Diagnostic& m : d.all()) s.messages += toString(m);
    return s;
}

std::string lamps() {
    writeShader(
        "evillamp",
        "light evillamp(float h = 1, c = 1; string __category = \"\";) { illuminate(point \"world\" (0, h, 0)) Cl = c; }\n");
    return "LightSource \"evillamp\" 1 \"h\" 2 \"c\" 1 \"__category\" \"key,warm\"\nLightSource \"evillamp\" 2 \"h\" 3 \"c\" 10 "
           "\"__category\" \"warm,fill\"\n"
           "LightSource \"evillamp\" 3 \"h\" 5 \"c\" 100\n";
}

/// A body of a surface, the value that it shows, and words of the message that it gives; "": none.
struct Case {
    const char* body;
    float want;
    const char* says = "";
};

const char kFunctions[] =
    "    float bad = (u > 2) ? 1 : 1e38 * 1e38 - 1e38 * 1e38;\n" // not a number, known only when the shader runs
    "    string later(string a;) { string r = a; if (u > 2) r = \"x\"; return r; }\n"
    "    color all(point p;) { color c = 0; illuminance(p) c += Cl; return c; }\n"
    "    color first(string cat;) { illuminance(cat, P) { return Cl; } return -1; }\n"
    "    float deep(float n;) { float i; for (i = 0; i < n; i += 1) { illuminance(P) { if (i == 2) return comp(Cl, 0) + i; } } "
    "return -1; }\n"
    "    void both(output color a, b;) { illuminance(\"warm\", P) a += Cl; illuminance(\"-warm\", P) b += Cl; }\n";

void runSurfaces(const std::string& name, std::span<const Case> cases) {
    int n = 0;
    for (const Case& c : cases)
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            if (h == Hider::Path && n % 4 != 1) continue; // every fourth
            const std::string shader = name + std::to_string(n++) + (h == Hider::Path ? "p" : "");
            writeShader(shader, "surface " + shader + "() {\n" + kFunctions +
                                    "    Oi = 1; Ci = 0; vector up = vector \"world\" (0, 1, 0); uniform float i, j;\n    " +
                                    c.body + "\n}\n");
            const Shown s = shown(inWorld(lamps() + "Surface \"" + shader + "\" " + kFloor), h);
            ASSERT_TRUE(s.built) << c.body << s.messages;
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(s.colour[k], c.want, 1e-4f * std::max(1.f, std::fabs(c.want))) << c.body << s.messages;
            if (*c.says) EXPECT_NE(s.messages.find(c.says), std::string::npos) << c.body << "\n" << s.messages;
            else EXPECT_EQ(s.messages.find("error"), std::string::npos) << c.body << "\n" << s.messages;
        }
}

TEST(Adversarial, LoopsOverLights) {
    const Case cases[] = {
        // Cones that are none.
        {"illuminance(P, vector(0, 0, 0), PI / 2) Ci += Cl;", 111},
        {"illuminance(P, vector(0, 0, 0), 0) Ci += Cl;", 111},
        {"illuminance(P, up, bad) Ci += Cl;", 111},
        {"illuminance(P, up, -1) Ci += Cl;", 111},
        {"illuminance(P, up, 100) Ci += Cl;", 111},
        {"illuminance(P, -up, 2 * PI) Ci += Cl;", 111},
        {"illuminance(P, -up, PI / 2) Ci += Cl;", 0},
        {"illuminance(P, 1e30 * up, 1) Ci += Cl;", 111},
        {"illuminance(P, 1e-30 * up, 1) Ci += Cl;", 111},
        {"illuminance(P, vector(bad, bad, bad), 1) Ci += Cl;", 111},
        {"illuminance(P + vector(bad, bad, bad)) Ci += 1;", 3},
        {"illuminance(point(1e30, 1e30, 1e30)) Ci += 1;", 3},
        // Categories.
        {"illuminance(\"\", P) Ci += Cl;", 111},
        {"illuminance(\"nobody\", P) Ci += Cl;", 0},
        {"illuminance(later(\"warm\"), P) Ci += Cl;", 11},
        {"illuminance(later(\"-warm\"), P) Ci += Cl;", 100},
        {"illuminance(later(\"key|fill\"), P) Ci += Cl;", 11},
        {"illuminance(later(\"warm&-key\"), P) Ci += Cl;", 10},
        {"illuminance(later(concat(\"-\", \"(key|fill)\")), P) Ci += Cl;", 100},
        {"illuminance(later(\"\"), P) Ci += Cl;", 111},
        {"illuminance(later(\"&\"), P) Ci += Cl;", 111, "cannot be read"},
        {"illuminance(later(\"key&\"), P) Ci += Cl;", 111, "cannot be read"},
        {"illuminance(later(\"|key\"), P) Ci += Cl;", 111, "cannot be read"},
        {"illuminance(later(\"((key\"), P) Ci += Cl;", 111, "cannot be read"},
        {"illuminance(later(\"-\"), P) Ci += Cl;", 111, "cannot be read"},
        {"illuminance(\"key||fill\", P) Ci += Cl;", 111, "cannot be read"},
        {"illuminance(\")\", P) Ci += Cl;", 111, "cannot be read"},
        {"string c[3] = {\"key\", \"fill\", \"-warm\"}; for (i = 0; i < 3; i += 1) illuminance(c[i], P) Ci += (i + 1) * Cl;",
         1 + 20 + 300},
        {"Ci = arraylength(getlights(\"category\", later(\"warm\")));", 2},
        {"Ci = arraylength(getlights(\"category\", later(\"&&\")));", 3, "cannot be read"},
        // Ways out of loops.
        {"for (i = 0; i < 3; i += 1) { illuminance(P) { Ci += Cl; break; } Ci += 1000; }", 3003},
        {"for (i = 0; i < 3; i += 1) { illuminance(P) { Ci += Cl; break 2; } Ci += 1000; }", 1},
        {"for (i = 0; i < 3; i += 1) { illuminance(P) { Ci += Cl; continue 2; } Ci += 1000; }", 3},
        {"for (i = 0; i < 3; i += 1) { for (j = 0; j < 3; j += 1) { illuminance(P) { Ci += Cl; break 3; } } Ci += 1000; }", 1},
        {"illuminance(P) { for (i = 0; i < 9; i += 1) { if (i == 2) break; if (i == 0) continue; Ci += Cl; } }", 111},
        {"illuminance(P) { i = 0; while (i < 9) { i += 1; if (i > 3) { break 2; } Ci += Cl; } }", 3},
        {"illuminance(P) { if (comp(Cl, 0) == 10) continue; Ci += Cl; }", 101},
        {"i = 0; while (comp(Ci, 0) < 200) { i += 1; illuminance(P) Ci += Cl; } Ci += 1000 * i;", 2222},
        {"i = 0; do { i += 1; illuminance(\"key\", P) Ci += Cl; } while (i < 4);", 4},
        {"Ci = first(\"\") + first(\"fill\") + first(\"nobody\");", 10},
        {"Ci = deep(5) + deep(1);", 2},
        {"color a = 0, b = 0; both(a, b); both(b, a); Ci = a * 2 + b;", 333},
        {"for (i = 0; i < 64; i += 1) Ci += all(P);", 64 * 111},
        {"for (i = 0; i < 2; i += 1) { illuminance(P) { if (i == 1) { if (comp(Cl, 0) > 5) break; } Ci += Cl; } }", 112},
        {"illuminance(P) {}", 0},
        {"illuminance(P) ; Ci = 5;", 5},
        {"illuminance(P) { break; Ci = 7; }", 0},
        {"illuminance(P) { continue; Ci = 7; }", 0},
        {"if (u > 2) { illuminance(P) Ci += Cl; } else { illuminance(\"key\", P) Ci += Cl; }", 1},
        // What belongs to the turn.
        {"illuminance(P) { Cl = 2; Ci += Cl; }", 6},
        {"illuminance(P) { L = 0; Ci += length(L) + 1; }", 3},
        {"illuminance(P) Ci += ycomp(vtransform(\"world\", L));", 10},
        {"float x = -1; illuminance(P, \"light:nothing\", x) Ci += x;", -3},
        {"illuminance(P, \"send:light:c\", 1e20) Ci += Cl * 1e-20;", 3},
        {"illuminance(P, \"send:light:h\", color(1, 2, 3)) Ci += Cl;", 111},
        {"illuminance(P, \"send:light:nothing\", 3) Ci += Cl;", 111},
        {"illuminance(P, \"lightcache\", \"maybe\") Ci += Cl;", 111, "\"lightcache\" is"},
        {"point Q = P; illuminance(P) { P += up; Ci += Cl; } P = Q;", 111},
        {"color c[4]; i = 0; illuminance(P) { c[i] = Cl; i += 1; } Ci = c[0] + 2 * c[1] + 3 * c[2];", 321},
        // A gather of a billion rays sends as many as one call may, and meets what is black.
        {"color h = 0; gather(\"illuminance\", P, up, PI / 2, 1e9, \"surface:Ci\", h) { Ci += h; } else { Ci += 0; }", 0,
         "limit of 4096 rays"},
    };
    runSurfaces("evil", cases);
}

/// A body of a light, and what the floor below it shows by a loop that sums up Cl.
TEST(Adversarial, Lights) {
    const Case cases[] = {
        {"illuminate(from, vector(0, 0, 0), .1) Cl = 1;", 1},
        {"illuminate(from, down, bad) Cl = 1;", 1},
        {"illuminate(from, down, -.5) Cl = 1;", 1},
        {"illuminate(from, down, 2 * PI) Cl = 1;", 1},
        {"illuminate(from, -down, 4) Cl = 1;", 1},
        {"illuminate(from, -down, PI / 2) Cl = 1;", 0},
        {"illuminate(from) { illuminate(from) Cl = 1; }", 1},
        {"uniform float i; for (i = 0; i < 3; i += 1) illuminate(from) Cl = i;", 2},
        {"lampOf(1); lampOf(20);", 21},
        {"if (bad != bad) lampOf(3);", 3},
        {"if (bad == bad) lampOf(3);", 0},
        {"uniform float i; for (i = 0; i < 3; i += 1) lampOf(i + 1);", 3},
        {"illuminate(from) Cl = 1; solar(down, 0) Cl = 20; illuminate(from + down) Cl = 300;", 321},
        {"solar(down, -.1) Cl = 1;", 1},
        {"solar(down, 100) Cl = 1;", 1},
        {"illuminate(from) { if (length(L) > 1) Cl = 1; else Cl = 5; }", 1},
        {"illuminate(from) { uniform float i; for (i = 0; i < 9; i += 1) { if (i == 4) break; Cl += 1; } }", 4},
        {"Cl = 3; illuminate(from) Cl += 1;", 4},
        {"illuminate(from) ;", 0},
        {"illuminate(from) {}", 0},
    };
    writeShader("evilsum", "surface evilsum() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
    int n = 0;
    for (const Case& c : cases)
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            const std::string name = "evillight" + std::to_string(n++);
            writeShader(name, "light " + name +
                                  "() {\n    point from = point \"world\" (0, 2, 0); vector down = vector \"world\" (0, -1, 0); "
                                  "float bad = (xcomp(Ps) > 1e9) ? 1 : 1e38 * 1e38 - 1e38 * 1e38;\n"
                                  "    void lampOf(float x;) { extern point from; illuminate(from) Cl = x; }\n    " +
                                  c.body + "\n}\n");
            const Shown s = shown(inWorld("LightSource \"" + name + "\" 1\nSurface \"evilsum\" " + kFloor), h);
            ASSERT_TRUE(s.built) << c.body << s.messages;
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(s.colour[k], c.want, 1e-4f * std::max(1.f, std::fabs(c.want))) << c.body << "\n" << s.messages;
            if (*c.says) EXPECT_NE(s.messages.find(c.says), std::string::npos) << c.body << "\n" << s.messages;
            else EXPECT_EQ(s.messages.find("error"), std::string::npos) << c.body << "\n" << s.messages;
        }
}

// Programs that cannot be compiled are said, and the scene is drawn without them.
TEST(Adversarial, Refused) {
    const std::pair<const char*, const char*> cases[] = {
        {"surface NAME() { illuminate(P) Ci = 1; }", "illuminate"},
        {"surface NAME() { solar() Ci = 1; }", "solar"},
        {"surface NAME() { break; }", "break"},
        {"surface NAME() { illuminance(P) { break 2; } }", "break"},
        {"surface NAME() { illuminance() Ci = 1; }", "illuminance"},
        {"surface NAME() { illuminance(P, N) Ci = 1; }", "illuminance"},
        {"color f(float x;) { return x > 0 ? f(x - 1) : color(0); } surface NAME() { Ci = f(3); }", "f"},
        {"surface NAME() { illuminance(P { Ci = 1; } }", "expected"},
        {"displacement NAME() { illuminance(P) P += Cl; }", "illuminance"},
    };
    int n = 0;
    for (const auto& [text, says] : cases) {
        const std::string name = "evilno" + std::to_string(n++);
        std::string source = text;
        source.replace(source.find("NAME"), 4, name);
        writeShader(name, source + "\n");
        const Shown s = shown(
            inWorld(lamps() + (source.rfind("displacement", 0) == 0 ? "Displacement \"" : "Surface \"") + name + "\" " + kFloor),
            Hider::Hidden);
        EXPECT_NE(s.messages.find("error"), std::string::npos) << text << s.messages;
        EXPECT_NE(s.messages.find(says), std::string::npos) << text << s.messages;
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(s.colour[k])) << text;
    }
    for (const char* body : {"illuminance(P) Cl = 1;", "illuminate(from) { illuminance(P) Cl = 1; }", "solar(down) Cl = 1;",
                             "illuminate() Cl = 1;", "illuminate(from, down) Cl = 1;"}) {
        const std::string name = "evilno" + std::to_string(n++);
        writeShader(name, "light " + name + "() { point from = 0; vector down = 1; " + body + " }\n");
        const Shown s = shown(inWorld("LightSource \"" + name + "\" 1\nSurface \"matte\" " + kFloor), Hider::Hidden);
        EXPECT_NE(s.messages.find("error"), std::string::npos) << body << s.messages;
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(s.colour[k])) << body;
    }
}

// A block of a function is one for each call, up to a limit.
TEST(Adversarial, TooManyBlocks) {
    writeShader("evilsum", "surface evilsum() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
    for (const size_t calls : {size_t(20), limits::kLightBlocks, limits::kLightBlocks + 1}) {
        const std::string name = "evilblocks" + std::to_string(calls);
        std::string body;
        for (size_t k = 0; k < calls; ++k) body += " lamp();";
        writeShader(name, "light " + name + "() { void lamp() { illuminate(point \"world\" (0, 2, 0)) Cl = 1; }" + body + " }\n");
        const Shown s = shown(inWorld("LightSource \"" + name + "\" 1\nSurface \"evilsum\" " + kFloor), Hider::Hidden);
        const bool few = calls <= limits::kLightBlocks;
        EXPECT_EQ(s.messages.find("has no more than " + std::to_string(limits::kLightBlocks)) == std::string::npos, few)
            << s.messages;
        EXPECT_NEAR(s.colour[0], few ? float(calls) : 0.f, 1e-4);
    }
}

// Functions that call each other 2^39 times: what looks into calls looks into each function once, or until there are too many
// blocks.
TEST(Adversarial, CallsOfCalls) {
    std::string chain;
    for (int k = 1; k < 40; ++k)
        chain += " float f" + std::to_string(k) + "(float x) { return f" + std::to_string(k - 1) + "(x) + f" +
                 std::to_string(k - 1) + "(x); }\n";
    writeShader("evildark",
                "float f0(float x) { return x; }\n" + chain +
                    "light evildark() { illuminate(point \"world\" (0, 2, 0)) Cl = 1; if (xcomp(Ps) > 1e6) Cl = f39(1); }\n");
    writeShader("evilblocks", "float f0(float x) { illuminate(point \"world\" (0, 2, 0)) Cl = 1; return x; }\n" + chain +
                                  "light evilblocks() { float x = f39(1); }\n");
    writeShader(
        "evilgrid",
        "float f0(float x) { return gridmin(x); }\n" + chain +
            "surface evilgrid() { uniform float most = 0; if (xcomp(P) > 1e6) most = f39(xcomp(P)); Oi = 1; Ci = 1 + most; }\n");
    writeShader("evilsum", "surface evilsum() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
    EXPECT_NEAR(shown(inWorld(std::string("LightSource \"evildark\" 1\nSurface \"evilsum\" ") + kFloor), Hider::Hidden).colour[0],
                1, 1e-5);
    const Shown blocks =
        shown(inWorld(std::string("LightSource \"evilblocks\" 1\nSurface \"evilsum\" ") + kFloor), Hider::Hidden);
    EXPECT_NE(blocks.messages.find("has no more than " + std::to_string(limits::kLightBlocks)), std::string::npos)
        << blocks.messages;
    EXPECT_NEAR(shown(inWorld(std::string("Surface \"evilgrid\" ") + kFloor), Hider::Hidden).colour[0], 1, 1e-5);
}

// More lights than a strip remembers, each with its turn; more samples than anybody wants.
TEST(Adversarial, Many) {
    writeShader("evilsum", "surface evilsum() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; illuminance(P) Ci += Cl; }\n");
    std::string many = lamps();
    for (int k = 0; k < 300; ++k) many += "LightSource \"evillamp\" " + std::to_string(10 + k) + " \"h\" 2\n";
    EXPECT_NEAR(shown(inWorld(many + "Surface \"evilsum\" " + kFloor), Hider::Hidden).colour[0], 2 * 411, 1e-3);
    writeShader("evilarea", "light evilarea() { illuminate(P, N, PI / 2) Cl = 1; }\n");
    const std::string area =
        "AttributeBegin Attribute \"light\" \"samples\" [1000000000] Attribute \"light\" \"string units\" \"radiance\" "
        "AreaLightSource \"evilarea\" 1 Translate 0 2 0 Rotate 90 1 0 0 Sphere .5 -.5 .5 360 AttributeEnd\n";
    // Of a ball that ends a sixteenth of the sky: its radiance 1 has Cl cos = 1 / 16 in the mean.
    writeShader("evilcos",
                "surface evilcos() { Oi = 1; Ci = 0; illuminance(P, N, PI / 2) Ci += Cl * (normalize(N) . normalize(L)); }\n");
    const Shown s = shown(inWorld(area + "Illuminate 1 1 Surface \"evilcos\" " + kFloor), Hider::Hidden);
    EXPECT_NEAR(s.colour[0], 1. / 16, .01) << s.messages;
}

} // namespace

} // namespace adversarial_test
