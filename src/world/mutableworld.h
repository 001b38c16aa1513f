// A world while it is built; worldbuilder.cpp has the order of the steps. Only this folder includes this.
#pragma once
#include "world/impl.h"

namespace alpenglow::world {

/// The members of WorldImpl, to be set, and the steps that set them. Nobody keeps one after World::build().
class MutableWorld final : public WorldImpl {
public:
    /// Sets what every world has: the frame, settings, services, camera, and the stores of maps, which are opened at first use.
    void begin(std::shared_ptr<const scene::Frame>, const Settings&, ServiceTable, Diagnostics&);
    /// Computes camera matrices from the frame's options.
    void setCamera(const scene::Options&);
    /// Computes the matrices of a kernel's spaces once, before the first ray, so that matrix() finds them in the table.
    void keepSpaces(std::span<const rsl::InputName> spaces);

    // Shaders and kernels
    /// The shader of a request with its parameters; null after an error. anyKind: the file may hold another kind than the request
    /// asks for.
    InstanceRef instance(const scene::ShaderCall&, rsl::ShaderKind, Diagnostics&, bool anyKind = false);
    /// Takes the values of a request, converted to current space.
    void setParameters(ShaderInstance&, const scene::ShaderCall&, Diagnostics&);
    /// Sets all parameters: these values, else defaults, which may be expressions.
    void takeValues(ShaderInstance&, const std::vector<rsl::ParameterValue>& given, Diagnostics&);
    /// Sets handles among these parameters to null that name neither one of `bound` nor a light, and reports an error with its
    /// place.
    void dropMissingHandles(const ShaderInstance& of, std::map<std::string, std::string>& texts,
                            const std::vector<std::pair<std::string, scene::ShaderRef>>& bound, Diagnostics&) const;
    /// An instance with the co-shaders of these attributes and, from these lights (indices in Frame::lights), the class lights
    /// with methods that it calls. Returns the instance itself if it uses no co-shaders.
    InstanceRef withCoShaders(const InstanceRef&, const std::map<std::string, scene::ShaderRef>& coshaders, Diagnostics&,
                              const scene::LightSet& lights = {});
    /// A shipped shader by name; null if it cannot be compiled (reported).
    InstanceRef builtin(const std::string& name, rsl::ShaderKind, Diagnostics&);
    /// What kernel() asks the compiler for.
    rsl::KernelOptions kernelOptions(const ShaderInstance&, const std::vector<std::string>& outputs,
                                     const std::vector<std::string>& varying, bool mixed, bool path) const;
    /// Compiles and binds a kernel; null if it cannot be compiled (reported). Joins its needs to needs().
    BoundKernel kernel(const ShaderInstance&, const std::vector<std::string>& outputs, const std::vector<std::string>& varying,
                       bool mixed, bool path, Diagnostics&, const std::string& light = "Ci");
    /// kernel() for points that no ray reaches: its needs are its own.
    BoundKernel kernelWithoutRays(const ShaderInstance&, const std::vector<std::string>& outputs,
                                  const std::vector<std::string>& varying, bool mixed, bool path, Diagnostics&,
                                  const std::string& light = "Ci");
    /// Warns if a shader divides by a parameter that is 0.
    void sayZeroDivisions(const ShaderInstance&, const rsl::KernelOptions&, Diagnostics&);
    /// Which outputs of an instance's kernel() receive requested light.
    std::vector<rsl::ir::OutputLight> lightOfOutputs(const ShaderInstance&, const std::vector<std::string>& outputs,
                                                     const std::vector<std::string>& varying, bool path) const;
    /// Compiles the imager of the frame. Its points are pixels.
    void bindImager(Diagnostics&);

    // Shapes
    /// Numbers the shapes, and finds whether some move.
    void numberShapes();
    /// Finds the bounds of deferred procedurals, and of all.
    void findProcedurals();
    /// For a bound surface shader that assigns P: the kernel that computes P alone, run at dicing. None if the shader leaves P
    /// unchanged, or if P depends on rays or on lights that cannot be evaluated then; the latter is reported.
    BoundKernel movingKernel(const ShaderInstance&, const BoundKernel&, const scene::LightSet&,
                             const std::vector<std::string>& varying, Diagnostics&);
    /// Makes the meshes that rays hit.
    void diceShapes(Diagnostics&);
    /// Whether dicing has to displace the shape.
    bool movesPoints(const SurfaceBinding&, const geometry::Shape&) const;
    /// Moves the points of a grid by the displacement shader, or by a surface shader that assigns P.
    void displaceGrid(const SurfaceBinding&, const geometry::Shape&, geometry::DiceGrid&, Diagnostics&) const;
    /// Whether no shader or light sends rays or needs points of complete surfaces, so that only camera rays exist. Call after
    /// binding surfaces.
    bool onlyCameraRays() const;
    /// Sets the point needs of lights and bindings, after all kernels are bound.
    void setPointNeeds();
    /// Sorts shapes by opacity; `visibility`: kinds of rays that hit a shape, by shape.
    void sortByOpacity(std::span<const uint32_t> visibility);
    /// Fills shadowVisibility(); arguments as above.
    void findShadowVisibility(std::span<const uint32_t> visibility);
    /// Attenuation of shadow rays by a shape. `mode`: "shader", "primitive", "opaque" or "Os"; "": by attributes.
    Opacity opacityOf(const SurfaceBinding&, const geometry::Shape&, std::string mode, const std::vector<std::string>& varying,
                      Evaluator&, Diagnostics&);
    /// Sets the photon visibility of surfaces; `visibility`: ray visibility, by shape. Defined in photonattributes.cpp.
    void bindPhotons(std::span<const uint32_t> visibility);
    /// Finds the media at the eye; requires the acceleration structure.
    void findEye();
    /// Reads the parameters of a homogeneous medium from its shader's outputs.
    void bindHomogeneous(Medium&, Evaluator&, Diagnostics&);

    // Lights
    /// Binds all lights; visibility: kinds of rays that can hit a shape.
    void bindLights(Diagnostics&, const std::function<uint32_t(const geometry::Shape&)>& visibility);
    /// photons: with the outputs of generatePhoton().
    BoundKernel lightKernel(const ShaderInstance&, bool photons, Diagnostics&);
    /// Compiles the kernel of the light's generatePhoton(), if it has one.
    void bindPhotons(BoundLight&, Diagnostics&);
    /// Finds the outputs of the kernel of one block of a shader.
    void bindLightOutputs(BoundLight&, int block);
    /// Adds to a list of the scene's lights the further blocks of their shaders.
    scene::LightSet withParts(const scene::LightSet& lights) const;
    /// Fills shining().
    void findShining();
    /// Builds the tables of skies (BoundLight::sky). Call before binding surfaces.
    void tabulateSkies(Evaluator&);
    /// Builds light kernels for the strings that loops of surfaces send. Call after all surfaces are bound.
    void bindSentStrings(Diagnostics&);
    /// Fills lightTraces().
    void countLightTraces();
    /// Estimates the brightness of lights, and finds area lights whose Cl is an intensity. Call after everything else.
    void measureLights(Evaluator&, Diagnostics&);
    void placeLights(Evaluator&); ///< finds positions of lights for sampling in media; call last
    /// Whether points on the light can be sampled.
    bool getsSamples(const BoundLight&) const;
    /// Makes the choosers of light lists and, if there are many lights, light groups; after measureLights().
    void makeChoosers(Diagnostics&);
    /// Fills lightGroups().
    void groupLights(Diagnostics&);

    /// Fills outputWidths(): number of components of each AOV in the shaders of the frame.
    void measureOutputs();

    // For the other classes and functions of this folder that build.
    using WorldImpl::accel_;
    using WorldImpl::allChooser_;
    using WorldImpl::allDeeper_;
    using WorldImpl::allOpaque_;
    using WorldImpl::allSampled_;
    using WorldImpl::bindingOf_;
    using WorldImpl::bindings_;
    using WorldImpl::byOpacity_;
    using WorldImpl::cameraToWorld_;
    using WorldImpl::clipFar_;
    using WorldImpl::clipNear_;
    using WorldImpl::clippingPlanes_;
    using WorldImpl::clouds_;
    using WorldImpl::deferred_;
    using WorldImpl::diagnostics_;
    using WorldImpl::emittersInAtmosphere_;
    using WorldImpl::evaluators_;
    using WorldImpl::eye_;
    using WorldImpl::facts_;
    using WorldImpl::fades_;
    using WorldImpl::globalMaps_;
    using WorldImpl::groups_;
    using WorldImpl::lightChannels_;
    using WorldImpl::lightGroups_;
    using WorldImpl::lightLists_;
    using WorldImpl::lightOutputs_;
    using WorldImpl::lights_;
    using WorldImpl::lightsAsk_;
    using WorldImpl::lightTraces_;
    using WorldImpl::maxDepth_;
    using WorldImpl::media_;
    using WorldImpl::mediaOverrule_;
    using WorldImpl::missingOutputs_;
    using WorldImpl::moves_;
    using WorldImpl::needs_;
    using WorldImpl::numberOfShape_;
    using WorldImpl::outputWidths_;
    using WorldImpl::photons_;
    using WorldImpl::primitiveHit_;
    using WorldImpl::rispecSpecular_;
    using WorldImpl::scatters_;
    using WorldImpl::sceneLights_;
    using WorldImpl::settings_;
    using WorldImpl::shadesAtOpen_;
    using WorldImpl::shadowVisibility_;
    using WorldImpl::shapes_;
    using WorldImpl::shining_;
    using WorldImpl::shutter_;
    using WorldImpl::skies_;
    using WorldImpl::textures_;
    using WorldImpl::traceSubsets_;
    using WorldImpl::wanted_;
    using WorldImpl::worldToCamera_;

    std::shared_ptr<rsl::ShaderCompiler> compiler_;             ///< of all shaders
    std::map<const scene::ShaderCall*, InstanceRef> coShaders_; ///< one instance for each request
    std::vector<std::string> lightMessages_; ///< parameters of surfaces that lights and atmospheres query, sorted
    /// Outputs of displacement shaders that lights query; "": names computed at run time.
    std::set<std::string> lightDisplacements_;
    size_t listed_ = 0; ///< total size of LightList::sampled

private:
    std::set<std::string> zeroDivisors_;                            ///< shaders, calls and parameters already checked
    std::map<std::vector<const void*>, InstanceRef> withCoShaders_; ///< by shader, then the requests of its co-shaders
};

} // namespace alpenglow::world
