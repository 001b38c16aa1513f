// Renders RIB text from C++, one camera ray at a time, and keeps means with their standard errors.
// The unit of statistics is a random stream of its own for every sample (testing rule 7): each sample gets a pixel of its own.
#pragma once
#include "integrator/integrator.h"
#include "ri/reader.h"
#include "scene/scene.h"
#include "statistics/agreement.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

namespace alpenglow::integrator::testing {

inline constexpr double kZ = teststat::kZ;

using teststat::chosen, teststat::nightly, teststat::samples, teststat::seedBase;

/// A folder for shaders that a test writes itself. Gone when the program ends.
inline const std::string& shaderFolder() {
    struct Folder {
        std::string path = ::testing::TempDir() + "alpenglow_transport_" + std::to_string(getpid());
        const pid_t owner = getpid(); ///< death tests and others that fork share it, and leave it alone
        Folder() { std::filesystem::create_directories(path); }
        ~Folder() {
            std::error_code e;
            if (getpid() == owner) std::filesystem::remove_all(path, e);
        }
    };
    static const Folder folder;
    return folder.path;
}
inline void writeShader(const std::string& name, const std::string& source) {
    std::ofstream(shaderFolder() + "/" + name + ".sl") << source;
}

struct Moments {
    double n = 0, s[3] = {}, q[3] = {};
    void add(const Color& c) {
        ++n;
        for (int k = 0; k < 3; ++k) {
            s[k] += c[k];
            q[k] += double(c[k]) * c[k];
        }
    }
    void add(const Moments& o) {
        n += o.n;
        for (int k = 0; k < 3; ++k) s[k] += o.s[k], q[k] += o.q[k];
    }
    double mean(int k = 0) const { return s[k] / n; }
    /// Standard error of the mean.
    double se(int k = 0) const { return std::sqrt(std::max(0.0, (q[k] / n - mean(k) * mean(k)) / (n - 1))); }
    /// (sum x)^2 / sum x^2 (testing rule 6).
    double effective(int k = 0) const { return q[k] > 0 ? s[k] * s[k] / q[k] : 0; }
};

/// A frame ready to be traced, with its messages.
struct Scene final : scene::FrameConsumer {
    Diagnostics diagnostics;
    std::shared_ptr<const scene::Frame> frame;
    std::shared_ptr<const World> world;

    /// `errors`: messages of that severity that the scene is known to cause.
    Scene(const std::string& rib, Settings settings = {}, int errors = 0) {
        ri::RibReader reader({}, *this, diagnostics);
        reader.readMemory(rib, "test.rib");
        settings.shaderPaths.push_back(shaderFolder());
        settings.seed += seedBase();
        if (frame) world = buildWorld(frame, settings, diagnostics);
        EXPECT_NE(world, nullptr) << messages();
        EXPECT_EQ(diagnostics.errors(), errors) << messages() << rib;
    }
    /// Attribute "user" "float[2] level" is what render/levels.h finds of the levels of detail of a scene.
    void render(std::shared_ptr<const scene::Frame> f) override {
        auto own = std::make_shared<scene::Frame>(*f);
        for (scene::PrimitiveRef& p : own->primitives) {
            const scene::Param* level = p->attributes ? p->attributes->value("user:level") : nullptr;
            if (!level || level->numbers.size() != 2) continue;
            auto attributes = std::make_shared<scene::Attributes>(*p->attributes);
            attributes->level = {level->numbers[0], level->numbers[1]};
            auto other = std::make_shared<scene::Primitive>(*p);
            other->attributes = std::move(attributes);
            p = std::move(other);
        }
        frame = std::move(own);
    }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
    std::string messages() const {
        std::string s;
        for (const Diagnostic& d : diagnostics.all()) s += toString(d);
        return s;
    }

    std::vector<SampleResult> trace(std::span<const CameraRay> rays, Counters* counters = nullptr) {
        std::vector<SampleResult> out(rays.size());
        Integrator i(world, diagnostics);
        EXPECT_TRUE(i.trace(rays, out, nullptr));
        if (counters) *counters += i.counters();
        return out;
    }
    /// n independent samples of one ray.
    Moments estimate(CameraRay ray, int n, Counters* counters = nullptr) {
        Moments m;
        std::vector<CameraRay> rays;
        for (int i = 0; i < n; ++i) {
            ray.px = i % 8192;
            ray.py = i / 8192;
            ray.sample = 0;
            rays.push_back(ray);
            if (rays.size() == 8192 || i + 1 == n) {
                for (const SampleResult& r : trace(rays, counters)) m.add(r.color);
                rays.clear();
            }
        }
        return m;
    }
    Color one(const CameraRay& ray) { return trace({&ray, 1})[0].color; }
};

/// From `eye` toward `at`, both in camera space.
inline CameraRay rayTo(Vec3 eye, Vec3 at) {
    CameraRay r;
    r.origin = eye;
    r.direction = normalize(at - eye);
    r.cosine = r.direction.z;
    return r;
}

/// The mean agrees with an exact value, and is precise enough to say so: the standard error is below `precision` of the value.
inline void expectMean(const Moments& m, double want, double precision, const std::string& what) {
    double rounding = 2e-6 * std::fabs(want);
    EXPECT_LE(std::max(0.0, std::fabs(m.mean() - want) - rounding), kZ * m.se())
        << what << ": " << m.mean() << " +- " << m.se() << ", exact " << want;
    EXPECT_LE(m.se(), precision * std::fabs(want) + 1e-12) << what << ": not precise enough to decide";
}

inline std::string readText(const std::string& path) {
    std::ifstream f(path);
    std::stringstream s;
    s << f.rdbuf();
    return s.str();
}

} // namespace alpenglow::integrator::testing
