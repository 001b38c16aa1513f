// The renderer: takes frames as RIB streams finish them, renders them, writes their pictures.
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

class Renderer final : public scene::FrameConsumer {
public:
    /// Where `--pixel` prints; one line a call, without its end.
    using Print = std::function<void(const std::string&)>;
    /// Diagnostics and progress must outlive the renderer. `print` may be empty.
    Renderer(RenderSettings, Engine, Diagnostics&, Progress&, Print print = {});
    ~Renderer() override;

    /// For ri::ReaderOptions::overrides: what the command line says about a frame's options.
    void override(scene::Options&) const;
    /// The scene file that is read next; its folder is looked into for shaders and textures. `read`: pictures that its Make
    /// requests read, as far as known.
    void setScene(const std::string& path, const std::set<std::string>& read = {});
    /// For ri::ReaderOptions::defers: makes what is in procedurals of a frame that is being rendered (ri::RibReader::make()).
    using MakeProcedurals = std::function<std::shared_ptr<const scene::Frame>(const scene::Frame&, std::span<const int>)>;
    void setProcedurals(MakeProcedurals make) { makeProcedurals_ = std::move(make); }
    /// Frames are drawn by these from here on, which outlive the renderer and tell what its diagnostics get.
    void setProcesses(FrameProcesses&);
    /// Waits until all frames are drawn that were handed over.
    void settle();
    /// Whether the files that are known before a scene is read (-o, --checkpoint, --stats) can be written. False: an error was
    /// reported.
    bool canBegin();

    void render(std::shared_ptr<const scene::Frame>) override;
    void makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                     const SourcePlace&) override;
    void passOver(const scene::Options&) override;
    void passOverTexture(const std::vector<std::string>& files) override;
    void beforeRead(const std::string& name) override;
    /// To be called after the last scene: says so when options about pictures found maps only, which they leave alone.
    void finish();

    using Outcome = render::Outcome;
    /// Of what is drawn by now; settle() makes that everything.
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
    transport::Settings engineSettings(const FrameWork&) const;
    std::function<bool(int, const float*, const float*, float*, float*, float*, float*)> imagerOf(FrameWork&);
    void describeFrame(FrameWork&);
    void writtenPictures(FrameWork&, bool fine);
    // rendererprocesses.cpp
    bool inProcess() const; ///< this is a process of setProcesses()
    /// Hands a frame that is planned to a process. True: this is that process, or there are none.
    bool drawsHere(const FrameWork&);
    void beginProcess(bool alone);
    std::string ofEachFrame() const; ///< for messages: whose memory is limited
    /// Ends the process, or in the one that reads what was begun for the frame.
    void endFrame();
    void takeResult(FrameResult);
    /// Says, in a process, whether the frame bakes, since later frames may read what it does.
    void declareBakes(const FrameWork&);
    /// Waits, in a process, until what this frame writes may be written.
    void awaitTurn();
    void awaitTurn(const FrameWork&); ///< where there is a map among its pictures
    // rendermaps.cpp
    void makeInProcess(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                       const SourcePlace&);
    void runMakeRequest(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                        const SourcePlace&);
    /// Where names of maps in the scene may lead.
    ReadPolicy readPolicy() const;
    FilmDescription filmOf(const FrameWork&) const;
    bool renderSamples(FrameWork&, struct Job&);
    void writeFrameFilm(FrameWork&, Film&, double renderSec);
    bool makeDepths(FrameWork&, struct Job&);
    void renderGrid(FrameWork&, struct Job&);
    /// Hider "photon": writes the photon maps that the frame names. renderphotons.cpp
    void renderPhotons(FrameWork&, int threads);
    /// Makes the maps that shaders ask for and that are not there, where lights emit photons.
    void makePhotonMaps(FrameWork&, struct Job&);
    void writeBaked(FrameWork&, const struct Job&);
    void takeFigures(const FrameWork&, struct Job&);
    /// Takes the figures of the frame just rendered over into those of the run.
    void closeFrame(FrameStats);
    /// Says of each display whether a Make request reads it.
    void markRead(scene::Options&) const;
    std::string fileFor(const scene::Options&, uint32_t spp);
    /// A frame with a picture for -o comes: the first has the name as it is, until a second comes. True: this one has its number.
    bool numbersFrame();
    /// Gives the picture of the first frame, and its part file, the number of the frame.
    void numberFirstPicture();
    std::vector<std::string> searchPaths(const scene::Options&, const char* kind, const std::vector<std::string>& own,
                                         bool shaders) const;
    /// Says that samples were left out, and how to make the first of them again. `sample` < 0: it is not known.
    void reportDropped(uint64_t count, int x, int y, int64_t sample);
    /// --checkpoint; frames have their number in it, and so do further worlds, so that each can be resumed.
    std::string checkpointFile(const scene::Options&);
    /// Gives each output of the frame a file that no other of this run has.
    void nameOutputs(struct OutputPlan&, const scene::Options&);
    /// Whether the files of this frame can be written, as far as can be known before its first ray. Errors were reported.
    bool canWrite(const struct OutputPlan&, const std::string& checkpoint, bool part);
    /// Whether a checkpoint that is there may be replaced (--resume, --restart). False: an error was reported.
    bool mayReplace(const std::string& checkpoint);
    /// What the checkpoint holds, if there is one. False: it is of something else or damaged (an error was reported).
    bool resume(const std::string& checkpoint, const FilmDescription& wanted, std::unique_ptr<Film>& film);
    void printPixel(struct Job&, const scene::Options&, SampleRange, bool path);

    RenderSettings settings_;
    Engine engine_;
    Diagnostics& diagnostics_;
    Progress& progress_;
    Print print_;
    MakeProcedurals makeProcedurals_;
    FrameProcesses* processes_ = nullptr; ///< null: frames are drawn here
    bool handedOver_ = false;             ///< the frame that came last is drawn by a process
    uint64_t grown_ = 0;                  ///< bytes that the first frames took in their processes
    uint64_t begun_ = 0;                  ///< that a process began with
    std::set<std::string> read_;          ///< fileIdentity() of setScene()'s pictures
    std::vector<std::string> written_;    ///< pictures and maps of this run, with links followed: scenes may read them
    Outcome outcome_;
    std::vector<float> sampleMemory_; ///< renderImages()
    RenderStats stats_;               ///< of the frame being rendered
    RenderStats all_;                 ///< of the frames before
    std::vector<FrameStats> frames_;  ///< those that were rendered
    double parseMark_ = 0;            ///< since when the reader is at work
    OutputNames names_;
    int pictures_ = 0, maps_ = 0; ///< frames of either kind
    int checkpoints_ = 0;         ///< worlds outside of frames that had one
    int saved_ = 0;               ///< pictures of worlds outside of frames that were made for -o, or of the save pattern
    int framesForOutput_ = 0;     ///< frames with a number and a picture for -o so far, rendered or passed over
    /// Of the only one of these, where it is rendered: its file, once that is known.
    struct FirstPicture {
        int frame;
        std::string file;
    };
    std::optional<FirstPicture> firstPicture_;
};

} // namespace alpenglow::render
