// What pictures a frame makes: its Display requests, or what the command line put in their place; how samples are kept for them;
// and the last steps of a pixel: exposure, imager, quantiser, driver.
#pragma once
#include "base/file.h"
#include "display/imageio.h"
#include "display/quantize.h"
#include "integrator/integrator.h"
#include "render/film.h"
#include "render/samplebuffer.h"
#include "render/settings.h"
#include "scene/display.h"
#include "scene/fwd.h"
#include "scene/lightpaths.h"
#include <functional>

namespace alpenglow::render {

/// One variable of a display.
struct OutputVariable {
    /// Light: by light path. Albedo, Normal: of what the camera sees first. Variance, Samples: of a pixel of Ci. Under path.
    enum class Source { Ci, Alpha, Z, Oi, Engine, Light, Albedo, Normal, Variance, Samples };
    Source source = Source::Ci;
    Source instead = Source::Engine; ///< of a name that no shader may have: what it is then; Engine: nothing
    std::string name;
    std::string asked; ///< Source::Engine: the output in the shaders; "": `name`
    int engine = -1;   ///< Source::Engine: index into OutputPlan::engineOutputs
    int light = -1;    ///< Source::Light, or `instead` is: index into OutputPlan::lights
    bool typed = true; ///< false: nothing declared its type, so the engine's width decides the channels
    bool color = false;
    std::vector<std::string> channels;
    /// Whether it is a colour to look at: Ci, and what is declared as a color.
    bool shown() const { return source == Source::Ci || (source != Source::Alpha && source != Source::Z && typed && color); }
};

/// One picture.
struct OutputSpec {
    std::string name, type;
    std::vector<OutputVariable> variables;
    scene::ParamList params;
    SourcePlace place;
    float gain = 1, gamma = 1;
    bool ownExposure = false; ///< the display's own "exposure": then it holds for all colours, else for Ci alone
    bool srgb = false;        ///< colours go through the curve of sRGB, last
    std::string curve;        ///< for the user: which curve and why; "" where the picture is not made to be looked at
    PixelFilter filter;       ///< hidden and raytrace
    DepthFilter depth = DepthFilter::Min;
    display::Quantization rgba, z;
    bool quantizeAsked = false;
    bool userFile = false; ///< named by -o or --display: written where it says
    bool map = false;      ///< isMap()
    bool deep = false;     ///< a deep shadow map: PictureFacts::deep is its pixels
    bool has(OutputVariable::Source) const;
    std::vector<std::string> channels() const;
};

/// What the whole frame decides about single pictures; kept in part files so that `merge -o` makes what `render -o` would.
struct OutputBasis {
    float gain = 1, gamma = 1;
    bool gammaGiven = false, srgbAsked = false; ///< by --gamma
    bool exposureGiven = false;                 ///< by Exposure
    bool path = false;
    scene::Quantize rgba{255, 0, 255, 0.5f, false}, z{0, 0, 0, 0, false};
    PixelFilter filter;
    DepthFilter depth = DepthFilter::Min;
};

struct OutputPlan {
    OutputBasis basis;
    std::vector<OutputSpec> pictures;
    std::vector<std::string> engineOutputs; ///< transport::Settings::outputs
    std::vector<int> engineWidths; ///< floats of each: what displays declare (0: nothing), then by resolve() what shaders have
    std::vector<scene::LightPaths::Source> lights;       ///< light path expressions
    std::shared_ptr<const scene::LightPaths> lightPaths; ///< of these; null: none. Not in part files
    std::vector<std::vector<int>> lightParts;            ///< by expression, the parts of Ci's light that it shows
    int parts = 0;                                       ///< how many there are
    int engineFloats() const;
    /// Whether SampleResult::albedo and normal are asked for, or may be.
    bool needsFirstSeen() const;
    bool needs(OutputVariable::Source) const;
    /// Some picture is a deep shadow map; all of them are.
    bool anyDeep() const, onlyDeep() const;
    bool needsDepth(DepthFilter) const;
    /// Takes the widths the engine found and names the channels of what nobody had declared. `missing`: outputs that no shader
    /// has.
    void resolve(std::vector<int> widths, Diagnostics&, const std::vector<std::string>& missing = {});
};

/// The pictures of a frame. `file` is -o's name, which takes the place of the scene's displays but its maps ("" = the scene's
/// displays; ri.pic when it has none).
OutputPlan planOutputs(const scene::Options&, const RenderSettings&, bool path, const std::string& file, Diagnostics&);
/// The picture of -o: rgba, or rgb for PNG and JPEG. The name's extension chooses; else, for "-" (standard output), `format`.
OutputSpec singleOutput(const std::string& file, const OutputBasis&, Diagnostics&, display::Format format = display::Format::Png);

/// Channels of a film that holds what the plan needs beside colour and alpha.
std::vector<Channel> filmChannels(const OutputPlan&);
/// The values of filmChannels() of one sample, appended.
void filmValues(const OutputPlan&, const transport::SampleResult&, std::vector<float>* out);

// lightchannels.cpp: what is not an output of shaders.
/// What a variable shows by "source" of its DisplayChannel, or by a name of ours.
void setSource(OutputVariable&, const scene::Options&, OutputPlan&, const SourcePlace&, Diagnostics&);
/// Makes OutputPlan::lightPaths.
void joinLightPaths(OutputPlan&, Diagnostics&);
/// Film channels and their values, appended; and what images have behind the engine's floats.
void addLightChannels(const OutputPlan&, std::vector<Channel>&);
void addLightValues(const OutputPlan&, const transport::SampleResult&, std::vector<float>*);
/// Where such a variable stands behind the engine's floats, and how many there are of all.
size_t lightFloat(const OutputPlan&, const OutputVariable&);
size_t lightFloats(const OutputPlan&);
void addLightPixels(const OutputPlan&, const Film&, int x, int y, float* to);
/// The finished pixels of a film, channels as SampleBuffer::reconstruct has them, depth by this filter.
Image filmImage(const Film&, const OutputPlan&, DepthFilter);

/// What a picture says about itself beside its pixels.
struct PictureFacts {
    int width = 0, height = 0; ///< of the whole picture
    Window window;
    float pixelAspect = 1;
    Matrix worldToCamera, worldToNDC;
    std::map<std::string, std::string> metadata;
    bool imager = false;                              ///< the frame has an imager shader
    std::shared_ptr<const display::DeepSamples> deep; ///< of deep shadow maps; null: none was made
};

/// Runs an imager over `count` pixels in place; see transport::World::runImager. False: the user stopped it, the pixels are void.
/// Null: none.
using Imager = std::function<bool(int count, const float* x, const float* y, float* r, float* g, float* b, float* a)>;

/// A picture of the plan as its driver gets it: `in` is what was reconstructed for it. Nothing: the imager was stopped.
std::optional<display::Image> finishedPicture(const OutputPlan&, const OutputSpec&, const PictureFacts&, const Image& in,
                                              const Imager&);
/// Writes all pictures of the plan. pixels(spec) gives what was reconstructed for it. False when any could not be written (an
/// error was reported); the others are written all the same. What the imager was stopped in and what comes behind it is not.
bool writeOutputs(const OutputPlan&, const PictureFacts&, const std::function<const Image&(const OutputSpec&)>& pixels,
                  const Imager&, bool allowWrite, Diagnostics&);

/// The plan and facts as JSON text for a part file, and back. Nothing: the text is not ours (an error was reported).
std::string planToText(const OutputPlan&, const PictureFacts&);
std::optional<std::pair<OutputPlan, PictureFacts>> planFromText(const std::string&, const std::string& file, Diagnostics&);

} // namespace alpenglow::render
