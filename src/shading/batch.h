// A batch: points that one kernel shades together, in the layout of the kernel (rsl/kernel.h), and its outputs.
#pragma once
#include "rsl/front/protocol.h"
#include "rsl/kernel.h"
#include "shading/point.h"
#include <functional>
#include <map>
#include <span>

namespace alpenglow::shading {

/// Numeric parameters of a shader instance in current space, as flattened elements. Strings are compiled into the kernel.
struct ParameterBlock {
    std::map<std::string, std::vector<float>> numbers; ///< by parameter, element after element
    std::map<std::string, std::string> strings;        ///< by parameter
};

/// Resolves inputs of kind rsl::InputName::Kind::Space: one of the two spaces is "current".
class SpaceResolver {
public:
    virtual ~SpaceResolver() = default;
    /// Sets the matrix from `from` to `to`; returns false for unknown spaces. "object" and "shader" are those of the point.
    virtual bool matrix(const std::string& from, const std::string& to, Matrix& out) const = 0;
};

/// A moving shader space: its matrices, and parameters given in it, at times of the shutter (0 to 1); linear in between.
struct MovingSpace {
    std::vector<float> times;
    std::vector<Matrix> toCurrent; ///< shader space to "current", by time
    std::vector<ParameterBlock> parameters;
    /// The interval of keys that contains a time, by its first key, and in `way` the position in it, 0 to 1. Times outside are
    /// those of the ends.
    size_t keyAt(float time, float& way) const;
    /// Shader space to current at a time, element by element between keys.
    Matrix at(float time) const;
    /// Difference of a parameter's component between a time and the first time.
    float change(const std::string& parameter, size_t component, float time) const;
};

/// Per-instance data of the points in a batch, in addition to ShadePoint.
struct InstanceView {
    const ParameterBlock* parameters = nullptr; ///< null: the shader's defaults
    const Matrix* shaderToCurrent = nullptr;    ///< null: the shader was given in "current"
    const MovingSpace* moving = nullptr;        ///< null: constant in time
    const class ParameterRows* rows = nullptr;  ///< the parameters in the kernel's order; null: looked up by name
};

/// Sources of a kernel's inputs and positions of its rows: computed once for each kernel.
class BatchPlan {
public:
    /// mixed: points of one batch may belong to several instances.
    explicit BatchPlan(const rsl::CompiledKernel&, bool mixed);
    /// Index of an output, or -1.
    int output(const rsl::OutputName&) const;
    /// The same for a variable or a complete output parameter.
    int output(std::string_view name) const;
    int Ci = -1, Oi = -1, P = -1, N = -1;
    /// Whether the kernel reads du or dv.
    bool usesFootprint() const { return footprint_; }
    /// geometry::PointNeed: what the kernel reads of ShadePoint::surface, and of ShadePoint::lit.
    uint32_t needs() const { return needs_; }
    uint32_t litNeeds() const { return litNeeds_; }
    /// Whether the kernel reads only LightRows and parameters, and no parameter is overridden by a primitive variable.
    bool readsLightRows() const { return lightRows_; }
    /// Whether the kernel reads N.
    bool readsNormal() const { return normal_; }
    /// Whether a variable of the shape overrides a parameter.
    bool overriddenBy(const geometry::Shape&) const;
    /// The same for SurfaceRows, without time and motion. Parameters overridden by primitive variables are allowed.
    bool readsSurfaceRows() const { return surfaceRows_; }

private:
    friend class Batch;
    friend class ParameterRows;
    enum class From : uint8_t { Variable, Cs, Os, Parameter, Space, Displacement, Nothing };
    struct Source {
        From from = From::Nothing;
        bool scalar = false;
        bool varying = false; ///< a parameter that primitive variables may override
        bool array = false;
        rsl::ir::Kind kind = rsl::ir::Kind::Float; ///< of an element
        int components = 1, parts = 1, elements = 1;
        size_t rows = 0, firstRow = 0; ///< rows of `stride` floats
        size_t firstNumber = 0;        ///< Parameter: index in ParameterRows
        int16_t offset[6] = {-1, -1, -1,
                             -1, -1, -1}; ///< Variable: byte offset in ShadePoint, by part; -1: zero, -2: one, -3: three, -4: Ngs
        rsl::InputName name;
        /// Displacement: outputs of the displacement shader's run that supply the value, by element and part.
        struct Output {
            rsl::OutputName output;
            int element, part;
        };
        std::vector<Output> outputs;
    };
    std::vector<Source> inputs_;
    std::vector<size_t> outputRow_;
    std::vector<rsl::OutputName> outputs_;
    size_t rows_ = 0, numbers_ = 0; ///< in ParameterRows
    bool footprint_ = false;
    uint32_t needs_ = 0, litNeeds_ = 0;
    bool lightRows_ = true, surfaceRows_ = true, normal_ = false;
};

/// Inputs that most light kernels read: three rows each, one column for each point.
struct LightRows {
    /// A point without further data.
    struct Point {
        const geometry::Shape* shape;          ///< null: the light has no geometry
        const geometry::SurfacePoint& surface; ///< point on the light, camera space
        float shutter = 0;                     ///< time, 0 to 1 of the shutter
    };
    std::span<const float> P, N, Ps;
    size_t size() const { return P.size() / 3; }
    Point operator[](size_t) const;
};

/// Inputs that most surface kernels read: points on surfaces that do not move.
struct SurfaceRows {
    /// One of the points.
    struct Point {
        const geometry::Shape* shape;          ///< its shape
        const geometry::SurfacePoint& surface; ///< camera space
        float shutter = 0;                     ///< surfaces do not move, so it does not matter
    };
    std::span<const geometry::SurfacePoint> surfaces;
    std::span<const geometry::Shape* const> shapes; ///< by surface
    std::span<const float> I, E;                    ///< incident vector, and ray origin: three rows each
    std::span<const float> du, dv;                  ///< if the plan usesFootprint()
    /// The points.
    size_t size() const { return surfaces.size(); }
    Point operator[](size_t i) const { return {shapes[i], surfaces[i]}; }
};

/// A ParameterBlock in the order of a kernel's plan, so that no name is looked up during rendering. For batches of that plan
/// only, which must outlive it.
class ParameterRows {
public:
    /// Copies the values. The block may go afterwards.
    ParameterRows(const BatchPlan&, const ParameterBlock&);
    /// Null: for no kernel.
    const BatchPlan* plan() const { return plan_; }

private:
    friend class Batch;
    const BatchPlan* plan_;
    std::vector<float> numbers_; ///< of all parameters, flattened; missing ones are zero
};

/// A value for a parameter: as many elements as there are times the components of the kind. Texts are interned.
struct GivenValue {
    rsl::ir::Kind kind = rsl::ir::Kind::Float;
    bool array = false;             ///< then its elements replace the first ones of the parameter
    std::span<const float> numbers; ///< element after element; empty where texts are given
};

/// Aligned rows for inputs and outputs of one kernel call. Must outlive the call, including its suspensions.
class Batch {
public:
    Batch() = default;
    /// views[i] belongs to points[i]; with `mixed` false all are equal.
    Batch(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, std::span<const ShadePoint> points,
          std::span<const InstanceView> views, const SpaceResolver&);
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;
    /// Starts a new call in the memory of the last one. views[viewOf[i]] belongs to points[i]; viewOf empty: views[0] to all.
    /// Does not change the user data and callbacks of the call.
    void assign(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, std::span<const ShadePoint> points,
                std::span<const InstanceView> views, std::span<const uint32_t> viewOf, const SpaceResolver&);

    /// The same for a plan that readsLightRows(), with instances that do not move.
    void assign(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, const LightRows&,
                std::span<const InstanceView> views, std::span<const uint32_t> viewOf);
    /// The same for a plan that readsSurfaceRows(), with instances that do not move.
    void assign(std::shared_ptr<const rsl::CompiledKernel>, const BatchPlan&, const SurfaceRows&,
                std::span<const InstanceView> views, std::span<const uint32_t> viewOf, const SpaceResolver&);

    /// Fills inputs that come from the displacement shader, including derivatives, from its run at the same points.
    void takeDisplacement(const Batch& displaced);
    /// Overrides a parameter of that type at a point, if it is varying or an input of its own (rsl::InputName::sent); derivatives
    /// become 0. A parameter of another type is not changed.
    void give(std::string_view parameter, int point, const GivenValue&);

    /// The call to pass to the kernel; its rows belong to the batch.
    rsl::KernelCall& call() { return call_; }
    const rsl::CompiledKernel& kernel() const { return *kernel_; }
    int size() const { return call_.n; }
    const BatchPlan& plan() const { return *plan_; }
    /// Index of an output, or -1, as of the plan.
    int output(std::string_view name) const { return plan_->output(name); }
    int output(const rsl::OutputName& name) const { return plan_->output(name); }
    /// A component of an output at a point; components of an array follow each other by element.
    float value(int output, int component, int point) const { return out_[output][size_t(component) * call_.stride + point]; }
    /// A component of an output, by point.
    std::span<const float> row(int output, int component) const {
        return {out_[size_t(output)] + size_t(component) * size_t(call_.stride), size_t(call_.n)};
    }
    /// The first three components of an output at a point.
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
    // Points: std::span<const ShadePoint>, or SurfaceRows; for parameters also LightRows.
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
    size_t padded_ = 0;                 ///< points rounded up to complete strips of the kernel
    std::vector<float> valueOf_;        ///< by view: one component of the current parameter
    std::vector<const float*> numbers_; ///< by view: the current parameter
    std::vector<float> found_;          ///< storage for numbers_ looked up by name
    std::vector<const float*> in_;
    std::vector<float*> out_;
    rsl::KernelCall call_{};
};

} // namespace alpenglow::shading
