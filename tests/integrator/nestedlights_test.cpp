// illuminance inside illuminance: every inner loop has all its lights, and the outer one goes on where it was. A large floor y =
// 0 seen at the origin; lights of constant Cl = c stand h straight above it, so that sums over lights of sums over lights are
// known.
#include "base/limits.h"
#include "integrator/floorscene.h"

namespace nestedlights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* const kUp = "    normal n = normal \"world\" (0, 1, 0); vector up = n;\n    float height(vector l) { return "
                        "ycomp(vtransform(\"world\", l)); }\n";

std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface " + surface + "\n" + kFloor + "AttributeEnd\nWorldEnd\n";
}
void surfaceOf(const std::string& name, const std::string& body, const std::string& parameters = "") {
    writeShader(name, "surface " + name + "(" + parameters + ") {\n" + kUp + "    Ci = 0; Oi = 1;\n" + body + "\n}\n");
}
void writeLights() {
    writeShader("nflat", R"(light nflat(float c = 1; float h = 2; string __category = ""; output varying float doubled = 0;) {
    illuminate(point "world" (0, h, 0)) { Cl = c; doubled = 2 * c; }
}
)");
}
std::string flat(int handle, float c, float h, const std::string& category = "") {
    return "LightSource \"nflat\" " + std::to_string(handle) + " \"float c\" " + std::to_string(c) + " \"float h\" " +
           std::to_string(h) + " \"string __category\" \"" + category + "\"\n";
}
/// c = 1, 4, 16 at the heights 2, 3, 5: sums 21 and 10, and 94 of the products.
std::string three() { return flat(1, 1, 2, "a") + flat(2, 4, 3, "b") + flat(3, 16, 5, "b,c"); }

void expectEverywhere(const std::string& rib, Color want, const std::string& what) {
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(rib, under(h, suspend));
            const Color c = s.one(kView);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c[k], want[k], 1e-5 * std::max(1.f, want[k]))
                    << what << ", hider " << int(h) << (suspend ? ", suspended" : "") << s.messages();
            // A lobe shadeop times what a loop brings is no sum of light: path has its direct part, and says so.
            const auto calls = [&](const char* shadeop) { return what.find(shadeop) != std::string::npos; };
            const bool product = calls("diffuse(n") || calls("specular(n") || calls("phong(n");
            EXPECT_EQ(s.diagnostics.warnings(), h == Hider::Path && product) << what << s.messages();
        }
}

struct Case {
    const char* body;
    float want;
};

TEST(NestedIlluminance, InnerLoopsHaveAllTheirLights) {
    writeLights();
    const Case cases[] = {
        {"illuminance(P) { color o = Cl; illuminance(P) Ci += o * Cl; }", 441},
        {"illuminance(P) { float m = 0; illuminance(P) m += height(L); Ci += m * Cl * height(L); }", 940},
        {"illuminance(P) { illuminance(P) { illuminance(P) Ci += Cl; Ci += 100 * Cl; } Ci += 10000 * Cl; }",
         9 * 21 + 3 * 2100 + 210000},
        {"illuminance(P) { color a = Cl; illuminance(P) { color b = Cl; illuminance(P) Ci += a * b * Cl; } }", 9261},
        // Of another category, another place, another cone.
        {"illuminance(\"a\", P) { illuminance(\"b\", P) Ci += Cl; Ci += 100 * Cl; }", 120},
        {"illuminance(\"b\", P) { color o = Cl; illuminance(\"a\", P) Ci += o * Cl; Ci += 100 * Cl; }", 2020},
        {"string which = \"b\"; if (xcomp(P) > 1e6) which = \"a\"; illuminance(which, P) { illuminance(P) Ci += Cl; Ci += 100 * "
         "Cl; }",
         42 + 2000},
        {"illuminance(P) { illuminance(P + up) Ci += height(L); Ci += 100 * height(L); }", 21 + 1000},
        {"illuminance(P, n, PI / 2) { illuminance(P, -n, PI / 2) Ci += Cl; Ci += Cl; }", 21},
        {"illuminance(P, -n, PI / 2) { illuminance(P, n, PI / 2) Ci += Cl; Ci += Cl; }", 0},
        {"illuminance(P) { illuminance(P, \"lightcache\", \"refresh\") Ci += Cl; Ci += 100 * Cl; }", 63 + 2100},
        {"illuminance(P, \"lightcache\", \"refresh\") { illuminance(P) Ci += Cl; Ci += 100 * Cl; }", 63 + 2100},
        // The shadeops over lights.
        {"illuminance(P) Ci += Cl * diffuse(n);", 441},
        {"illuminance(P) Ci += Cl * specular(n, up, .1);", 441},
        {"illuminance(P) Ci += Cl * phong(n, up, 10);", 441},
        {"illuminance(P) { color d = diffuse(n) + phong(n, up, 3); Ci += Cl * d * height(L); }", 94 * 42},
        {"illuminance(P) { illuminance(P) Ci += Cl * specularbrdf(normalize(L), n, up, .1); }", 63},
        // Functions with loops of their own.
        {"color all() { extern point P; color c = 0; illuminance(P) c += Cl; return c; } illuminance(P) Ci += Cl * all();", 441},
        {"color all() { extern point P; color c = 0; illuminance(P) c += Cl; return c; } color twice() { extern point P; color c "
         "= 0; illuminance(P) c += Cl * all(); return c; }"
         "illuminance(P) Ci += Cl * twice() + height(L) * all();",
         9261 + 210},
    };
    for (const Case& c : cases) {
        surfaceOf("nested", std::string("    ") + c.body);
        expectEverywhere(scene(three(), "\"nested\""), Color(c.want), c.body);
    }
}

TEST(NestedIlluminance, BreakContinueReturn) {
    writeLights();
    const Case cases[] = {
        {"illuminance(P) { illuminance(P) { if (comp(Cl, 0) > 3) break; Ci += Cl; } Ci += 100 * Cl; }", 3 + 2100},
        {"illuminance(P) { illuminance(P) { if (comp(Cl, 0) == 4) continue; Ci += Cl; } Ci += 100 * Cl; }", 51 + 2100},
        {"illuminance(P) { float h = height(L); illuminance(P) { if (h > 2.5) break 2; Ci += Cl; } Ci += 100 * Cl; }", 21 + 100},
        {"illuminance(P) { float h = height(L); illuminance(P) { if (h > 2.5 && h < 4) continue 2; Ci += Cl; } Ci += 100 * Cl; }",
         42 + 1700},
        {"illuminance(P) { illuminance(P) Ci += Cl; if (comp(Cl, 0) == 4) break; Ci += 100 * Cl; }", 42 + 100},
        {"illuminance(P) { illuminance(P) Ci += Cl; if (comp(Cl, 0) == 4) continue; Ci += 100 * Cl; }", 63 + 1700},
        {"color brighter(color than) { extern point P; illuminance(P) { if (comp(Cl, 0) > comp(than, 0)) return Cl; } return "
         "1000; } illuminance(P) Ci += brighter(Cl);",
         1020},
        {"color deep() { extern point P; illuminance(P) { color o = Cl; illuminance(P) { if (comp(o * Cl, 0) > 20) return o * "
         "Cl; } } return 1; } Ci = deep();",
         64}};
    for (const Case& c : cases) {
        surfaceOf("nestleaves", std::string("    ") + c.body);
        expectEverywhere(scene(three(), "\"nestleaves\""), Color(c.want), c.body);
    }
}

// What is asked about the light is about that of the innermost loop; after it about that of the loop around again.
TEST(NestedIlluminance, ParametersOfTheLight) {
    writeLights();
    const Case cases[] = {
        {"illuminance(P) { float d = 0, m = 0; illuminance(P, \"light:doubled\", d) m += d; lightsource(\"doubled\", d); Ci += m "
         "* d; }",
         42 * 42},
        {"float a = 0; illuminance(P, \"light:c\", a) { float b = 0; illuminance(P, \"light:h\", b) Ci += b; Ci += 100 * a; }",
         30 + 2100},
        {"illuminance(P) { float m = 0; illuminance(P) { if (islightcategory(\"b\") == 1) m += 1; } if (islightcategory(\"a\") "
         "== 1) Ci += m; }",
         2},
        {"illuminance(P) { float a = 0, b = 0; shader of = light; illuminance(P) { getvar(light, \"c\", a); b += a; } "
         "getvar(light, \"h\", a); Ci += a * b; getvar(of, \"c\", a); Ci += 1000 * a; }",
         21000 + 210},
        {"illuminance(P) { float m = 0; illuminance(P) { if (shadername(\"lightsource\") == \"nflat\") m += 1; } if "
         "(shadername(\"lightsource\") == \"nflat\") Ci += m; }",
         9}};
    for (const Case& c : cases) {
        surfaceOf("nestasks", std::string("    ") + c.body);
        expectEverywhere(scene(three(), "\"nestasks\""), Color(c.want), c.body);
    }
}

TEST(NestedIlluminance, SentParameters) {
    writeLights();
    const Case cases[] = {
        {"illuminance(P) { illuminance(P, \"send:light:c\", 5) Ci += Cl; Ci += 100 * Cl; }", 45 + 2100},
        {"illuminance(P, \"send:light:c\", 5) { illuminance(P) Ci += Cl; Ci += 100 * Cl; }", 63 + 1500},
        {"illuminance(P, \"send:light:c\", 5) { float s = 0; illuminance(P, \"send:light:c\", 7) Ci += Cl; lightsource(\"c\", "
         "s); Ci += 100 * s; lightsource(\"doubled\", s); Ci += 1000 * s; }",
         63 + 1500 + 30000},
        // A loop of which nobody wants the result leaves nothing for the next one.
        {"float x = 0; illuminance(P, \"send:light:c\", 5) x += comp(Cl, 0); illuminance(P) Ci += Cl;", 21},
        {"float x = 0; illuminance(P) { illuminance(P, \"send:light:c\", 5) x += comp(Cl, 0); illuminance(P) Ci += Cl; }", 63}};
    for (const Case& c : cases) {
        surfaceOf("nestsends", std::string("    ") + c.body);
        expectEverywhere(scene(three(), "\"nestsends\""), Color(c.want), c.body);
    }
}

// Points of one strip are in the cones of different lights, in the outer loop and in the inner one.
TEST(NestedIlluminance, EachPointHasItsLights) {
    writeShader("nhalf", R"(light nhalf(float c = 1, side = 1;) {
    illuminate(point "world" (0, 2, 0)) Cl = side * xcomp(transform("world", Ps)) > 0 ? c : 0;
}
)");
    surfaceOf("nesteach", R"(
    float x = xcomp(transform("world", P));
    illuminance(P, x > 1 ? up : -up, PI / 2) {
        color o = Cl;
        illuminance(P, abs(x) < 2 ? up : -up, PI / 2) Ci += o * Cl;
        Ci += 1000 * Cl;
    }
    illuminance(P) { if (x > 0) illuminance(P) Ci += .5; Ci += 1e-2 * Cl; })");
    const std::string lights = "LightSource \"nhalf\" 1 \"c\" 3\nLightSource \"nhalf\" 2 \"c\" 5 \"side\" -1\n";
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(scene(lights, "\"nesteach\""), under(h, suspend));
            std::vector<CameraRay> rays;
            for (int i = -30; i < 30; ++i) rays.push_back(rayTo({i * .1f + .05f, 2, 0}, {i * .1f + .05f, 0, 0}));
            auto r = s.trace(rays);
            for (int i = -30; i < 30; ++i) {
                const float x = i * .1f + .05f, cl = x > 0 ? 3 : 5;
                const float want = (x > 1 ? 1000 * cl + (x < 2 ? cl * cl : 0) : 0) + (x > 0 ? 2 : 0) + 1e-2f * cl;
                EXPECT_NEAR(r[size_t(i + 30)].color.x, want, 1e-5f * std::max(1.f, want)) << x << s.messages();
            }
        }
}

TEST(NestedIlluminance, MethodsOfCoShaders) {
    writeLights();
    writeShader("nestlayer", R"(class nestlayer(float gain = 1;) {
    public void add(output color c; color by; string cat) { extern point P; illuminance(cat, P) { c += gain * by * Cl; } }
    public void deeper(output color c; color by;) { extern point P; illuminance("b", P) { add(c, by * Cl, "a"); } }
}
)");
    // 3 (1 * 20 + 4 * 1 + 16 * 1) is what the loops over "a" and "b" give, then 3 * 21 * 20 * 1, and the light of the outer loop.
    surfaceOf("nestcalls", R"(
    shader l = getshader("layer");
    illuminance(P) {
        if (islightcategory("a") == 1) l->add(Ci, Cl, "b"); else l->add(Ci, Cl, "a");
        l->deeper(Ci, Cl);
        Ci += 10000 * height(L);
    })");
    expectEverywhere("WorldBegin\nSides 2\n" + three() +
                         "Shader \"nestlayer\" \"layer\" \"float gain\" 3\nSurface \"nestcalls\"\n" + kFloor + "WorldEnd\n",
                     Color(3 * 40 + 3 * 420 + 100000), "co-shader");
}

// Rays of the shader in both loops; a roof at 4 hides the third light where shadows count.
TEST(NestedIlluminance, ShadersThatWait) {
    writeLights();
    const std::string roof =
        "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [-1 4 -1  -1 4 1  1 4 1  1 4 -1]\nAttributeEnd\n";
    const Case cases[] = {
        {"illuminance(P) { color t = transmission(P, P + L), o = Cl; illuminance(P) Ci += t * o * Cl * transmission(P, P + L); }",
         25},
        {"illuminance(P) { color t = 0; illuminance(P) { color seen = transmission(P, P + L); t += seen * Cl; } Ci += t * "
         "height(L) * transmission(P, P + L); }",
         25},
        {"color all() { extern point P; color c = 0; illuminance(P) { if (comp(trace(P, normalize(L)), 0) > 7) c += 1000; c += "
         "Cl * transmission(P, P + L); } return c; }"
         "illuminance(P) { color a = all(); float d = 0; lightsource(\"doubled\", d); Ci += a * d * transmission(P, P + L); }",
         50}};
    for (const Case& c : cases) {
        surfaceOf("nestwaits", std::string("    ") + c.body);
        expectEverywhere(scene(three() + roof, "\"nestwaits\""), Color(c.want), c.body);
    }
    // Under path the light of a loop has its shadows without being asked.
    const Case shadowed[] = {{"illuminance(P) { color o = Cl; illuminance(P) Ci += o * Cl; }", 25},
                             {"illuminance(P) { illuminance(P) Ci += Cl; Ci += 100 * Cl; }", 15 + 500},
                             {"illuminance(P) Ci += Cl * diffuse(n);", 25}};
    for (const Case& c : shadowed)
        for (bool suspend : {false, true}) {
            surfaceOf("nestshadowed", std::string("    ") + c.body);
            EXPECT_NEAR(Scene(scene(three() + roof, "\"nestshadowed\""), under(Hider::Path, suspend)).one(kView).x, c.want,
                        1e-5 * c.want)
                << c.body;
        }
    // Strips that wait in an inner loop keep both loops while others run theirs.
    surfaceOf("neststrips", R"(
    float x = xcomp(transform("world", P));
    illuminance(P, "send:light:c", x) {
        float c = 0, m = 0;
        illuminance(P, "send:light:c", 2 * x) {
            color t = trace(P, up);
            if (comp(t, 0) > .5) Ci += 1000;
            lightsource("c", c);
            m += c;
        }
        lightsource("c", c);
        Ci += c + .01 * m;
    })");
    Scene s(scene(flat(1, 1, 2) + flat(2, 1, 3), "\"neststrips\""), under(Hider::Hidden));
    std::vector<CameraRay> rays;
    for (int i = 0; i < 300; ++i) rays.push_back(rayTo({float(i) * .1f, 2, 0}, {float(i) * .1f, 0, 0}));
    auto r = s.trace(rays);
    for (int i = 0; i < 300; ++i) EXPECT_NEAR(r[size_t(i)].color.x, (2 + .08f) * i * .1f, 2e-4 * (1 + i * .1f)) << i;
}

// Half of the area is dark: the product of two loops over few samples is the square of the mean only where the loops have samples
// of their own.
TEST(NestedIlluminance, SamplesOfAreaLights) {
    writeShader("nhalfdark", "light nhalfdark() { illuminate(P, N, PI / 2) Cl = xcomp(transform(\"world\", P)) > 0 ? 8 : 0; }\n");
    surfaceOf("nestarea", "    illuminance(P, n, PI / 2) { color o = Cl * (normalize(L) . n); illuminance(P, n, PI / 2) Ci += o "
                          "* Cl * (normalize(L) . n); }");
    surfaceOf("nestturns",
              "    illuminance(P) { vector l = L; color c = Cl; illuminance(P) Ci += 1; if (l == L && c == Cl) Ci += 100; }");
    surfaceOf("nesthandle", R"(    shader all[] = getlights();
    illuminance(P, n, PI / 2) {
        color o = Cl * (normalize(L) . n), c = 0;
        vector l = 0;
        all[0]->light(l, c);
        Ci += o * c * (normalize(-l) . n);
    })");
    const auto disk = [](const std::string& shader, int samples) {
        return "AttributeBegin\nAttribute \"light\" \"integer samples\" [" + std::to_string(samples) +
               "]\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"" + shader +
               "\" 7\nSurface \"constant\"\nColor 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 "
               "360\nAttributeEnd\nIlluminate 7 1\n";
    };
    const float once = 4 * .49f / 4.49f;
    for (int n : {1, 4})
        for (Hider h : {Hider::Hidden, Hider::Path})
            for (const char* surface : {"\"nestarea\"", "\"nesthandle\""})
                expectMean(Scene(scene(disk("nhalfdark", n), surface), under(h)).estimate(kView, samples(6000)), once * once, .04,
                           surface + std::string(", samples ") + std::to_string(n));
    for (bool suspend : {false, true})
        EXPECT_EQ(Scene(scene(disk("slrect", 6), "\"nestturns\""), under(Hider::Hidden, suspend)).one(kView).x, 636);
}

// The lights of generateSamples() are turns, as many as they send.
TEST(NestedIlluminance, SamplesThatLightsSend) {
    writeShader("nsends", R"(class nsends(uniform float n = 3) {
        public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
            uniform float i;
            resize(samples, n);
            for (i = 0; i < n; i += 1) {
                vector to = point "world" (0, 2 + i, 0) - Ps;
                samples[i]->direction = normalize(to);
                samples[i]->distance = length(to);
                samples[i]->setLightRadiance(PI * (1 + i), n);
            }
        }
    }
)");
    // Cl is that of diffuse(): a light at a point shows as itself on white. Turns, and the heights of the outer loop after the
    // inner one.
    surfaceOf("nestsent", "    illuminance(P) { color c = Cl; float m = 0; illuminance(P + up) m += height(L); if (c == Cl) Ci "
                          "+= m * height(L); }");
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(scene("LightSource \"nsends\" 1\n", "\"nestsent\""), under(h, suspend));
            EXPECT_NEAR(s.one(kView).x, (1 + 2 + 3) * (2 + 3 + 4), 1e-4) << s.messages();
        }
}

TEST(NestedIlluminance, LightsByTheirHandles) {
    writeLights();
    const Case cases[] = {{"shader all[] = getlights(); illuminance(P) { vector l = 0; color c = 0; all[1]->light(l, c); Ci += c "
                           "* Cl; illuminance(P) Ci += 100; Ci += 1000 * height(L); }",
                           84 + 900 + 10000},
                          {"shader all[] = getlights(); illuminance(P) { uniform float i; float m = 0; for (i = 0; i < "
                           "arraylength(all); i += 1) { vector l = 0; color c = 0; all[i]->light(l, c); m -= height(l); }"
                           "Ci += m * Cl; }",
                           -1}};
    for (const Case& c : cases) {
        surfaceOf("nesthandles", std::string("    ") + c.body);
        // l points from the light: its height is minus that of the light above the floor
        expectEverywhere(scene(three(), "\"nesthandles\""), Color(c.want < 0 ? 210 : c.want), c.body);
    }
}

TEST(NestedIlluminance, InVolumes) {
    writeLights();
    writeShader("nestair", "volume nestair() { color sum = 0; illuminance(P) { color o = Cl; illuminance(P) sum += o * Cl; sum "
                           "+= 1000 * Cl; } Ci = sum; Oi = 1; }\n");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        Scene s("WorldBegin\nSides 2\n" + three() + "Atmosphere \"nestair\"\nSurface \"constant\"\n" + kFloor + "WorldEnd\n",
                under(h));
        EXPECT_NEAR(s.one(kView).x, 441 + 21000, .3) << s.messages();
    }
}

// Lights see the outputs of the surface as they are where their loop begins.
TEST(NestedIlluminance, OutputsOfTheSurfaceAreReadByLights) {
    writeShader("nreads",
                R"(light nreads() {
    illuminate(point "world" (0, 2, 0)) { float strength = 1; surface("strength", strength); Cl = strength; }
}
)");
    surfaceOf("nestread",
              "    strength = 3; illuminance(P) { color o = Cl; strength = 5; illuminance(P) Ci += Cl; Ci += 100 * Cl; }",
              "output varying float strength = 0;");
    expectEverywhere(scene("LightSource \"nreads\" 1\nLightSource \"nreads\" 2\n", "\"nestread\""), Color(20 + 600), "outputs");
}

} // namespace

} // namespace nestedlights_test
