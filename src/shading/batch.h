// A batch: points that one kernel shades together, laid out as the kernel reads them (rsl/kernel.h), and what came out.
#pragma once
#include "rsl/front/protocol.h"
#include "rsl/kernel.h"
#include "shading/point.h"
#include <functional>
#include <map>
#include <span>

namespace alpenglow::shading {

/// Values of a shader instance's numeric parameters, in current space: flattened elements. Strings are part of the kernel.
struct ParameterBlock {
    std::map<std::string, std::vector<float>> numbers;
    std::map<std::string, std::string> strings;
};

/// Resolves inputs of the kind rsl::InputName::Kind::Space: one of both is "current".
class SpaceResolver {
public:
    virtual ~SpaceResolver() = default;
    /// Matrix from `from` to `to`; null when there is no such space. "object" and "shader" are the point's own.
    virtual bool matrix(const std::string& from, const std::string& to, Matrix& out) const = 0;
};

/// Shader space that moves: its matrices, and the parameters that were given in it, at times of the shutter (0 to 1); between
/// them both are linear.
struct MovingSpace {
    std::vector<float> times;
    std::vector<Matrix> toCurrent;
    std::vector<ParameterBlock> parameters;
    size_t keyAt(float time, float& way) const;
    Matrix at(float time) const;
    /// What a number of a parameter is more at a time than at the first.
    float change(const std::string& parameter, size_t component, float time) const;
};

/// What the points of a batch may differ in beyond their ShadePoint: one an instance.
struct InstanceView {
    const ParameterBlock* parameters = nullptr;
    const Matrix* shaderToCurrent = nullptr;
    const MovingSpace* moving = nullptr;       ///< null: both are the same at all times
    const class ParameterRows* rows = nullptr; ///< the parameters again as the batch's kernel reads them; null: looked up by name
};

/// Where the inputs of a kernel come from and where its rows lie: worked out once per kernel.
class BatchPlan {
public:
    explicit BatchPlan(const rsl::CompiledKernel&, bool mixed);
    /// Index of an output, -1 when the kernel has none of that name.
    int output(const rsl::OutputName&) const;
    /// The same of a variable or a whole output parameter.
    int output(std::string_view name) const;
    int Ci = -1, Oi = -1, P = -1, N = -1;
    /// Whether du or dv is read.
    bool usesFootprint() const { return footprint_; }
    /// geometry::PointNeed: what of ShadePoint::surface is read, and of ShadePoint::lit.
    uint32_t needs() const { return needs_; }
    uint32_t litNeeds() const { return litNeeds_; }
    /// Whether LightRows and the values of parameters are all that is read, where no variable of a primitive stands for one.
    bool readsLightRows() const { return lightRows_; }
    /// Whether a variable of the shape has the name of a parameter that it may stand for.
    bool overriddenBy(const geometry::Shape&) const;
    /// The same for SurfaceRows: nothing of time and of what moves. Variables of primitives that stand
    /// for parameters are read as well.
    bool readsSurfaceRows() const { return surfaceRows_; }

private:
    friend class Batch;
    friend class ParameterRows;
    enum class From : uint8_t { Variable, Cs, Os, Parameter, Space, Told, Nothing };
    struct Source {
        From from = From::Nothing;
        bool scalar = false;
        bool varying = false; ///< a parameter that primitive variables may override
        int components = 1, parts = 1, elements = 1;
        size_t rows = 0, firstRow = 0; ///< rows of `stride` floats
        size_t firstNumber = 0;        ///< Parameter: of ParameterRows
        int16_t offset[6] = {-1, -1, -1,
                             -1, -1, -1}; ///< Variable: bytes into ShadePoint of each part; -1: zero, -2: one, -3: three, -4: Ngs
        rsl::InputName name;
        /// Told: outputs of the displacement shader's run that fill it, by element and part.
        struct Heard {
            rsl::OutputName output;
            int element, part;
        };
        std::vector<Heard> heard;
    };
    std::vector<Source> inputs_;
    std::vector<size_t> outputRow_;
    std::vector<rsl::OutputName> outputs_;
    size_t rows_ = 0, numbers_ = 0; ///< of ParameterRows
    bool footprint_ = false;
    uint32_t needs_ = 0, litNeeds_ = 0;
    bool lightRows_ = true, surfaceRows_ = true;
};

/// What kernels of lights mostly read: three rows each, as long as there are points.
struct LightRows {
    /// Of which nothing more is known.
    struct Point {
        const geometry::Shape* shape;
        const geometry::SurfacePoint& surface;
        float shutter = 0;
    };
    std::span<const float> P, N, Ps;
    size_t size() const { return P.size() / 3; }
    Point operator[](size_t) const;
};

/// What kernels of surfaces mostly read: points where rays met surfaces that stand still.
struct SurfaceRows {
    struct Point {
        const geometry::Shape* shape;
        const geometry::SurfacePoint& surface;
        float shutter = 0;
    };
    std::span<const geometry::SurfacePoint> surfaces;
    std::span<const geometry::Shape* const> shapes; ///< of these
    std::span<const float> I, E;                    ///< incident vector, and where the ray began: three rows each
    std::span<const float> du, dv;                  ///< where the plan usesFootprint()
    size_t size() const { return surfaces.size(); }
    Point operator[](size_t i) const { return {shapes[i], surfaces[i]}; }
};

/// A ParameterBlock as one kernel reads it: numbers in the order of its plan, so that none is looked for by name while rendering.
/// Only for batches of that plan, which must outlive it.
class ParameterRows {
public:
    ParameterRows(const BatchPlan&, const ParameterBlock&);
    const BatchPlan* plan() const { return plan_; }

private:
    friend class Batch;
    const BatchPlan* plan_;
    std::vector<float> numbers_; ///< of all parameters, flattened; absent ones are zero
};

/// Aligned rows for the inputs and outputs of one kernel call. Lives as long as the call, across suspensions.
class Batch {
public:
    Batch() = default;
    /// views[i] belongs to points[i]; with `mixed` false they are all the same.
    Batch(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, std::span<const ShadePoint> points,
          std::span<const InstanceView> views, const SpaceResolver&);
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;
    /// A new call in the memory of the last one. views[viewOf[i]] belongs to points[i]; viewOf empty: views[0] to all. What the
    /// call's user and functions are is left as it was.
    void assign(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, std::span<const ShadePoint> points,
                std::span<const InstanceView> views, std::span<const uint32_t> viewOf, const SpaceResolver&);

    /// The same for a plan that readsLightRows(), of instances that do not move.
    void assign(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, const LightRows&,
                std::span<const InstanceView> views, std::span<const uint32_t> viewOf);
    /// The same for a plan that readsSurfaceRows(), of instances that do not move.
    void assign(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, const SurfaceRows&,
                std::span<const InstanceView> views, std::span<const uint32_t> viewOf, const SpaceResolver&);

    /// Fills the inputs that the displacement shader gives from the outputs of its run at the same points, derivatives too.
    void tell(const Batch& displaced);
    /// Gives a varying parameter that has so many components another value at a point, without slope.
    void give(std::string_view parameter, int point, std::span<const float> value);

    rsl::KernelCall& call() { return call_; }
    const rsl::CompiledKernel& kernel() const { return *kernel_; }
    int size() const { return call_.n; }
    const BatchPlan& plan() const { return *plan_; }
    int output(std::string_view name) const { return plan_->output(name); }
    int output(const rsl::OutputName& name) const { return plan_->output(name); }
    float value(int output, int component, int point) const { return out_[output][size_t(component) * call_.stride + point]; }
    /// A component of an output, by point.
    std::span<const float> row(int output, int component) const {
        return {out_[size_t(output)] + size_t(component) * size_t(call_.stride), size_t(call_.n)};
    }
    Color color(int output, int point) const {
        return {value(output, 0, point), value(output, 1, point), value(output, 2, point)};
    }

private:
    struct Views {
        std::span<const InstanceView> views;
        std::span<const uint32_t> of;
        size_t index(int point) const { return of.empty() ? 0 : of[size_t(point)]; }
        const InstanceView& operator[](int point) const { return views[index(point)]; }
    };
    void layOut(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, size_t points);
    // Points: std::span<const ShadePoint>, or SurfaceRows; of parameters LightRows, too
    template <class Points> void fillInputs(const Points&, const Views&, const SpaceResolver&);
    template <class Points> void fill(const BatchPlan::Source&, float* row, const Points&, const Views&, const SpaceResolver&);
    template <class Points> void fillColor(const BatchPlan::Source&, float* row, const Points&);
    template <class Points>
    void fillSpace(const BatchPlan::Source&, float* row, const Points&, const Views&, const SpaceResolver&);
    void findParameter(const BatchPlan::Source&, const Views&);
    template <class Points> void fillParameter(const BatchPlan::Source&, float* row, const Points&, const Views&);
    template <class Points> void fillOverridden(const BatchPlan::Source&, float* row, const Points&, const Views&);
    void fillVariables(std::span<const ShadePoint>);
    void fillVariables(const SurfaceRows&);
    static void fillRow(const SurfaceRows&, int16_t offset, size_t component, size_t first, std::span<float> row);
    void pad(const BatchPlan::Source&, float* row);
    struct Free {
        void operator()(float* p) const { ::operator delete[](p, std::align_val_t(64)); }
    };
    std::shared_ptr<const rsl::CompiledKernel> kernel_;
    const BatchPlan* plan_ = nullptr;
    std::unique_ptr<float[], Free> storage_;
    size_t capacity_ = 0;               ///< floats
    bool primvars_ = false;             ///< some shape of the points has primitive variables
    size_t padded_ = 0;                 ///< points rounded up to whole strips of the kernel
    std::vector<float> valueOf_;        ///< by view: one component of it
    std::vector<const float*> numbers_; ///< by view: the parameter that is filled in
    std::vector<float> found_;          ///< what numbers_ points to where it was looked up
    std::vector<const float*> in_;
    std::vector<float*> out_;
    rsl::KernelCall call_{};
};

} // namespace alpenglow::shading
