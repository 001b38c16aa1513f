// Binds shapes to shaders, kernels and lights. Shapes that may be shaded together share a binding.
#pragma once
#include "world/gathersite.h"
#include "world/mutableworld.h"
#include "world/outputs.h"
#include <map>

namespace alpenglow::world {

/// The first number of an attribute, or `fallback` if it is not set.
float attributeNumber(const scene::Attributes&, const std::string& key, float fallback);

/// Fills bindings_, bindingOf_ and related members for the shapes of a world whose lights are bound.
class SurfaceBinder {
public:
    /// evaluator: runs kernels. All outlive this.
    SurfaceBinder(MutableWorld& world, Evaluator& e, Diagnostics& d) : world_(world), evaluator_(e), diagnostics_(d) {}
    /// Returns false after an error that prevents rendering; the error is reported.
    bool bindAll();

private:
    using Names = std::vector<std::string>;
    InstanceRef instanceOf(const scene::ShaderRef&, rsl::ShaderKind, bool differences = false);
    /// Attribute "shade" "derivatives": whether shaders use differences on grids. Defined in surfacedefaults.cpp.
    bool differences(const geometry::Shape&, bool byDefault);
    /// Under path: whether the scene has no light at all, so that primitives without a surface shader get a headlight.
    bool needsHeadlight();
    /// Primitive variables that override parameters of a shader, or that getvar(null, ...) reads; sorted.
    Names varyingOf(const geometry::Shape&, const ShaderInstance&);
    /// The binding of a shape: an existing one for equal attributes and variables, else a new one.
    int bind(const geometry::ShapeRef&);
    int bindAnew(const geometry::ShapeRef&);
    static std::string keyOf(const SurfaceBinding&, const geometry::Shape&, bool grid,
                             std::initializer_list<const Names*> varying);
    bool vanishes(const SurfaceBinding&) const; ///< SurfaceBinding::vanishes, for a shader that reads no inputs
    Names outputsOf(const SurfaceBinding&) const;
    /// Collects what gather() statements of the scene query from other surfaces.
    void findGathers();
    /// Adds the names that a kernel queries by `op` ("surface", "displacement"). Returns true if some names are computed at run
    /// time.
    static bool questions(const BoundKernel&, const char* op, std::set<std::string>& names);
    /// If the surface or the atmosphere queries outputs of the displacement shader: kernels that write and read them.
    void hearDisplacement(SurfaceBinding&, const Names& varying, const Names& displacementVarying, const Names& left);
    /// The same displacement whose begin() does not print, because the class prints when it shades.
    InstanceRef quiet(const InstanceRef& displacement);
    /// Outputs by which the displacement() method of a class passes its members to the other methods (rsl/front/leftmembers.h).
    static Names leftBy(const SurfaceBinding&);
    /// Makes the surface read them.
    void hearMembers(SurfaceBinding&);
    /// Removes from a surface's outputs those that displays request and that receive light; they get kernels of their own.
    void partLightOutputs(SurfaceBinding&, Names& outputs, const Names& varying);
    LightOutput::Kernel lightKernel(const SurfaceBinding&, const LightOutput&, const Names& varying, bool mixed);
    /// Builds kernels for the entering light of subsurface() calls with "irradiance". Returns true.
    bool bindEntering();
    void bindEntering(SurfaceBinding&, const Names& varying);
    /// Returns false if not even the default surface compiles.
    bool bindSurface(SurfaceBinding&, Names varying);
    void bindAtmosphere(SurfaceBinding&, const Names& varying);
    /// The kernel of a volume shader; null shader if it cannot run, which is reported.
    Medium bindVolume(const InstanceRef&, const Names& varying);
    /// The shader of an Interior or Exterior with overrides by constant variables of the primitive; null: none.
    InstanceRef volumeOf(const scene::ShaderRef&, const geometry::Shape&);
    /// Index in WorldImpl::media() of an Interior or Exterior; -1: none.
    int mediumOf(const InstanceRef&, const geometry::Shape&);
    /// `more`: outputs in addition to P, N and their derivatives.
    void bindDisplacement(SurfaceBinding&, const Names& varying, const Names& more);
    void bindLights(SurfaceBinding&, const scene::Attributes&);
    /// Builds V kernels, with uniform inputs in lanes, for batches of several bindings or of points with different spaces.
    bool bindMixed();
    /// Prepares opacity for rays with a "hitmode". Returns false if the shipped shaders are missing.
    bool bindHitModes();

    MutableWorld& world_;
    Evaluator& evaluator_;
    Diagnostics& diagnostics_;
    bool path_ = false;
    InstanceRef fallback_;
    std::map<std::tuple<const scene::ShaderCall*, int, bool>, InstanceRef>
        instances_; ///< by kind, and by how derivatives are computed
    std::map<std::pair<const void*, const void*>, InstanceRef>
        extended_;                                                       ///< surfaces with the outputs of a displacement; by both
    std::map<const void*, InstanceRef> quiet_;                           ///< by the original displacement
    std::vector<InstanceRef> kept_;                                      ///< keeps instances whose addresses are keys
    std::map<std::pair<const void*, std::string>, InstanceRef> volumes_; ///< by the scene's shader and its overrides
    std::map<std::string, int> bindingByKey_;
    /// Varying parameters of a shader at a shape. A shader that gather() sends texts to becomes one that takes them.
    Names receive(const geometry::Shape&, InstanceRef& shader, rsl::PairName::To);
    GatheredNames gathered_;
    std::map<std::pair<const ShaderInstance*, rsl::PairName::To>, InstanceRef> receiving_;
    std::unordered_map<const scene::Attributes*, std::pair<geometry::ShapeRef, int>>
        bindingOfAttributes_; ///< of the last shape with these attributes
    std::map<std::vector<const void*>, int> programs_;
    std::map<scene::LightSet, int> lightLists_;
    std::map<std::pair<int, int>, int> groups_;
    /// Requested outputs and varying parameters of a binding's kernels, by binding.
    struct Asked {
        Names outputs, varying;
        geometry::ShapeRef shape; ///< first shape of the binding
    };
    std::vector<Asked> asked_;
};

} // namespace alpenglow::world
