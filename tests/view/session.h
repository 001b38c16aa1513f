// A view without its page, of a scene in a folder of its own.
#pragma once
#include "display/imageio.h"
#include "scene/scene.h"
#include "view/session.h"
#include <atomic>
#include <condition_variable>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <mutex>

namespace session_test {
using namespace alpenglow;
using namespace alpenglow::view;
using Json = nlohmann::json;

inline const char* const kScene = "Display \"x.exr\" \"openexr\" \"rgba\"\nFormat 40 30 1\nPixelFilter \"box\" 1 1\nHider "
                                  "\"path\"\nProjection \"perspective\" \"fov\" 40\n"
                                  "Translate 0 0 5\nWorldBegin\n"
                                  "LightSource \"pointlight\" \"key\" \"from\" [2 3 -4] \"intensity\" 20\n"
                                  "LightSource \"distantlight\" \"fill\" \"to\" [1 0 1] \"intensity\" 0.3\n"
                                  "Surface \"matte\" \"Kd\" 0.5\nSphere 1 -1 1 360\n"
                                  "Surface \"plastic\"\nTranslate 0 -1.5 0\nSphere 1 -1 1 360\nWorldEnd\n";

class ViewSession : public ::testing::Test {
protected:
    std::filesystem::path dir, before;
    std::string scene = kScene;
    std::mutex mutex;
    std::condition_variable changed;
    std::unique_ptr<Session> session;
    std::vector<std::string> said;
    std::atomic<bool> noMemory{false};
    StopFlag stop{0};

    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-view-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
        before = std::filesystem::current_path();
        std::filesystem::current_path(dir);
    }
    void TearDown() override {
        session.reset();
        std::filesystem::current_path(before);
        std::filesystem::remove_all(dir);
    }
    static void write(const std::string& name, const std::string& text) { std::ofstream(name, std::ios::binary) << text; }
    bool open(bool watch = false, Json wishes = {{"continuous", false}, {"spp", 8}}) {
        write("s.rib", scene);
        ViewOptions o;
        o.settings.threads = 2;
        o.settings.shippedShaders = ALPENGLOW_SOURCE_DIR "/shaders";
        o.settings.quiet = true;
        o.scene = "s.rib";
        o.watch = watch;
        o.settings.stop = &stop;
        o.read = [this](ri::RibReader& r) {
            if (noMemory) throw std::bad_alloc();
            r.nextScene();
            r.readFile("s.rib");
        };
        o.print = [this](const Diagnostic& d) { said.push_back(toString(d)); };
        session = std::make_unique<Session>(std::move(o), [this] {
            std::lock_guard lock(mutex);
            changed.notify_all();
        });
        if (!session->load()) return false;
        set(std::move(wishes));
        session->start();
        return true;
    }
    void set(Json wishes) { EXPECT_EQ(session->act({{"do", "set"}, {"wishes", std::move(wishes)}}), Json({{"ok", true}})); }
    /// Waits until it is so, a minute at most.
    template <class Condition> bool until(Condition c) {
        std::unique_lock lock(mutex);
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (true) {
            lock.unlock();
            if (c()) return true;
            lock.lock();
            if (std::chrono::steady_clock::now() > end) return false;
            changed.wait_for(lock, std::chrono::milliseconds(20));
        }
    }
    /// The picture when all samples are there.
    std::shared_ptr<const Picture> done(const std::string& plane = "picture") {
        std::shared_ptr<const Picture> picture;
        EXPECT_TRUE(until([&] {
            const Session::Shot shot = session->look(plane);
            const Json s = session->state(0, 0);
            picture = shot.picture;
            return s["phase"] == "idle" && s["figures"]["spp"] == s["wishes"]["spp"] && s["done"] == true && picture &&
                   picture->plane(plane);
        }));
        return picture;
    }
    /// What render makes of this scene.
    static display::Image rendered(const std::string& rib, render::RenderSettings s = {}) {
        Diagnostics diags;
        if (s.output.empty()) s.output = "expected.exr";
        s.threads = 2;
        s.shippedShaders = ALPENGLOW_SOURCE_DIR "/shaders";
        if (!s.spp) s.spp = 8;
        render::Progress progress(render::ProgressMode::None);
        render::Renderer r(s, render::transportEngine(), diags, progress);
        ri::ReaderOptions o;
        o.overrides = [&](scene::Options& of) { r.override(of); };
        ri::RibReader reader(o, r, diags);
        reader.readMemory(rib, "expected.rib");
        auto image = display::readImage(s.output, diags);
        EXPECT_TRUE(image);
        return image ? *image : display::Image{};
    }
    /// The greatest difference of red, green, blue and alpha.
    static float difference(const display::Image& a, const display::Image& b) {
        if (a.width != b.width || a.height != b.height) return INFINITY;
        float most = 0;
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x)
                for (const char* c : {"r", "g", "b", "a"})
                    most = std::max(most, std::fabs(a.pixel(x, y)[a.channel(c)] - b.pixel(x, y)[b.channel(c)]));
        return most;
    }
    static std::string with(std::string text, const std::string& what, const std::string& by) {
        return text.replace(text.find(what), what.size(), by);
    }
};

} // namespace session_test
