// A request becomes a call of a filter's function: its arguments in the order of C, whose types say how they are read. What the
// filter calls comes back by ri.h, as the calls of a library of procedurals do.
#include "ri/c/rif.h"
#include "ri/c/rifcalls.h"
#include <dlfcn.h>
#include <exception>
#include <fmt/format.h>

namespace alpenglow::ri {

namespace {

thread_local RifPlugin* tPlugin = nullptr;

#define RIF(member) ALPENGLOW_RIF(member)
const RifFunction kFunctions[] = {RIF(FrameBegin),
                                  RIF(FrameEnd),
                                  RIF(WorldBegin),
                                  RIF(WorldEnd),
                                  RIF(AttributeBegin),
                                  RIF(AttributeEnd),
                                  RIF(TransformBegin),
                                  RIF(TransformEnd),
                                  RIF(SolidBegin),
                                  RIF(SolidEnd),
                                  RIF(ObjectEnd),
                                  RIF(MotionBeginV),
                                  RIF(MotionEnd),
                                  RIF(ResourceBegin),
                                  RIF(ResourceEnd),
                                  RIF(ResourceV),
                                  RIF(IfBeginV),
                                  RIF(ElseIfV),
                                  RIF(Else),
                                  RIF(IfEnd),
                                  RIF(Format),
                                  RIF(FrameAspectRatio),
                                  RIF(ScreenWindow),
                                  RIF(CropWindow),
                                  RIF(ProjectionV),
                                  RIF(Clipping),
                                  RIF(ClippingPlane),
                                  RIF(DepthOfField),
                                  RIF(Shutter),
                                  RIF(PixelVariance),
                                  RIF(PixelSamples),
                                  RIF(PixelFilter),
                                  RIF(Exposure),
                                  RIF(ImagerV),
                                  RIF(Quantize),
                                  RIF(DisplayV),
                                  RIF(DisplayChannelV),
                                  RIF(HiderV),
                                  RIF(ColorSamples),
                                  RIF(RelativeDetail),
                                  RIF(OptionV),
                                  RIF(CameraV),
                                  RIF(Color),
                                  RIF(Opacity),
                                  RIF(TextureCoordinates),
                                  RIF(ShadingRate),
                                  RIF(ShadingInterpolation),
                                  RIF(Matte),
                                  RIF(Bound),
                                  RIF(Detail),
                                  RIF(DetailRange),
                                  RIF(GeometricApproximation),
                                  RIF(GeometricRepresentation),
                                  RIF(Orientation),
                                  RIF(ReverseOrientation),
                                  RIF(Sides),
                                  RIF(Basis),
                                  RIF(TrimCurve),
                                  RIF(AttributeV),
                                  RIF(SurfaceV),
                                  RIF(DisplacementV),
                                  RIF(AtmosphereV),
                                  RIF(InteriorV),
                                  RIF(ExteriorV),
                                  RIF(ShaderV),
                                  RIF(LightSourceV),
                                  RIF(AreaLightSourceV),
                                  RIF(Illuminate),
                                  RIF(BxdfV),
                                  RIF(PatternV),
                                  RIF(DisplaceV),
                                  RIF(LightV),
                                  RIF(LightFilterV),
                                  RIF(EnableLightFilter),
                                  RIF(IntegratorV),
                                  RIF(DisplayFilterV),
                                  RIF(SampleFilterV),
                                  RIF(PixelSampleImagerV),
                                  RIF(VPAtmosphereV),
                                  RIF(VPInteriorV),
                                  RIF(VPSurfaceV),
                                  RIF(Identity),
                                  RIF(Transform),
                                  RIF(ConcatTransform),
                                  RIF(Perspective),
                                  RIF(Translate),
                                  RIF(Rotate),
                                  RIF(Scale),
                                  RIF(Skew),
                                  RIF(DeformationV),
                                  RIF(CoordinateSystem),
                                  RIF(ScopedCoordinateSystem),
                                  RIF(CoordSysTransform),
                                  RIF(ReadArchiveV),
                                  RIF(MakeTextureV),
                                  RIF(MakeBumpV),
                                  RIF(MakeLatLongEnvironmentV),
                                  RIF(MakeShadowV),
                                  RIF(MakeBrickMapV),
                                  RIF(MakeOcclusionV)};
#undef RIF

const RifFunction* functionOf(std::string_view request) {
    for (const std::span<const RifFunction> list : {std::span<const RifFunction>(kFunctions), rifPrimitives()})
        for (const RifFunction& f : list)
            if (f.request == request) return &f;
    return nullptr;
}

} // namespace

bool rifComplete() { // two members are no functions: ClientData and Filtering
    return sizeof(RifFilter) == (2 + std::size(kFunctions) + rifPrimitives().size()) * sizeof(void*);
}

namespace {

class RifStage final : public RequestReceiver, private Target {
public:
    RifStage(std::string path, std::unique_ptr<RifPlugin> plugin, RequestReceiver& to, Diagnostics& reported)
        : path_(std::move(path)), plugin_(std::move(plugin)), filter_(plugin_->GetFilter()), to_(to), reporter_(reported) {}

    void request(const Call& c) override {
        const RifFunction* f = functionOf(c.request->name);
        if (!f || (!f->given(filter_) && filter_.Filtering == RifFilter::k_Continue)) return execute(c);
        if (!f->given(filter_)) return;
        const CallsTo calls(*this, c.place, ", called by a filter");
        RifPlugin* const outer = std::exchange(tPlugin, plugin_.get());
        try {
            RifArguments a(c, sketch_.declarations, [this](const std::string& text) { return handleOf(text); });
            void* const handle = f->call(filter_, a);
            if (a.isLight() && handle) handles_[c.text(1)] = handle;
        } catch (const NotInC&) { execute(c); } catch (const std::exception& e) {
            threw(c, fmt::format(": {}", e.what()));
        } catch (...) { threw(c, ""); }
        tPlugin = outer;
    }
    void unknown(const std::string& name, const std::vector<Value>& values) override { to_.unknown(name, values); }
    void comment(const std::string& kind, const std::string& text) override { to_.comment(kind, text); }
    bool over() const override { return to_.over(); }

private:
    void threw(const Call& c, const std::string& what) {
        reporter_.error(Rie::System, c.place, fmt::format("{}: filter \"{}\" threw{}", c.request->name, path_, what),
                        "the request is left out");
    }
    /// The light of this name. A light that was declared before the filter gets a handle at its first use.
    RtPointer handleOf(const std::string& text) {
        RtPointer& h = handles_[text];
        if (!h) {
            const int number = nextHandle();
            nameHandle(number, text);
            h = reinterpret_cast<RtPointer>(uintptr_t(number));
        }
        return h;
    }
    // Target: what the filter calls.
    void execute(const Call& c) override {
        sketch_.note(c);
        to_.request(c);
    }
    Reporter& reporter() override { return reporter_; }
    bool stopped() const override { return to_.over(); }
    const Declarations& declarations() const override { return sketch_.declarations; }
    int colorSamples() const override { return sketch_.colorSamples; }
    scene::AttributesRef attributes() override { return sketch_.attributes; }
    int nextHandle() override { return ++serial_; }
    std::optional<Matrix> between(const std::string&, const std::string&) override { return {}; }
    void subdivide(const std::function<void(float)>& make, const std::vector<float>&, const Call& by) override {
        subdivideHere(*this, make, by);
    }
    void readArchive(const Call& c, const Lexer::Comments&) override { execute(c); }
    void record(const std::string& type, const std::string& text, const Call& by) override {
        if (type == "verbatim")
            reporter_.error(Rie::Unimplement, by.place, "RiArchiveRecord, called by a filter: \"verbatim\" is left out");
        else to_.comment(type, text);
    }
    std::string nameOf(int number) const override { return std::to_string(number); }

    std::string path_;
    std::unique_ptr<RifPlugin> plugin_;
    RifFilter& filter_;
    RequestReceiver& to_;
    Reporter reporter_;
    Sketch sketch_;
    std::map<std::string, RtPointer> handles_;
    int serial_ = 1'000'000; ///< names of the filter's own lights, which scenes hardly have
};

} // namespace

std::unique_ptr<RequestReceiver> loadRif(const std::string& path, std::vector<std::string> arguments, RequestReceiver& to,
                                         Diagnostics& reported, std::string& why) {
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL); // stays loaded: it may have threads of its own
    if (!handle) {
        const char* reason = dlerror();
        why = fmt::format("it cannot be loaded: {}", reason ? reason : "no reason was given");
        return nullptr;
    }
    const auto make = reinterpret_cast<RifPlugin* (*)(int, char**)>(dlsym(handle, "RifPluginManufacture"));
    if (!make) {
        why = "it does not define RifPluginManufacture";
        return nullptr;
    }
    std::vector<char*> words;
    for (std::string& a : arguments) words.push_back(a.data());
    words.push_back(nullptr);
    try {
        std::unique_ptr<RifPlugin> plugin(make(int(arguments.size()), words.data()));
        if (plugin) return std::make_unique<RifStage>(path, std::move(plugin), to, reported);
        why = "RifPluginManufacture gave nothing";
    } catch (const std::exception& e) { why = fmt::format("RifPluginManufacture threw: {}", e.what()); } catch (...) {
        why = "RifPluginManufacture threw";
    }
    return nullptr;
}

} // namespace alpenglow::ri

extern "C" RifPlugin* RifGetCurrentPlugin(void) { return alpenglow::ri::tPlugin; }
