// The interface between generated code and the renderer. Plain C layout: generated code knows these offsets.
#pragma once
#include "base/limits.h"
#include "base/stopflag.h"
#include "rsl/front/connections.h"
#include "rsl/ir/ir.h"
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace alpenglow::rsl {

struct KernelCall;

/// Called by kernels for a Service, an Emit, a suspending Request, or the steps of a light loop.
/// `first`: index of the strip's first point in the batch; `mask`: bit i = point first + i is active (W <= 64 lanes).
/// in/out: arguments and results flattened, component after component, each W floats. Strings: interned ids (StringTable) as
/// bit-cast int32. Emit: in[0..3) is the weight. Returns nothing; must not throw.
using ServiceFn = void (*)(KernelCall*, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out);

/// Steps of an illuminance loop, in this order: begin gives the number of lights (the same for all lanes of the strip), then for
/// each light: fetch writes L, Cl, Ol (nine rows of W floats) and returns the mask of the lanes the body runs for; then end, also
/// when the loop is left early. Loops nest: fetch and end refer to the one that was begun last in the strip.
struct KernelCall {
    const float* const* in; ///< per Kernel::inputs: varying: component c, jet part j at in[k] + (c * parts + j) * stride;
                            ///< uniform (build S): in[k][c], arrays in[k][e * components + c]
    float* const* out;      ///< per Kernel::outputs: component c at out[k] + c * stride; lanes beyond n may be written (padding)
    int32_t n;              ///< points
    int32_t stride;         ///< floats between rows; a multiple of 64; rows are 64-byte aligned
    const int32_t* strings; ///< ids of the kernel's string constants (CompiledKernel::strings), in order
    void* user;             ///< the caller's
    ServiceFn service;      ///< answers calls of services, and takes pairs
    /// The steps of a loop, as above.
    int32_t (*lightBegin)(KernelCall*, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* pAxisAngle);
    uint64_t (*lightFetch)(KernelCall*, int32_t site, int32_t light, int32_t first, uint64_t mask, int32_t lanes, float* lClOl);
    void (*lightEnd)(KernelCall*, int32_t site, int32_t first, int32_t lanes);
    const StopFlag* stop;     ///< loops leave early when *stop != 0
    const int32_t* pairCount; ///< not used by generated code; room for the caller's bookkeeping
    /// Frames of suspending kernels: `bytes` of memory, 64-byte aligned, or null when there is none left (start then returns
    /// null). The KernelCall itself, and everything it points to, must stay valid until the coroutine is destroyed.
    void* (*alloc)(KernelCall*, uint64_t bytes);
    void (*release)(KernelCall*, void* frame, uint64_t bytes);
    void* memory; ///< CompiledKernel::run's, for arrays that the stack has no room for; callers leave it alone
};

/// Site numbers that `service` gets for the two operations on the strip's list of affine pairs.
/// Mark: out = one row, the number of pairs emitted so far for this strip. Rescale: in = row of the mark, three rows of factors,
/// row of the end mark: pairs between the two marks are multiplied, lane by lane (pairs of other lanes stay as they are).
inline constexpr int32_t kSiteMark = -1, kSiteRescale = -2;

/// Alignment of KernelCall::memory in bytes: that of the widest strip.
inline constexpr size_t kMemoryAlign = 256;

/// Memory for the large local arrays of a kernel while it runs.
struct LocalMemory {
    void* bytes; ///< aligned to kMemoryAlign
    /// size: bytes. Throws std::bad_alloc.
    explicit LocalMemory(uint64_t size) : bytes(::operator new(size, std::align_val_t(kMemoryAlign))) {}
    ~LocalMemory() { ::operator delete(bytes, std::align_val_t(kMemoryAlign)); }
    LocalMemory(const LocalMemory&) = delete;
    LocalMemory& operator=(const LocalMemory&) = delete;
};

/// Rows per component of a varying input: 1, 3 (v, du, dv) or 6 (v, du, dv, duu, duv, dvv). Inputs that are uniform by
/// declaration, matrices, strings and arrays have no derivatives: always 1 (in build V too, where component c of element e is row
/// e * components + c).
inline int inputParts(const ir::Input& i) {
    if (i.uniform || i.array != 0 || (i.kind != ir::Kind::Float && i.kind != ir::Kind::Triple)) return 1;
    return i.order == 0 ? 1 : i.order == 1 ? 3 : 6;
}

/// Strings at run time are ids. Ids are assigned in order of first use, never travel between processes; "" is 0. Thread safe.
int32_t internString(const std::string&);
/// The text of an id; valid for ever.
const std::string& internedString(int32_t id);
/// The same for a text that a shader made while it ran. Ids are never taken back, so all such texts together have a limit
/// (limits::kRuntimeStrings): beyond it a new text is "", and `full` is set.
int32_t internRuntimeString(const std::string&, bool& full);

/// A parameter with a value. Strings for string types, else numbers, element after element.
struct ParameterValue {
    std::string name; ///< of the parameter
    Type type;        ///< of the value
    std::vector<float> numbers;
    std::vector<std::string> strings; ///< element after element
};

/// A shader that other shaders call (3Delight manual, 6.4.9), with the values of its parameters.
struct CoShader {
    std::string handle;               ///< of the declaration
    const Program* program = nullptr; ///< its checked text; shared with the compiler
    const Shader* shader = nullptr;
    std::shared_ptr<const void> owner;                 ///< keeps both
    std::string digest;                                ///< of the shader's text
    std::map<std::string, std::vector<float>> numbers; ///< element after element
    std::map<std::string, std::string> strings;        ///< by parameter
    Connections connections;                           ///< of RIS
    std::vector<std::string> computed;                 ///< KernelOptions::computedParameters of this one
    std::string space;  ///< what the renderer calls its "shader" space; empty: that of the shader that calls
    bool light = false; ///< a light of the scene: the renderer determines its light and outputs
};

/// A parameter that gather() statements may send texts to, or an array whose length is open: InputName::sent.
struct SentParameter {
    std::string name; ///< of the parameter
    int room = 1;     ///< elements that come at most; of no array 1
    bool operator==(const SentParameter&) const = default;
};

/// What kind of machine code is wanted. All of it is part of the cache key.
struct KernelOptions {
    int lanes = 16;       ///< 4, 8 or 16: the width of the machine's vectors
    int vectors = 0;      ///< vectors in flight (K): the kernel works on lanes*K points at a time; 0 = chosen from the code
    bool mixed = false;   ///< build V: uniform inputs come in lanes
    int optimize = 2;     ///< 0 or 2
    bool suspend = false; ///< force the suspending form even where the affine one is possible (tests)
    /// User functions of more operations than this, called more than once, become functions of the machine code; smaller ones are
    /// inlined. 0: all that can be (tests). Never changes a bit of the result.
    int outline = limits::kOutlineInstructions;
    bool differences = false;         ///< derivatives are differences over du and dv, not exact (passes/differences.h)
    bool path = false;                ///< lobe shadeops (diffuse, specular, ...) are requests to the light transport engine
    std::vector<std::string> outputs; ///< requested; empty: what the shader kind gives (Ci Oi, P N, L Cl Ol, ...)
    /// The one output that affine requests are for: pairs (weight, request) are its own. A float has the sum of the three
    /// components.
    std::string light = "Ci";
    /// Values of string parameters, and of numeric ones known to be 0 or 1 for good: specialised into the code. Elements of
    /// arrays of strings are "name[0]", "name[1]" ...; "name[]" is the length of an array that the shader leaves open.
    std::vector<std::pair<std::string, std::string>> stringParameters;
    Connections connections;                    ///< parameters that take outputs of `coShaders`: part of the code
    std::vector<std::string> varyingParameters; ///< parameters overridden by varying primitive variables
    /// Parameters whose default the kernel computes for each sample (CompiledShader::computedParameters).
    std::vector<std::string> computedParameters;
    std::vector<SentParameter> sentParameters; ///< sorted by name
    std::vector<std::string> messages;         ///< output parameters that lights ask for by surface(), sorted
    std::vector<CoShader> coShaders;           ///< in the order of their handles
};

/// One compiled kernel. Immutable, shared between threads.
class CompiledKernel {
public:
    virtual ~CompiledKernel() = default;
    /// Of the kernel that it was compiled from.
    const std::vector<ir::Input>& inputs() const { return inputs_; }
    const std::vector<ir::OutputSlot>& outputs() const { return outputs_; }
    const std::vector<ir::Site>& sites() const { return sites_; }
    const std::vector<std::string>& files() const { return files_; }
    const ir::KernelFacts& facts() const { return facts_; }
    const std::vector<int32_t>& strings() const { return strings_; }
    int lanes() const { return lanes_; } ///< points per strip: KernelOptions::lanes * vectors
    /// It was read from disk.
    bool fromCache() const { return fromCache_; }

    /// Non-suspending kernels: shades all n points. Throws std::bad_alloc when there is no memory for the shader's arrays.
    void run(KernelCall* c) const {
        if (localBytes_ == 0) return entry_(c);
        const LocalMemory memory(localBytes_);
        c->memory = memory.bytes;
        entry_(c);
        c->memory = nullptr;
    }
    /// Suspending kernels: starts the strip that begins at point `first`. Frame memory comes from alloc/release of the call's
    /// scheduler. Returns the coroutine; done when finished(handle). A Request calls service (which notes it), then suspends;
    /// before resume the caller must have stored the results in the row block that service was given as `out`.
    void* start(KernelCall* c, int32_t first) const { return start_(c, first); }
    /// Runs to the next suspension or to the end.
    void resume(void* handle) const { resume_(handle); }
    /// Whether the strip has run to its end.
    bool finished(void* handle) const { return finished_(handle); }
    /// Frees the frame of a strip.
    void destroy(void* handle) const { destroy_(handle); }

protected:
    std::vector<ir::Input> inputs_;
    std::vector<ir::OutputSlot> outputs_;
    std::vector<ir::Site> sites_;
    std::vector<std::string> files_;
    ir::KernelFacts facts_;
    std::vector<int32_t> strings_;
    int lanes_ = 16;
    uint64_t localBytes_ = 0; ///< of KernelCall::memory
    bool fromCache_ = false;
    void (*entry_)(KernelCall*) = nullptr;
    void* (*start_)(KernelCall*, int32_t) = nullptr;
    void (*resume_)(void*) = nullptr;
    int32_t (*finished_)(void*) = nullptr;
    void (*destroy_)(void*) = nullptr;
};

} // namespace alpenglow::rsl
