// The pictures of a frame: its Display requests, or those of the command line; how samples are stored for them; and the final
// steps: exposure, imager, quantiser, driver.
#pragma once
#include "base/file.h"
#include "display/imageio.h"
#include "display/matte.h"
#include "display/quantize.h"
#include "integrator/integrator.h"
#include "render/film.h"
#include "render/matteasked.h"
#include "render/samplebuffer.h"
#include "render/settings.h"
#include "scene/display.h"
#include "scene/fwd.h"
#include "scene/lightpaths.h"
#include <functional>

namespace alpenglow::render {

/// One variable of a display.
struct OutputVariable {
    /// Light: by light path. Computed and above: entries of the list of computed outputs, in its order (computedOutput()).
    /// These are available under Hider "path" only. Part files store the number.
    enum class Source : int { Ci, Alpha, Z, Oi, Engine, Light, Computed };
    Source source = Source::Ci;
    Source instead = Source::Engine;   ///< meaning of the name if no shader has such an output; Engine: none
    std::string name;                  ///< as the display's mode has it
    std::string asked;                 ///< Source::Engine: name of the output in shaders; "": `name`
    int engine = -1;                   ///< Source::Engine: index into OutputPlan::engineOutputs
    int light = -1;                    ///< Source::Light, or `instead` is Light: index into OutputPlan::lights
    bool typed = true;                 ///< false: type not declared, the engine's width determines the channels
    bool color = false;                ///< declared as a color
    std::vector<std::string> channels; ///< names of its channels in the picture
    /// Whether it is a colour for viewing: Ci, or declared as a color.
    bool shown() const { return source == Source::Ci || (source != Source::Alpha && source != Source::Z && typed && color); }
};

/// The source of an output that the renderer computes, such as "samples"; nothing: there is none of this name.
std::optional<OutputVariable::Source> computedOutput(std::string_view name);
/// The names of all, in the order of their sources.
std::vector<std::string> computedOutputs();

/// One picture.
struct OutputSpec {
    std::string name, type;                ///< of the display: file name, type
    std::vector<OutputVariable> variables; ///< in the order of the mode
    scene::ParamList params;               ///< of the display
    SourcePlace place;                     ///< of the request, for messages
    float gain = 1, gamma = 1;             ///< of Exposure, or of the display
    bool ownExposure = false; ///< the display's own "exposure": applies to all colours; else exposure applies to Ci only
    bool srgb = false;        ///< colours are converted by the sRGB curve, last
    std::string curve;        ///< for the user: the curve and its reason; "" if the picture is not for viewing
    PixelFilter filter;       ///< hidden and raytrace
    DepthFilter depth = DepthFilter::Min;  ///< for z
    display::Quantization rgba, z;         ///< for colours; for z
    bool quantizeAsked = false;            ///< the display or the scene asks for it
    bool userFile = false;                 ///< by -o or --display: may be in any folder
    bool map = false;                      ///< isMap()
    std::optional<MattesAsked> asksMattes; ///< a "cryptomatte"
    display::MattesRef mattes;             ///< of it, once they are made. Not in part files
    bool deep = false;                     ///< a deep shadow map; PictureFacts::deep has its pixels
    /// Whether one of its variables comes from there.
    bool has(OutputVariable::Source) const;
    /// The names of its channels, in the order of the file.
    std::vector<std::string> channels() const;
};

/// Frame-wide values that affect single pictures; stored in part files so that `merge -o` writes what `render -o` would.
struct OutputBasis {
    float gain = 1, gamma = 1;                                            ///< of Exposure
    bool gammaGiven = false, srgbAsked = false;                           ///< by --gamma
    bool exposureGiven = false;                                           ///< by Exposure
    bool path = false;                                                    ///< hider is path
    scene::Quantize rgba{255, 0, 255, 0.5f, false}, z{0, 0, 0, 0, false}; ///< of Quantize
    PixelFilter filter;                                                   ///< of PixelFilter
    DepthFilter depth = DepthFilter::Min;                                 ///< of the hider
};

/// All pictures of a frame, and what the integrator must compute for them.
struct OutputPlan {
    OutputBasis basis; ///< common values
    std::vector<OutputSpec> pictures;
    std::vector<std::string> engineOutputs; ///< world::Settings::outputs
    std::vector<int> engineWidths;          ///< floats of each: by displays (0: undeclared), then by resolve() from the shaders
    std::vector<scene::LightPaths::Source> lights;       ///< light path expressions
    std::shared_ptr<const scene::LightPaths> lightPaths; ///< from `lights`; null: none. Not in part files
    std::vector<std::vector<int>> lightParts;            ///< by expression: the parts of Ci's light that it includes
    int parts = 0;                                       ///< number of parts
    /// Floats of a sample in SampleResult::aovs.
    int engineFloats() const;
    /// Whether outputs of the surfaces that the camera sees first (SampleResult) are needed, or may be.
    bool needsFirstSeen() const;
    /// Whether a picture has a variable from there.
    bool needs(OutputVariable::Source) const;
    /// Whether some picture, or every picture, is a deep shadow map.
    bool anyDeep() const, onlyDeep() const;
    /// Whether some picture is a Cryptomatte; whether some reads depth by this filter.
    bool anyMattes() const;
    bool needsDepth(DepthFilter) const;
    /// Sets the widths from the engine and names the channels of undeclared outputs. `missing`: outputs that no shader has.
    void resolve(std::vector<int> widths, Diagnostics&, const std::vector<std::string>& missing = {});
};

/// The pictures of a frame. `file`: name by -o, which replaces the scene's displays except maps ("": the scene's displays; ri.pic
/// if there are none).
OutputPlan planOutputs(const scene::Options&, const RenderSettings&, bool path, const std::string& file, Diagnostics&);
/// The picture of -o: rgba, or rgb for formats without floating point. The format is by extension; for "-" (standard output) it
/// is `format`.
OutputSpec singleOutput(const std::string& file, const OutputBasis&, Diagnostics&, display::Format format = display::Format::Png);

/// Channels of a film for the plan, in addition to colour and alpha.
std::vector<Channel> filmChannels(const OutputPlan&);
/// Appends the values of filmChannels() of one sample.
void filmValues(const OutputPlan&, const integrator::SampleResult&, std::vector<float>* out);

// Outputs that are not shader outputs (lightchannels.cpp).
/// Sets the source of a variable by "source" of its DisplayChannel, or by a predefined name.
void setSource(OutputVariable&, const scene::Options&, OutputPlan&, const SourcePlace&, Diagnostics&);
/// The error about an output that only the hider path has.
void sayNeedsPath(const std::string& output, const SourcePlace&, Diagnostics&);
/// Sets OutputPlan::lightPaths.
void joinLightPaths(OutputPlan&, Diagnostics&);
/// Append film channels and their values; and the values of images after the engine's floats.
void addLightChannels(const OutputPlan&, std::vector<Channel>&);
void addLightValues(const OutputPlan&, const integrator::SampleResult&, std::vector<float>*);
/// Position of such a variable after the engine's floats, and total number of these floats.
size_t lightFloat(const OutputPlan&, const OutputVariable&);
size_t lightFloats(const OutputPlan&);
void addLightPixels(const OutputPlan&, const Film&, int x, int y, float* to);
/// The finished pixels of a film, with the channels of SampleBuffer::reconstruct and this depth filter.
Image filmImage(const Film&, const OutputPlan&, DepthFilter);

/// Properties of a picture other than its pixels.
struct PictureFacts {
    int width = 0, height = 0;                        ///< of the whole picture
    Window window;                                    ///< the crop window
    float pixelAspect = 1;                            ///< width divided by height of a pixel
    Matrix worldToCamera, worldToNDC;                 ///< for pictures that store them
    std::map<std::string, std::string> metadata;      ///< texts for headers, by key
    bool imager = false;                              ///< the frame has an imager shader
    std::shared_ptr<const display::DeepSamples> deep; ///< of deep shadow maps; null: none
};

/// Runs an imager over `count` pixels in place; see world::World::runImager. Returns false if the user stopped it; the pixels
/// are then undefined. Null: no imager.
using Imager = std::function<bool(int count, const float* x, const float* y, float* r, float* g, float* b, float* a)>;

/// A picture of the plan in the form for its driver; `in`: reconstructed pixels. Returns nothing if the imager was stopped.
std::optional<display::Image> finishedPicture(const OutputPlan&, const OutputSpec&, const PictureFacts&, const Image& in,
                                              const Imager&);
/// Writes all pictures of the plan. pixels(spec) returns the reconstructed pixels. Returns false if one could not be written
/// (reported); the others are written. If the imager is stopped, its picture and later ones are not written.
bool writeOutputs(const OutputPlan&, const PictureFacts&, const std::function<const Image&(const OutputSpec&)>& pixels,
                  const Imager&, bool allowWrite, Diagnostics&);

/// Converts plan and facts to JSON for a part file, and back. Returns nothing if the text is invalid (reported).
std::string planToText(const OutputPlan&, const PictureFacts&);
std::optional<std::pair<OutputPlan, PictureFacts>> planFromText(const std::string&, const std::string& file, Diagnostics&);

} // namespace alpenglow::render
