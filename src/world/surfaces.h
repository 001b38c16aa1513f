// Shapes bound to what shades them: shaders, kernels, lights. What may be shaded together shares a binding.
#pragma once
#include "world/gathersite.h"
#include "world/impl.h"
#include "world/outputs.h"
#include <map>

namespace alpenglow::transport {

/// The first number of an attribute, or `fallback` where it is not set.
float attributeNumber(const scene::Attributes&, const std::string& key, float fallback);

/// Fills bindings_, bindingOf_ and what belongs to them, for the shapes of a world whose lights are bound.
class SurfaceBinder {
public:
    SurfaceBinder(WorldImpl& world, Evaluator& e, Diagnostics& d) : world_(world), evaluator_(e), diagnostics_(d) {}
    /// False when nothing can be rendered; that was reported.
    bool bindAll();

private:
    using Names = std::vector<std::string>;
    InstanceRef instanceOf(const scene::ShaderRef&, rsl::ShaderKind, bool differences = false);
    /// Attribute "shade" "derivatives": whether shaders take derivatives as grids have them. surfacedefaults.cpp
    bool differences(const geometry::Shape&, bool byDefault);
    /// Under path: whether nothing in the scene can give light, so that primitives without a surface are lit by the eye.
    bool needsHeadlight();
    /// The primitive variables that override parameters of a shader or that getvar(null, ...) finds; sorted.
    Names varyingOf(const geometry::Shape&, const ShaderInstance&);
    /// The binding of a shape: that of one with the same attributes and variables where there is one.
    int bind(const geometry::ShapeRef&);
    int bindAnew(const geometry::ShapeRef&);
    static std::string keyOf(const SurfaceBinding&, const geometry::Shape&, bool grid,
                             std::initializer_list<const Names*> varying);
    bool vanishes(const SurfaceBinding&) const; ///< SurfaceBinding::vanishes, of a shader that reads nothing
    Names outputsOf(const SurfaceBinding&) const;
    /// What gathers of the scene's surfaces ask other surfaces for.
    void findGathers();
    /// Adds the names that a kernel asks for by `op` ("surface", "displacement"). True when some are made only when it runs.
    static bool questions(const BoundKernel&, const char* op, std::set<std::string>& names);
    /// Where the surface or the atmosphere asks for outputs of the displacement shader: kernels that give and take them.
    void hearDisplacement(SurfaceBinding&, const Names& varying, const Names& displacementVarying, const Names& left);
    /// The same displacement, whose begin() prints nothing: the class prints when it shades.
    InstanceRef quiet(const InstanceRef& displacement);
    /// The outputs by which the displacement() of a class tells its other methods what it wrote to members
    /// (rsl/front/leftmembers.h).
    static Names leftBy(const SurfaceBinding&);
    /// The surface takes them.
    void hearMembers(SurfaceBinding&);
    /// Of the outputs of a surface, takes those away that displays ask for and that light reaches; they get kernels of their own.
    void partLightOutputs(SurfaceBinding&, Names& outputs, const Names& varying);
    LightOutput::Kernel lightKernel(const SurfaceBinding&, const LightOutput&, const Names& varying, bool mixed);
    /// Kernels for what subsurface() calls say by "irradiance". True.
    bool bindEntering();
    void bindEntering(SurfaceBinding&, const Names& varying);
    /// False when not even the default surface could be compiled.
    bool bindSurface(SurfaceBinding&, Names varying);
    void bindAtmosphere(SurfaceBinding&, const Names& varying);
    /// The kernel of a volume shader; no shader where it cannot run, which was reported.
    Medium bindVolume(const InstanceRef&, const Names& varying);
    /// The shader of an Interior or Exterior with what constant variables of the primitive override; null: none.
    InstanceRef volumeOf(const scene::ShaderRef&, const geometry::Shape&);
    /// WorldImpl::media_ of an Interior or Exterior; -1: none.
    int mediumOf(const InstanceRef&, const geometry::Shape&);
    /// `more`: outputs besides P, N and their derivatives.
    void bindDisplacement(SurfaceBinding&, const Names& varying, const Names& more);
    void bindLights(SurfaceBinding&, const scene::Attributes&);
    /// Batches of several bindings, or of points that see different spaces, need kernels whose uniform inputs come in lanes.
    bool bindMixed();
    /// What rays with a "hitmode" take. False when the shaders that ship were not found.
    bool bindHitModes();

    WorldImpl& world_;
    Evaluator& evaluator_;
    Diagnostics& diagnostics_;
    bool path_ = false;
    InstanceRef fallback_;
    std::map<std::tuple<const scene::ShaderCall*, int, bool>, InstanceRef>
        instances_; ///< by kind, and by how derivatives are taken
    std::map<std::pair<const void*, const void*>, InstanceRef>
        told_;                                 ///< surfaces that know the outputs of a displacement; by both
    std::map<const void*, InstanceRef> quiet_; ///< by the displacement that is not
    std::vector<InstanceRef> kept_;            ///< their addresses are keys
    std::map<std::pair<const void*, std::string>, InstanceRef>
        volumes_; ///< by the shader as the scene gave it and what overrides it
    std::map<std::string, int> bindingByKey_;
    GatheredNames gathered_;
    std::unordered_map<const scene::Attributes*, std::pair<geometry::ShapeRef, int>>
        bindingOfAttributes_; ///< of the last shape that had them
    std::map<std::vector<const void*>, int> programs_;
    std::map<scene::LightSet, int> lightLists_;
    std::map<std::pair<int, int>, int> groups_;
    /// What the kernels of a binding were asked for, by binding.
    struct Asked {
        Names outputs, varying;
        geometry::ShapeRef shape; ///< the first
    };
    std::vector<Asked> asked_;
};

} // namespace alpenglow::transport
