// A request becomes a call of a filter's function: its arguments in the order of C, whose types say how they are read. What the
// filter calls comes back by ri.h, as the calls of a library of procedurals do.
#include "ri/c/rif.h"
#include "ri/c/client.h"
#include "ri/requests/request.h"
#include <RifPlugin.h>
#include <algorithm>
#include <deque>
#include <dlfcn.h>
#include <exception>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <tuple>
#include <type_traits>

namespace alpenglow::ri {

namespace {

thread_local RifPlugin* tPlugin = nullptr;

/// Raised where C has no way to say what a request says: it passes by the filter.
struct NotInC {};

RtFilterFunc filterOf(const std::string& name) {
    static const std::map<std::string, RtFilterFunc> kFilters = {{"box", RiBoxFilter},
                                                                 {"triangle", RiTriangleFilter},
                                                                 {"catmull-rom", RiCatmullRomFilter},
                                                                 {"separable-catmull-rom", RiSeparableCatmullRomFilter},
                                                                 {"gaussian", RiGaussianFilter},
                                                                 {"sinc", RiSincFilter},
                                                                 {"bessel", RiBesselFilter},
                                                                 {"disk", RiDiskFilter},
                                                                 {"mitchell", RiMitchellFilter},
                                                                 {"blackman-harris", RiBlackmanHarrisFilter},
                                                                 {"lanczos", RiLanczosFilter}};
    const auto f = kFilters.find(name);
    if (f == kFilters.end()) throw NotInC();
    return f->second;
}

/// The arguments of a request, read one by one as C has them. Counts of arrays, which RIB leaves out, follow from these.
class Arguments {
public:
    Arguments(const Call& c, const Declarations& d, std::function<RtPointer(const std::string&)> handle)
        : call_(c), declarations_(d), handle_(std::move(handle)) {
        const std::vector<ArgSpec>& specs = c.request->args;
        for (size_t i = 0; i < specs.size(); ++i)
            if (specs[i].otherCount && c.given(i) && int(c.numbers(i).size()) == specs[i].otherCount) throw NotInC();
        if (isLight()) parameter("string __handleid", {.kind = Value::Kind::Strings, .strings = {c.text(1)}});
        const std::string category = !c.arguments.empty() && !c.arguments[0].strings.empty() ? c.text(0) : "";
        const bool classes = c.request->name == "Attribute" || c.request->name == "Option";
        for (const RawParam& p : c.params) parameter(p.token, p.value, classes ? category : "");
    }
    bool isLight() const { return call_.request->name == "LightSource" || call_.request->name == "AreaLightSource"; }

    template <class T> T next() {
        if constexpr (std::is_same_v<T, RtFloat>) return number(RI_INFINITY);
        else if constexpr (std::is_same_v<T, RtInt>) return integer();
        else if constexpr (std::is_same_v<T, RtBoolean>) return RtBoolean(integer());
        else if constexpr (std::is_same_v<T, RtToken>) return text();
        else if constexpr (std::is_same_v<T, RtFloat*>) return list<RtFloat>(floats_);
        else if constexpr (std::is_same_v<T, RtInt*>) return list<RtInt>(ints_);
        else if constexpr (std::is_same_v<T, RtToken*>) return texts();
        else if constexpr (std::is_same_v<T, RtFloat(*)[4]>) return matrix();
        else if constexpr (std::is_same_v<T, RtFilterFunc>) return filterOf(text());
        else if constexpr (std::is_same_v<T, RtPointer>) return handle_(text());
        else {
            static_assert(std::is_same_v<T, RtArchiveCallback>);
            return nullptr;
        }
    }
    RtInt count() const { return RtInt(tokens_.size()); }
    RtToken* tokens() { return tokens_.data(); }
    RtPointer* values() { return values_.data(); }

private:
    const Argument* now() const { return at_ < call_.arguments.size() ? &call_.arguments[at_] : nullptr; }
    void step() { ++at_, k_ = 0; }
    RtFloat number(RtFloat otherwise) {
        const Argument* a = now();
        if (!a || k_ >= a->numbers.size()) {
            if (a && a->given) throw NotInC();
            return otherwise;
        }
        const float f = toFloat(a->numbers[k_]);
        if (++k_ == a->numbers.size()) step();
        return f;
    }
    RtInt integer() {
        if (at_ >= call_.request->args.size()) return points();
        if (!call_.request->args[at_].array) return RtInt(number(0));
        const Argument* a = now();
        if (!a) return 0;
        const size_t n = std::max(a->numbers.size(), a->strings.size());
        return RtInt(call_.request->name == "ColorSamples" ? n / 3 : n);
    }
    /// Polygon and Points: as many as they have positions.
    RtInt points() const {
        for (const RawParam& p : call_.params) {
            const std::string name = p.token.substr(p.token.find_last_of(' ') + 1);
            const size_t each = name == "P" ? 3 : name == "Pw" ? 4 : name == "Pz" ? 1 : 0;
            if (each) return RtInt(p.value.numbers.size() / each);
        }
        throw NotInC();
    }
    RtToken text() {
        const Argument* a = now();
        if (!a || k_ >= a->strings.size()) throw NotInC();
        RtToken t = a->strings[k_].c_str();
        if (++k_ == a->strings.size()) step();
        return t;
    }
    template <class T> T* list(std::deque<std::vector<T>>& keep) {
        const Argument* a = now();
        step();
        std::vector<T>& v = keep.emplace_back();
        if (a)
            for (double d : a->numbers) v.push_back(T(toFloat(d)));
        return v.data();
    }
    RtToken* texts() {
        const Argument* a = now();
        step();
        std::vector<RtToken>& v = texts_.emplace_back();
        if (a)
            for (const std::string& s : a->strings) v.push_back(s.c_str());
        return v.data();
    }
    RtFloat (*matrix())[4] {
        const Argument* a = now();
        if (a && !a->strings.empty()) {
            static const std::map<std::string, RtFloat(*)[4]> kBases = {{"bezier", RiBezierBasis},
                                                                        {"b-spline", RiBSplineBasis},
                                                                        {"catmull-rom", RiCatmullRomBasis},
                                                                        {"hermite", RiHermiteBasis},
                                                                        {"power", RiPowerBasis}};
            const auto b = kBases.find(text());
            if (b == kBases.end()) throw NotInC();
            return b->second;
        }
        if (!a || a->numbers.size() != 16) throw NotInC();
        return reinterpret_cast<RtFloat(*)[4]>(list<RtFloat>(floats_));
    }
    void parameter(const std::string& token, const Value& v, const std::string& category = {}) {
        const bool connects = token.starts_with("reference ");
        const Resolved r = declarations_.resolve(token, category);
        const bool isText = connects || v.kind == Value::Kind::Strings;
        tokens_.push_back(keptTokens_.emplace_back(token).c_str());
        if (isText) {
            std::vector<RtToken>& t = texts_.emplace_back();
            for (const std::string& s : v.strings) t.push_back(keptTokens_.emplace_back(s).c_str());
            values_.push_back(const_cast<RtToken*>(t.data()));
        } else if (r.declaration && r.declaration->type == scene::Type::Integer) {
            std::vector<RtInt>& n = ints_.emplace_back();
            for (double d : v.numbers) n.push_back(RtInt(std::clamp(d, -2147483648., 2147483647.)));
            values_.push_back(n.data());
        } else {
            std::vector<RtFloat>& n = floats_.emplace_back();
            for (double d : v.numbers) n.push_back(toFloat(d));
            values_.push_back(n.data());
        }
    }

    const Call& call_;
    const Declarations& declarations_;
    std::function<RtPointer(const std::string&)> handle_;
    size_t at_ = 0, k_ = 0; ///< the next argument, and its next value
    std::deque<std::string> keptTokens_;
    std::deque<std::vector<RtFloat>> floats_;
    std::deque<std::vector<RtInt>> ints_;
    std::deque<std::vector<RtToken>> texts_;
    std::vector<RtToken> tokens_;
    std::vector<RtPointer> values_;
};

/// Calls a function with the arguments of its request. The handle that it gives; null: none.
template <class R, class... A, size_t... I> RtPointer callWith(R (*f)(A...), Arguments& a, std::index_sequence<I...>) {
    using Types = std::tuple<A...>;
    constexpr size_t n = sizeof...(A);
    constexpr bool pairs = [] {
        if constexpr (n >= 3) return std::is_same_v<std::tuple_element_t<n - 1, Types>, RtPointer*>;
        else return false;
    }();
    const auto one = [&]<size_t K>(std::integral_constant<size_t, K>) -> std::tuple_element_t<K, Types> {
        if constexpr (pairs && K + 3 == n) return a.count();
        else if constexpr (pairs && K + 2 == n) return a.tokens();
        else if constexpr (pairs && K + 1 == n) return a.values();
        else return a.next<std::tuple_element_t<K, Types>>();
    };
    Types all{one(std::integral_constant<size_t, I>())...}; // in their order
    if constexpr (std::is_void_v<R>) {
        std::apply(f, all);
        return nullptr;
    } else {
        return std::apply(f, all);
    }
}
template <class R, class... A> RtPointer callWith(R (*f)(A...), Arguments& a) {
    return callWith(f, a, std::index_sequence_for<A...>());
}

struct Function {
    std::string_view request;
    bool (*given)(const RifFilter&);
    RtPointer (*call)(const RifFilter&, Arguments&);
};

/// Of RifFilter's members, the request of each: without the V of the vector form.
constexpr std::string_view requestOf(std::string_view member) {
    return member.ends_with('V') ? member.substr(0, member.size() - 1) : member;
}

#define RIF(member)                                                                                                              \
    Function{requestOf(#member), [](const RifFilter& f) { return f.member != nullptr; },                                         \
             [](const RifFilter& f, Arguments& a) { return callWith(f.member, a); }},
const Function kFunctions[] = {
    RIF(FrameBegin) RIF(FrameEnd) RIF(WorldBegin) RIF(WorldEnd) RIF(AttributeBegin) RIF(AttributeEnd) RIF(TransformBegin)
        RIF(TransformEnd) RIF(SolidBegin) RIF(SolidEnd) RIF(ObjectEnd) RIF(MotionBeginV) RIF(MotionEnd) RIF(ResourceBegin)
            RIF(ResourceEnd) RIF(ResourceV) RIF(IfBeginV) RIF(ElseIfV) RIF(Else) RIF(IfEnd) RIF(Format) RIF(FrameAspectRatio) RIF(
                ScreenWindow) RIF(CropWindow) RIF(ProjectionV) RIF(Clipping) RIF(ClippingPlane) RIF(DepthOfField) RIF(Shutter)
                RIF(PixelVariance) RIF(PixelSamples) RIF(PixelFilter) RIF(Exposure) RIF(ImagerV) RIF(Quantize) RIF(DisplayV)
                    RIF(DisplayChannelV) RIF(HiderV) RIF(ColorSamples) RIF(RelativeDetail) RIF(OptionV) RIF(CameraV) RIF(Color)
                        RIF(Opacity) RIF(TextureCoordinates) RIF(ShadingRate) RIF(ShadingInterpolation) RIF(Matte) RIF(Bound)
                            RIF(Detail) RIF(DetailRange) RIF(GeometricApproximation) RIF(GeometricRepresentation) RIF(Orientation)
                                RIF(ReverseOrientation) RIF(Sides) RIF(Basis) RIF(TrimCurve) RIF(AttributeV) RIF(SurfaceV) RIF(
                                    DisplacementV) RIF(AtmosphereV) RIF(InteriorV) RIF(ExteriorV) RIF(ShaderV) RIF(LightSourceV)
                                    RIF(AreaLightSourceV) RIF(Illuminate) RIF(BxdfV) RIF(PatternV) RIF(DisplaceV) RIF(LightV)
                                        RIF(LightFilterV) RIF(EnableLightFilter) RIF(IntegratorV) RIF(DisplayFilterV)
                                            RIF(SampleFilterV) RIF(PixelSampleImagerV) RIF(VPAtmosphereV) RIF(
                                                VPInteriorV) RIF(VPSurfaceV) RIF(Identity) RIF(Transform) RIF(ConcatTransform)
                                                RIF(Perspective) RIF(Translate) RIF(Rotate) RIF(Scale) RIF(Skew) RIF(DeformationV)
                                                    RIF(CoordinateSystem) RIF(ScopedCoordinateSystem) RIF(CoordSysTransform)
                                                        RIF(PolygonV) RIF(GeneralPolygonV) RIF(PointsPolygonsV)
                                                            RIF(PointsGeneralPolygonsV) RIF(PatchV) RIF(PatchMeshV) RIF(NuPatchV)
                                                                RIF(SubdivisionMeshV) RIF(HierarchicalSubdivisionMeshV)
                                                                    RIF(SphereV) RIF(ConeV) RIF(CylinderV) RIF(HyperboloidV)
                                                                        RIF(ParaboloidV) RIF(DiskV) RIF(TorusV) RIF(PointsV)
                                                                            RIF(CurvesV) RIF(BlobbyV) RIF(GeometryV) RIF(VolumeV)
                                                                                RIF(ReadArchiveV) RIF(MakeTextureV) RIF(MakeBumpV)
                                                                                    RIF(MakeLatLongEnvironmentV) RIF(MakeShadowV)
                                                                                        RIF(MakeBrickMapV) RIF(MakeOcclusionV)};
#undef RIF
static_assert(sizeof(RifFilter) == 2 * sizeof(void*) + std::size(kFunctions) * sizeof(void*), "a member has no request");

const Function* functionOf(std::string_view request) {
    const auto f =
        std::find_if(std::begin(kFunctions), std::end(kFunctions), [&](const Function& x) { return x.request == request; });
    return f == std::end(kFunctions) ? nullptr : f;
}

class RifStage final : public RequestReceiver, private Target {
public:
    RifStage(std::string path, std::unique_ptr<RifPlugin> plugin, RequestReceiver& to, Diagnostics& said)
        : path_(std::move(path)), plugin_(std::move(plugin)), filter_(plugin_->GetFilter()), to_(to), reporter_(said) {}

    void request(const Call& c) override {
        const Function* f = functionOf(c.request->name);
        if (!f || (!f->given(filter_) && filter_.Filtering == RifFilter::k_Continue)) return execute(c);
        if (!f->given(filter_)) return;
        const CallsTo calls(*this, c.place, ", called by a filter");
        RifPlugin* const outer = std::exchange(tPlugin, plugin_.get());
        try {
            Arguments a(c, sketch_.declarations, [this](const std::string& text) { return handleOf(text); });
            const RtPointer handle = f->call(filter_, a);
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
    /// The light that requests call so. One that has passed by the filter gets a handle when it is asked for.
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
                                         Diagnostics& said, std::string& why) {
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
        if (plugin) return std::make_unique<RifStage>(path, std::move(plugin), to, said);
        why = "RifPluginManufacture gave nothing";
    } catch (const std::exception& e) { why = fmt::format("RifPluginManufacture threw: {}", e.what()); } catch (...) {
        why = "RifPluginManufacture threw";
    }
    return nullptr;
}

} // namespace alpenglow::ri

extern "C" RifPlugin* RifGetCurrentPlugin(void) { return alpenglow::ri::tPlugin; }
