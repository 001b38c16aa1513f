// A scene rendered interactively: read, built, rendered pass by pass on its own thread, restarted after each change, and shown.
#pragma once
#include "base/readlog.h"
#include "render/renderer.h"
#include "render/watcher.h"
#include "ri/reader.h"
#include "view/picture.h"
#include "view/pose.h"
#include "view/wishes.h"
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

namespace alpenglow::view {

/// Options of the command line.
struct ViewOptions {
    render::RenderSettings settings;          ///< as of `alpenglow render`
    ri::ReaderOptions reader;                 ///< as of `alpenglow render`
    std::string scene;                        ///< a file
    std::optional<int> frame;                 ///< frame number; nothing: the first with a picture
    bool watch = false;                       ///< read again when a file of the scene changes
    std::function<void(ri::RibReader&)> read; ///< hands the scene to the reader
    /// Describes a shader (alpenglow info --json) found in these folders; null: unknown.
    std::function<nlohmann::json(const std::string& name, const std::vector<std::string>& folders)> describe;
    Diagnostics::Handler print; ///< gets every message too
};

/// A message for the page; may represent several similar ones.
struct Message {
    Diagnostic diagnostic; ///< the last one
    int count = 1;         ///< how many it stands for
};

/// One scene that is viewed. Public functions may be called by any thread.
class Session final : private render::Watcher {
public:
    /// `changed` is called, from any thread, when there is something new for viewers.
    Session(ViewOptions, std::function<void()> changed);
    ~Session() override;

    /// Reads the scene for the first time. Returns false if it has no picture (reported).
    bool load();
    void start();

    // Handles a viewer's request on the server's thread: {"do": "set", ...}. The response has "error" on failure.
    nlohmann::json act(const nlohmann::json&);
    /// Counts whatever viewers see. Grows.
    uint64_t serial() const;
    struct Shot {
        std::shared_ptr<const Picture> picture; ///< null: none yet
        uint64_t serial = 0;                    ///< serial() when it was taken
        std::map<std::string, double> dim;      ///< factors of lights by handle, 0 dark, as the viewers set them
    };
    /// Somebody looks, at this plane ("picture", "noise", ...).
    Shot look(const std::string& plane);
    /// Everything but pixels; messages and points of the curves from these numbers on.
    nlohmann::json state(size_t messages, size_t points) const;
    /// Lights, outputs, shaders with their parameters.
    nlohmann::json scene();

private:
    enum class Phase { Reading, Building, Coarse, Crop, Whole, Idle };
    using Clock = std::chrono::steady_clock;
    /// Data for converting sums to pictures.
    struct Means {
        render::OutputPlan plan;
        render::PictureFacts facts;
        std::shared_ptr<const world::World> world;
    };
    struct Kept { ///< of the complete picture: for continuing, showing and saving
        std::shared_ptr<const Means> means;
        std::unique_ptr<render::Film> film;         ///< path
        std::shared_ptr<const render::Image> image; ///< hidden and raytrace
        double seconds = 0;
        double rays = 0;
    };
    struct Save {
        std::string type;
        float gain = 1, gamma = 1;
        bool srgb = false;
    };
    /// A scene that was read.
    struct Loaded {
        std::shared_ptr<const scene::Frame> frame;
        std::vector<ShaderUse> shaders;
        std::vector<std::string> lights; ///< handles, unique
        std::vector<int> frames;         ///< the numbers of all
    };

    // session.cpp: the thread
    void run();
    bool waitForWork();
    bool readScene();
    void giveUp(const std::string& why);
    void say(const Diagnostic&);
    void interrupt();
    void notifyViewers();
    nlohmann::json moveCamera(const nlohmann::json&);
    nlohmann::json askSave(const nlohmann::json&);

    // rounds.cpp: rendering
    void render();
    struct Pass {
        Phase phase;
        double factor = 1;
        uint32_t spp = 1;
        std::optional<std::array<double, 4>> crop;
    };
    bool renderPass(const Pass&);
    std::vector<Pass> passes() const;
    std::shared_ptr<const scene::Frame> frameFor() const;
    void addOutputs(scene::Options&) const;
    render::Engine engine();
    uint32_t wanted() const;
    bool isPath() const;
    bool overtaken() const;

    // looking.cpp: Watcher, shots and saved files
    bool writes() const override { return false; }
    void begin(const render::WatchedFrame&) override;
    std::unique_ptr<render::Film> filmFor(const render::FilmDescription&) override;
    void look(const render::Glance&) override;
    void finished(std::unique_ptr<render::Film>) override;
    void shoot(const render::Glance&, const Means&);
    bool shotIsDue() const;
    void lookAtRest();
    bool save(const Save&, const Means&, const render::Film*, const render::Image&);
    void savePending(const Means&, const render::Film*, const std::function<render::Image()>&);
    std::string freeName(const std::string& type, const render::Film*) const;

    void setPhase(Phase);
    void watchFiles();
    std::set<std::string> wantedPlanes() const;

    const ViewOptions options_;
    const std::function<void()> changed_;
    StopFlag stop_{0}, end_{0};
    bool begun_ = false; ///< the thread is, or will be, there
    std::thread thread_, watching_;

    // Guarded by mutex_.
    mutable std::mutex mutex_;
    std::condition_variable work_, watchEnds_;
    Wishes wishes_;
    std::optional<Pose> pose_;
    bool dragging_ = false, reload_ = false;
    uint64_t generation_ = 1, serial_ = 1, sceneSerial_ = 0;
    Phase phase_ = Phase::Reading;
    Clock::time_point phaseSince_{};
    std::shared_ptr<const Picture> picture_;
    std::shared_ptr<ReadLog> reads_; ///< of the scene as it was last read; set by the rendering thread
    std::vector<Message> messages_;
    std::map<std::string, size_t> messageAt_;
    size_t messagesLost_ = 0;
    std::vector<std::array<double, 5>> curve_; ///< seconds, samples, rays/ms, noiseRSE, efficiency
    uint64_t curveOf_ = 0;                     ///< counts curves
    std::vector<Save> saves_;
    std::vector<std::string> saved_;
    std::map<std::string, Clock::time_point> viewers_; ///< planes, and time of the last request
    std::shared_ptr<const Loaded> scene_;
    std::vector<std::string> outputs_; ///< outputs of the shaders, as far as known
    std::vector<std::string> shaderFolders_;
    std::array<double, 3> curveAtFirst_{1, 1, 1}; ///< how render would show the picture: gain, gamma, whether as sRGB
    int width_ = 0, height_ = 0;                  ///< of the picture
    std::map<std::string, nlohmann::json> descriptions_;

    // The rendering thread's own.
    std::unique_ptr<Diagnostics> diags_;
    uint64_t done_ = 0; ///< the generation that was rendered to its end
    struct Round {      ///< the current round
        Wishes wishes;
        std::optional<Pose> pose;
        bool dragging = false;
        uint64_t generation = 0;
        std::shared_ptr<const scene::Frame> frame;
        std::string filmKey, worldKey;
        std::shared_ptr<const Loaded> scene;
    } round_;
    Pass pass_{};
    std::shared_ptr<const world::World> world_;
    std::string worldKey_, filmKey_;
    std::optional<Pose> worldPose_;
    std::shared_ptr<const Means> means_;       ///< of the current pass
    const render::OutputPlan* plan_ = nullptr; ///< the renderer's own, for Glance::pixels
    double passSeconds_ = 0, passRays_ = 0;    ///< of the current pass
    double sampleSeconds_ = 0;                 ///< last time for one sample of a pixel; 0: unknown
    Kept kept_;
    std::shared_ptr<const Picture> crop_;         ///< the crop, while it has more samples
    std::optional<std::array<double, 4>> cropOf_; ///< which part that is
    double shotSeconds_ = 0;                      ///< time of the last shot
    uint64_t pictures_ = 0;                       ///< pictures made
    Clock::time_point lastShot_{};
    bool stale_ = true;            ///< there is more than was shown
    bool grew_ = false;            ///< the current pass has finished tiles
    std::optional<Phase> shownOf_; ///< phase of the last shot in this round
    std::set<std::string> shotPlanes_;
};

} // namespace alpenglow::view
