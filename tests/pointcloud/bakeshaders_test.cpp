// What displacement, light and Atmosphere shaders bake, against closed forms at each point.
#include "cli/command_folder.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/make.h"

namespace bakeshaders_test {

namespace {

using namespace alpenglow;

class BakeShaders : public cli::testing::CommandFolder {
protected:
    pointcloud::PointCloud cloud(const std::string& name) const {
        Diagnostics d;
        auto c = pointcloud::loadCloud((dir / name).string(), d);
        EXPECT_TRUE(c) << pointcloud::test::said(d);
        return c ? std::move(*c) : pointcloud::PointCloud{};
    }
    /// Renders a square in the plane z = 4 of the world, half of it beyond the picture.
    void render(const std::string& hider, const std::string& world) {
        write("a.rib", "Format 24 24 1\nPixelSamples 2 2\nHider \"" + hider +
                           "\"\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\" \"fov\" 40\nWorldBegin\n" +
                           world + "\nPolygon \"P\" [-1 -1 4  5 -1 4  5 1 4  -1 1 4]\nWorldEnd\n");
        const std::string said = run("render a.rib", "2>&1");
        EXPECT_EQ(said.find("error: "), std::string::npos) << said;
        EXPECT_EQ(said.find("warning: "), std::string::npos) << said;
        EXPECT_EQ(status, 0) << said;
    }
    float area(const pointcloud::PointCloud& c) const {
        double sum = 0;
        for (size_t i = 0; i < c.size(); ++i) sum += double(c.valuesOf(i)[size_t(c.offsetOf("_area"))]);
        return float(sum);
    }
};

// It lifts the square by x: the points lie on a slope, and what is written is where they were.
TEST_F(BakeShaders, Displacement) {
    write("lifts.sl", "displacement lifts() { float x = xcomp(transform(\"world\", P)); P -= vector \"world\" (0, 0, .25) * x; "
                      "bake3d(\"d.ptc\", \"\", P, N, \"_x\", x); bake(\"d.bake\", s, t, x); }\n");
    for (const char* hider : {"hidden", "path"}) {
        render(hider, "Attribute \"displacementbound\" \"float sphere\" [2] Surface \"constant\" Displacement \"lifts\"");
        const pointcloud::PointCloud c = cloud("d.ptc");
        ASSERT_GT(c.size(), 100u) << hider;
        float far = 0;
        for (size_t i = 0; i < c.size(); ++i) {
            const float x = c.valuesOf(i)[size_t(c.offsetOf("_x"))];
            EXPECT_NEAR(c.P[i].x, x, 1e-4);
            EXPECT_NEAR(c.P[i].z, 4 - x / 4, 1e-4);
            far = std::max(far, x);
        }
        EXPECT_NEAR(far, 5, 1e-4) << "the whole of it, seen or not";
        EXPECT_NEAR(area(c), 12 * std::sqrt(1 + 1. / 16), .01) << hider;
        EXPECT_TRUE(std::filesystem::exists(dir / "d.bake"));
        std::filesystem::remove(dir / "d.ptc");
    }
}

// Two lamps of one shader: each has its own point at every place of the grid, with what arrives from it.
TEST_F(BakeShaders, Lights) {
    write("lamp.sl",
          "light lamp(float power = 1; point from = 0;) { illuminate(from) Cl = power / (L . L); float d = distance(Ps, from); "
          "float ok = bake3d(\"l.ptc\", \"\", Ps, Ns, \"_e\", power / (d * d), \"_power\", power); }\n");
    for (const char* hider : {"hidden", "path"}) {
        render(hider, "LightSource \"lamp\" 1 \"power\" 2 \"from\" [0 0 1] LightSource \"lamp\" 2 \"power\" 3 \"from\" [4 0 2]\n"
                      "Surface \"matte\"");
        const pointcloud::PointCloud c = cloud("l.ptc");
        ASSERT_GT(c.size(), 200u) << hider;
        size_t first = 0;
        const size_t e = size_t(c.offsetOf("_e")), power = size_t(c.offsetOf("_power"));
        for (size_t i = 0; i < c.size(); ++i) {
            EXPECT_NEAR(c.P[i].z, 4, 1e-4);
            const bool one = c.valuesOf(i)[power] == 2;
            first += one;
            const Vec3 way = c.P[i] - (one ? Vec3(0, 0, 1) : Vec3(4, 0, 2));
            EXPECT_NEAR(c.valuesOf(i)[e], (one ? 2 : 3) / dot(way, way), 1e-5) << hider;
        }
        EXPECT_EQ(2 * first, c.size()) << hider;
        EXPECT_NEAR(area(c), 2 * 12, .01) << hider;
        std::filesystem::remove(dir / "l.ptc");
    }
}

// The way from the eye, once at each point, whether the compiler knows what the volume makes of light or tries it.
TEST_F(BakeShaders, Atmospheres) {
    const std::string bakes = "float d = length(I); bake3d(\"v.ptc\", \"\", P, N, \"_d\", d, \"_c\", comp(Ci, 0));";
    write("mist.sl", "volume mist() { " + bakes + " Ci = Ci * exp(-d); }\n");
    write("bent.sl", "volume bent() { " + bakes + " Ci = Ci * Ci; }\n");
    for (const char* shader : {"mist", "bent"})
        for (const char* hider : {"hidden", "path"}) {
            render(hider, "Atmosphere \"" + std::string(shader) + "\" Surface \"constant\" Color .5 .5 .5");
            const pointcloud::PointCloud c = cloud("v.ptc");
            ASSERT_GT(c.size(), 100u) << hider;
            for (size_t i = 0; i < c.size(); ++i) {
                EXPECT_NEAR(c.valuesOf(i)[size_t(c.offsetOf("_d"))], length(c.P[i]), 1e-4) << shader << hider;
                EXPECT_EQ(c.valuesOf(i)[size_t(c.offsetOf("_c"))], .5f) << shader << hider;
            }
            EXPECT_NEAR(area(c), 12, .01) << shader << hider;
            std::filesystem::remove(dir / "v.ptc");
        }
}

// Calls behind a condition that is false for the whole primitive: no more than a few points are shaded for them. Where it is true
// all are.
TEST_F(BakeShaders, BehindConditions) {
    const auto shader = [&](const std::string& condition) {
        const std::string bakes = "if (" + condition + ") bake3d(\"c.ptc\", \"\", ";
        write("lamp.sl", "light lamp(float bake = .3;) { " + bakes + "Ps, Ns); solar(vector \"world\" (0, 0, 1), 0) Cl = 1; }\n");
        write("mist.sl", "volume mist(float bake = .3;) { " + bakes + "P, N); Ci *= .5; }\n");
    };
    const auto points = [&](const std::string& hider, const std::string& world) {
        std::filesystem::remove(dir / "c.ptc");
        write("a.rib", "Format 24 24 1\nPixelSamples 2 2\nHider \"" + hider +
                           "\"\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nProjection \"perspective\" \"fov\" 40\nWorldBegin\n" +
                           world + "\nPolygon \"P\" [-1 -1 4  5 -1 4  5 1 4  -1 1 4]\nWorldEnd\n");
        run("render -q --stats a.json a.rib", "2>&1");
        std::ifstream f(dir / "a.json");
        const std::string stats{std::istreambuf_iterator<char>(f), {}};
        return std::atoi(stats.c_str() + stats.find("\"points\":") + 9);
    };
    for (const char* hider : {"hidden", "path"})
        for (const std::string world : {"LightSource \"lamp\" 1 Surface \"matte\"", "Atmosphere \"mist\" Surface \"constant\""}) {
            shader("0");
            const int none = points(hider, world);
            shader("bake > .5");
            EXPECT_LE(points(hider, world), none + 60) << hider << world;
            EXPECT_FALSE(std::filesystem::exists(dir / "c.ptc")) << hider << world;
            shader("bake > .2");
            EXPECT_GT(points(hider, world), none + 60) << hider << world;
            EXPECT_GT(cloud("c.ptc").size(), 100u) << hider << world;
            shader("xcomp(transform(\"world\", " + std::string(world[0] == 'L' ? "Ps" : "P") + ")) > 4");
            points(hider, world); // where the few points may not be
            EXPECT_GT(cloud("c.ptc").size(), 10u) << hider << world;
        }
    // A light that is not run at these few points may bake at others: one that shines on the right part alone.
    write("lamp.sl",
          "light lamp(float bake = .3;) { if (bake > .2) bake3d(\"c.ptc\", \"\", Ps, Ns); solar(vector \"world\" (0, 0, 1), 0) "
          "Cl = 1; }\n");
    write("part.sl", "surface part() { Oi = 1; Ci = 0; if (xcomp(transform(\"world\", P)) > 4) Ci = diffuse(normalize(N)); }\n");
    points("hidden", "LightSource \"lamp\" 1 Surface \"part\"");
    EXPECT_GT(cloud("c.ptc").size(), 10u);
}

// An imager has no point: that is said.
TEST_F(BakeShaders, NotImagers) {
    write("stamps.sl",
          "imager stamps() { float ok = bake3d(\"i.ptc\", \"\", P, normal(0, 0, 1), \"_x\", 1); Ci = color(ok); }\n");
    write("a.rib", "Format 4 4 1\nDisplay \"a.exr\" \"openexr\" \"rgba\"\nImager \"stamps\"\nWorldBegin\nWorldEnd\n");
    EXPECT_NE(run("render a.rib", "2>&1").find("bake3d() has no effect in imager shaders"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(dir / "i.ptc"));
}

} // namespace

} // namespace bakeshaders_test
