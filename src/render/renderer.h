// The renderer: receives complete frames from the RIB reader, renders them, writes their pictures.
#pragma once
#include "render/engine.h"
#include "render/framestats.h"
#include "render/outcome.h"
#include "render/outputnames.h"
#include "render/progress.h"
#include "render/settings.h"
#include "render/stats.h"
#include "scene/frameconsumer.h"
#include <functional>
#include <optional>
#include <set>
#include <span>

namespace alpenglow::render {

class FrameProcesses;

/// Renders the frames of a run, one after the other.
class Renderer final : public scene::FrameConsumer {
public:
    /// Prints the results of `--pixel`, one line a call, without line end.
    using Print = std::function<void(const std::string&)>;
    /// Diagnostics and progress must outlive the renderer. `print` may be empty.
    Renderer(RenderSettings, Engine, Diagnostics&, Progress&, Print print = {});
    ~Renderer() override;

    /// For ri::ReaderOptions::overrides: applies the command line to a frame's options.
    void override(scene::Options&) const;
    /// Sets the scene file that is read next; its folder is searched for shaders and textures. `read`: pictures that its Make
    /// requests read, as far as known.
    void setScene(const std::string& path, const std::set<std::string>& read = {});
    /// For ri::ReaderOptions::defers: expands procedurals of a frame during rendering (ri::RibReader::make()).
    using MakeProcedurals = std::function<std::shared_ptr<const scene::Frame>(const scene::Frame&, std::span<const int>)>;
    /// Unset: procedurals are expanded by the reader.
    void setProcedurals(MakeProcedurals make) { makeProcedurals_ = std::move(make); }
    /// Frames are rendered by these processes from here on. They must outlive the renderer, and report its diagnostics.
    void setProcesses(FrameProcesses&);
    /// Waits until all submitted frames are rendered.
    void waitForFrames();
    /// Whether the files known before a scene is read (-o, --checkpoint, --stats) can be written. Returns false after an error,
    /// which is reported.
    bool canBegin();

    void render(std::shared_ptr<const scene::Frame>) override;
    void makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                     const SourcePlace&) override;
    void passOver(const scene::Options&) override;
    void passOverTexture(const std::vector<std::string>& files) override;
    void beforeRead(const std::string& name) override;
    /// Call after the last scene: reports if picture options had no effect because all frames were maps.
    void finish();

    using Outcome = render::Outcome; ///< as of render
    /// For frames rendered so far; complete after waitForFrames().
    const Outcome& outcome() const { return outcome_; }
    /// Figures of all frames so far: times, rays and counts are sums; size, samples and noise are the last frame's.
    RenderStats stats() const;
    /// What --stats writes: the same figures as JSON, and those of each frame.
    std::string statsText() const;
    /// Writes --stats; false when it could not.
    bool writeStats();

private:
    // renderframe.cpp
    void renderFrame(std::shared_ptr<const scene::Frame>, FrameStats&);
    struct FrameWork;
    void drawFrame(FrameWork&);
    void drawPictures(FrameWork&, int threads);
    bool planFrame(FrameWork&);
    bool buildFrame(FrameWork&);
    void makeAll(FrameWork&);
    void makeWhatIsMet(FrameWork&, struct Job&);
    // abandon.cpp
    /// True after an error of a frame under ErrorHandler "abort": it is refused.
    bool abandons(const FrameWork&);
    void noteInterrupted(const struct Job&); ///< by the user
    world::Settings engineSettings(const FrameWork&) const;
    std::function<bool(int, const float*, const float*, float*, float*, float*, float*)> imagerOf(FrameWork&);
    void describeFrame(FrameWork&);
    void writtenPictures(FrameWork&, bool fine);
    // rendererprocesses.cpp
    bool inProcess() const; ///< this process was forked for a frame
    /// Passes a planned frame to a process. Returns true in that process, or if there are no processes.
    bool drawsHere(const FrameWork&);
    void beginProcess(bool alone);
    std::string ofEachFrame() const; ///< for messages: whose memory is limited
    /// Ends the process; in the reading process, ends the frame.
    void endFrame();
    void takeResult(FrameResult);
    /// In a process: declares whether the frame bakes, because later frames may read the result.
    void declareBakes(const FrameWork&);
    /// In a process: waits until the files of this frame may be written.
    void awaitTurn();
    void awaitTurn(const FrameWork&); ///< only if a picture is a map
    // rendermaps.cpp
    void makeInProcess(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                       const SourcePlace&);
    void runMakeRequest(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                        const SourcePlace&);
    /// Restricts where map names of the scene may lead.
    ReadPolicy readPolicy() const;
    FilmDescription filmOf(const FrameWork&) const;
    bool renderSamples(FrameWork&, struct Job&);
    void writeFrameFilm(FrameWork&, Film&, double renderSec);
    bool makeDepths(FrameWork&, struct Job&);
    bool makeMattes(FrameWork&, struct Job&);
    bool renderGrid(FrameWork&, struct Job&);
    /// Hider "photon": writes the photon maps that the frame names. Defined in renderphotons.cpp.
    void renderPhotons(FrameWork&, int threads);
    /// Makes missing photon maps that shaders read, if lights emit photons.
    void makePhotonMaps(FrameWork&, struct Job&);
    void writeBaked(FrameWork&, const struct Job&);
    void takeFigures(const FrameWork&, struct Job&);
    /// Adds the figures of the last frame to those of the run.
    void closeFrame(FrameStats);
    /// Marks the displays that a Make request reads.
    void markRead(scene::Options&) const;
    std::string fileFor(const scene::Options&, uint32_t spp);
    /// Called for a frame with a picture for -o: the first keeps the name until there is a second. Returns true if this one gets
    /// a number.
    bool numbersFrame();
    /// Renames the picture of the first frame, and its part file, to include the frame number.
    void numberFirstPicture();
    std::vector<std::string> searchPaths(const scene::Options&, const char* kind, const std::vector<std::string>& own,
                                         bool shaders) const;
    /// Reports dropped samples, and how to reproduce the first. `sample` < 0: unknown.
    void reportDropped(uint64_t count, int x, int y, int64_t sample);
    /// --checkpoint; with the frame number, and numbered for further worlds, so that each can be resumed.
    std::string checkpointFile(const scene::Options&);
    /// Assigns each output of the frame a file of its own within this run.
    void nameOutputs(struct OutputPlan&, const scene::Options&);
    /// Whether the files of this frame can be written, as far as known before its first ray. Errors are reported.
    bool canWrite(const struct OutputPlan&, const std::string& checkpoint, bool part);
    /// Whether an existing checkpoint may be replaced (--resume, --restart). Returns false after an error, which is reported.
    bool mayReplace(const std::string& checkpoint);
    /// Reads the checkpoint, if there is one. Returns false if it is of another render or damaged (reported).
    bool resume(const std::string& checkpoint, const FilmDescription& wanted, std::unique_ptr<Film>& film);
    void printPixel(struct Job&, const scene::Options&, SampleRange, bool path);

    RenderSettings settings_;
    Engine engine_;
    Diagnostics& diagnostics_;
    Progress& progress_;
    Print print_;
    MakeProcedurals makeProcedurals_;
    FrameProcesses* processes_ = nullptr; ///< null: frames are rendered in this process
    bool handedOver_ = false;             ///< the last frame was passed to a process
    uint64_t grown_ = 0;                  ///< memory in bytes that the first frames allocated in their processes
    uint64_t begun_ = 0;                  ///< memory that a process started with
    std::set<std::string> read_;          ///< fileIdentity() of setScene()'s pictures
    std::vector<std::string> written_;    ///< pictures and maps of this run, with links resolved: scenes may read them
    Outcome outcome_;
    std::vector<float> sampleMemory_; ///< renderImages()
    RenderStats stats_;               ///< of the current frame
    RenderStats all_;                 ///< of earlier frames
    std::vector<FrameStats> frames_;  ///< those that were rendered
    double parseMark_ = 0;            ///< time since which the reader is active
    OutputNames names_;
    int pictures_ = 0, maps_ = 0; ///< frames of either kind
    int checkpoints_ = 0;         ///< worlds outside of frames that had one
    int saved_ = 0;               ///< pictures of worlds outside of frames that were made for -o, or of the save pattern
    int framesForOutput_ = 0;     ///< numbered frames with a picture for -o so far, rendered or skipped
    /// The first such frame, if it is rendered: its file, once known.
    struct FirstPicture {
        int frame;
        std::string file;
    };
    std::optional<FirstPicture> firstPicture_;
};

} // namespace alpenglow::render
