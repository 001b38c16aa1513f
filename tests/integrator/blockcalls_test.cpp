// Calls of shaders whose requests are read in rows (integrator/loberequests.h): depths of surfaces, loops, subsurface(),
// parameters of trace(), wide lights, all lobes.
#include "integrator/blockrooms.h"

namespace blockcalls_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

TEST(BlockCalls, FollowLobesToTheDepthsOfTheirSurfaces) {
    writeShader("two", R"(surface two() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.4 * diffuse(n) + .3 * specular(n, -normalize(I), .3) + .2 * trace(P, reflect(normalize(I), n)));
    Oi = Os;
})");
    const std::string sky = "LightSource \"envlight\" 9 \"intensity\" .3\n", clear = "Opacity .5 .6 .7\n";
    const std::string fog = "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2]\n"
                            "Translate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";
    const std::string matte = "AttributeBegin\nMatte 1\nSurface \"two\"\nTranslate .3 .2 3\nSphere .5 -.5 .5 360\nAttributeEnd\n";
    for (const std::string& more : {sky, clear + sky, fog, matte})
        for (const auto& [diffuse, specular] : {std::pair(0, 0), {1, 0}, {0, 2}, {2, -1}, {-1, 1}}) {
            const std::string rib = roomOf("\"two\"", "Attribute \"trace\" \"int maxdiffusedepth\" " + std::to_string(diffuse) +
                                                          " \"int maxspeculardepth\" " + std::to_string(specular) + "\n" + more);
            expectSameBits(rib, pathSettings(), .3, more + std::to_string(diffuse) + std::to_string(specular));
        }
}

TEST(BlockCalls, FollowLoopsAndWalksBelowSurfaces) {
    // Turns without a weight, of different number at neighbouring points, with lights and without.
    writeShader("turns", R"(surface turns() {
    normal n = faceforward(normalize(N), I);
    color sum = .2 * diffuse(n);
    float i, many = 1 + mod(floor(40 * u), 3);
    for (i = 0; i < many; i += 1) {
        float w = mod(floor(30 * v) + i, 3) * .12;
        sum += w * specular(n, -normalize(I), .1 + .1 * i);
        sum += .1 * trace(P, reflect(normalize(I), normalize(n + .1 * i * vector(xcomp(P), 1, 0))), "samplecone", .1 * i);
    }
    Ci = Cs * sum;
})");
    writeShader("milky", R"(surface milky() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * subsurface(P, n, "scattering", color(20, 30, 40), "absorption", color(.5, .2, .1), "ior", 1.3)
         + .2 * specular(n, -normalize(I), .2);
    Oi = Os;
})");
    writeShader("apart2", R"(surface apart2() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.6 * diffuse(n) + .1 * specular(n, -normalize(I), .2));
    if (mod(floor(9 * u), 3) > 0) Ci += mod(floor(9 * v), 2) * .5 * Cs * indirectdiffuse(P, n, 4);
})");
    writeShader("near", R"(surface near() {
    normal n = faceforward(normalize(N), I);
    float some = mod(floor(9 * u), 3);
    Ci = Cs * (.3 * diffuse(n)
       + .3 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "bias", .05 * some, "maxdist",
                    1 + 2 * v)
       + .2 * trace(P, reflect(normalize(I), n), "samplecone", .2, "samplearealights", 1, "maxdist", 2, "weight", color(some))
       + .1 * trace(P, n, "distribution", "oren-nayar", "samplelights", 1, "maxdist", length(P - point(1, 2, 3)))
       + .2 * indirectdiffuse(P, n, 4, "maxdist", 3, "falloff", some, "bias", .01));
})");
    writeShader("away", R"(surface away() {
    normal n = faceforward(normalize(N), I);
    float some = mod(floor(9 * u), 2);
    Ci = .3 * Cs * diffuse(n) + .4 * trace(P + .1 * some * n, vector n, "samplecone", 1, "samplearealights", 1, "samples", 2)
         + .2 * trace(P + .1 * some * n, reflect(normalize(I), n));
})");
    const std::string sky = "LightSource \"envlight\" 9 \"intensity\" .3\n";
    // Points in fog and exits of walks use the rows of earlier batches again.
    const std::string fog = "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2]\n"
                            "Translate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";
    const std::string shallow = "Attribute \"trace\" \"int maxdiffusedepth\" 1 \"int maxspeculardepth\" 1\n";
    Settings local = pathSettings();
    local.localRoulette = true;
    size_t turn = 0; // not nightly: a third of shader, scene and setting, each of them several times
    for (const char* shader : {"\"turns\"", "\"milky\"", "\"apart2\"", "\"near\"", "\"away\""})
        for (const std::string& more : {std::string(), sky, shallow, sky + "Opacity .5 .6 .7\n", fog})
            for (const Settings& s : {pathSettings(), local}) {
                if (!chosen(turn++, 3)) continue;
                expectSameBits(roomOf(shader, more), s, .3, shader + more);
            }
}

TEST(BlockCalls, SampleLightsThatFilterOverTheirSurfaceOrReadN) {
    writeShader("filters", R"(light filters(float intensity = 3) {
    illuminate(P, N, PI / 2) Cl = intensity * (.2 + min(10 * area(P), 1)) * filterstep(.5, mod(9 * s, 1));
})");
    writeShader("facing", R"(light facing(float intensity = 4) {
    illuminate(Ps + shadingnormal(N)) Cl = intensity * (1 + xcomp(normalize(N)));
})");
    writeFacets();
    const std::string facing = "LightSource \"facing\" 78\n";
    const std::string lamp =
        "AttributeBegin\nAreaLightSource \"filters\" 77\nSurface \"constant\"\nColor 0 0 0\n"
        "Polygon \"P\" [-1 2.4 4  1 2.4 4  1 2.4 6  -1 2.4 6] \"st\" [0 0  1 0  1 1  0 1]\nAttributeEnd\nIlluminate 77 1\n";
    const std::string fog = "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2]\n"
                            "Translate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";
    for (const std::string& more : {lamp, facing, lamp + fog, facing + fog, lamp + manyLights(6), facing + manyLights(6)}) {
        const bool apart = more.find("__importancesample") != std::string::npos;
        expectSameBits(roomOf("\"facets\"", more), pathSettings(), apart ? -1 : .3, more);
    }
}

TEST(BlockCalls, FollowAllLobesUnderOtherHiders) {
    writeShader("several", R"(surface several() {
    normal n = faceforward(normalize(N), I);
    float i, some = 1 + mod(floor(9 * u), 3);
    color sum = .3 * diffuse(n) + .2 * specular(n, -normalize(I), .2);
    for (i = 0; i < some; i += 1)
        sum += .1 * trace(P, reflect(normalize(I), n), "samplecone", .1 * i, "samples", 3 * some, "maxdist", 2 + i);
    Ci = Cs * (sum + .3 * trace(P, n, "distribution", "ggx", "roughness", .3, "wo", -I) + .2 * indirectdiffuse(P, n, 5));
    Oi = Os;
})");
    writeShader("waiting", R"(surface waiting() {
    normal n = faceforward(normalize(N), I);
    color c = trace(P, reflect(normalize(I), n));
    Ci = comp(c, 0) > .1 ? color(1) : .5 * c + .2 * diffuse(n);
})");
    const std::string sky = "LightSource \"envlight\" 9 \"intensity\" .3\n", clear = "Opacity .5 .6 .7\n";
    const std::string shallow = "Attribute \"trace\" \"int maxdiffusedepth\" 1 \"int maxspeculardepth\" 1\n";
    const std::string fog = "Atmosphere \"fog\" \"distance\" 9 \"background\" [.3 .2 .1]\n";
    for (const Hider hider : {Hider::Hidden, Hider::Raytrace})
        for (const char* shader : {"\"several\"", "\"waiting\""})
            for (const std::string& more : {sky, clear, shallow + sky, fog}) {
                Settings s;
                s.hider = hider;
                s.maxDepth = 3;
                expectSameBits(roomOf(shader, more), s, .25, shader + more + std::to_string(int(hider)), 3);
            }
}

} // namespace blockcalls_test
