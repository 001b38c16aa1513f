// Lowers the syntax tree to instructions, one subject a file: build*.cpp. Not for others.
#pragma once
#include "rsl/ir/complaint.h"
#include "rsl/ir/function_builder.h"
#include "shadeops/distributions.h"
#include <cmath>
#include <deque>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>

namespace alpenglow::rsl {
struct Connected;
struct OutputName;
} // namespace alpenglow::rsl

namespace alpenglow::rsl::ir {

/// A call of a shader's own function whose result is an array.
inline bool returnsArray(const Expr& e) {
    return e.kind == ExprKind::FunctionCall && e.function && e.function->result.array != 0;
}

/// A lobe call to be inlined even under path: its place.
using DirectSet = std::set<std::tuple<int, int, int>>;

/// A constant index in words, of whatever size.
inline std::string indexText(float x) { return fmt::format("{:.9g}", std::trunc(x) + 0.f); }

/// From the checked tree of one shader to the IR of one kernel; used once.
class Builder final : FunctionBuilder {
public:
    /// k: receives the code, empty before. direct: calls that stay direct.
    Builder(Kernel& k, const Program& p, const Shader& s, const KernelOptions& o, Diagnostics& d, const DirectSet& direct)
        : FunctionBuilder(k, p.files, o, d), program_(p), shader_(s), direct_(direct) {}
    /// Builds the kernel of the shader. False after an error, which is reported.
    bool buildShader();
    /// Builds a kernel whose outputs are the values of all parameters, given those of the scene.
    bool buildDefaults(const std::vector<ParameterValue>& given);
    /// The value that the scene gives a parameter, or its default; length: of an array of open length.
    Inst* givenValue(const Symbol&, const ParameterValue&);
    Inst* defaultValue(const ShaderParameter&, int length);

private:
    // build_shader.cpp
    Inst* initialGlobal(const std::string& name, Type) override;
    void bindParameters(const std::set<int>& assigned);
    Inst* copyOfInput(Inst* array, Base);
    Inst* parameterValue(const ShaderParameter&);
    Inst* sentValue(const ShaderParameter&, Inst* usual, int room);
    Inst* ownValue(const ShaderParameter&);
    Inst* constantParameter(const Symbol&, const std::string& text);
    Inst* constantTexts(const std::string& name, int length, std::span<const std::pair<std::string, std::string>> given);

    // build_stmt.cpp
    size_t statements(const std::vector<StmtPtr>&, size_t from, int depth = 0);
    void statement(const Stmt&);
    void declare(const Stmt&);
    void loop(const Expr* condition, const Expr* step, const Stmt* body, const Place&);
    /// A loop as it is built. Any but goesOn and turn may be missing; begin comes when the loop's own flags are there.
    struct Turns {
        std::function<void()> begin, turn, next;
        std::function<Inst*()> goesOn;
    };
    /// `assigned`: slots that a turn may change; `jumps`: whether one may break, continue or return.
    void turns(std::set<int>& assigned, bool jumps, const Turns&, const Place&);
    static bool jumps(const Stmt&);
    void gather(const Stmt&); // build_gather.cpp
    /// A pair of a statement whose name is known.
    struct Pair {
        std::string name;
        const Expr* value; ///< may be null
        bool output;
        Place place;
    };
    std::vector<Pair> pairsOf(const Stmt&); // build_names.cpp
    bool nameArgument(const Shadeop&, NamedArg&, const std::string& text);
    ExprPtr namedNow(const Expr&, std::vector<std::pair<size_t, Inst*>>& open);
    const Expr& withNames(const Expr&);
    Inst* callByNames(const Expr&);
    Inst* chooseNames(ExprPtr, std::span<const std::pair<size_t, Inst*>> open);
    std::vector<ExprPtr> named_; ///< calls that were built with names that had been made
    void send(Site&, std::vector<Inst*>& args, const Pair&);
    std::set<int> assignedByGather(const Stmt&);
    int gathers_ = 0; ///< built so far
    struct GatherCall;
    GatherCall gatherCall(const Stmt&);
    void gatherTurn(const Stmt&, GatherCall&, Inst* ray);
    struct Illuminance; // build_illuminance.cpp
    void illuminance(const Stmt&);
    void lightBlock(const Stmt&);
    Inst* inCone(Inst* axis, Inst* angle);
    void findBlocks(const Stmt&);
    int addBlock(const Stmt&);
    Inst* within(Inst* angle);
    Inst* alive();
    void scanAssigned(const Stmt&, std::set<int>& out, std::set<const Function*>& seen);
    void scanAssigned(const Expr&, std::set<int>& out, std::set<const Function*>& seen);
    void scanChannels(const Expr& call, std::set<int>& out);
    bool hasEffects(const Expr&);
    /// Loop or LightLoop around `body`: `fixed` region parameters come before the carried ones.
    struct LoopFrame {
        int broken = -1, continued = -1;
    };
    struct Frame {
        int returned = -1;
        int result = -1;
        Inst* array = nullptr; ///< the result of a function that returns an array
        Type type;
        std::vector<LoopFrame> loops;
        const Function* function = nullptr;
    };

    // build_expr.cpp
    Inst* expr(const Expr&);
    Inst* expr(const Expr& e, Kind k) { return coerce(expr(e), k); }
    Inst* condition(const Expr&);
    Inst* array(const Expr&);
    void assign(const Expr& lvalue, Inst* value);
    /// While it lives the indices of a place have the values that they had when it was made: what they do they do once, and what
    /// is read and then written is the same element, whatever happens in between. The place need not have any.
    class Held {
    public:
        Held(Builder& b, const Expr& place) : builder_(b) { hold(place); }
        Held(const Held&) = delete;
        Held& operator=(const Held&) = delete;
        ~Held() {
            for (const Expr* e : indices_) builder_.held_.erase(e);
        }
        /// The same place, written down a second time.
        void again(const Expr& place, const Expr& copy);

    private:
        void hold(const Expr& place);
        Builder& builder_;
        std::vector<const Expr*> indices_;
    };
    friend class Held;
    std::unordered_map<const Expr*, Inst*> held_;
    void copyArray(Inst* to, const Expr& from);
    Inst* both(const Expr&);
    Inst* binary(const Expr&, Inst* a, Inst* b);
    Inst* binary(const Expr&);
    Inst* arrayElement(const Expr&);
    void checkIndex(const Expr& index, const Inst* array, const Inst* at);
    Inst* assignment(const Expr&);
    Inst* tuple(const Expr&);
    Inst* conditional(const Expr&);
    Inst* sequence(const Expr&);

    // build_spaces.cpp
    /// The matrix from one named space to another, an input.
    Inst* space(const std::string& from, const std::string& to);
    Inst* toSpace(const std::string& from, const std::string& to, Inst*, Base, const Place&);
    Inst* ownSpace(Inst* name);
    Inst* dynamicSpace(const char* op, Inst* from, Inst* to, Inst* value, Base);
    Inst* inSpace(const Expr& space, Inst* value, Base);
    int arrayLength(const Inst* array) const;

    // build_arrays.cpp: arrays that change their length
    struct Lengths {
        int length, reserved; ///< slots
        int id;               ///< among the kernel's arrays of this sort, for the services of spilledarrays.h
    };
    int growing_ = 0;      ///< arrays with an id
    bool unbound_ = false; ///< after largestResize(): some array may outgrow its storage
    Inst* spilled(const char* op, const Inst* array, Inst* at, Inst* value);
    Inst* loadElement(Inst* array, Inst* index);
    void storeElement(Inst* array, Inst* index, Inst* value);
    Inst* resized(const Inst* array, Inst* wanted);
    void copyBehind(Inst* to, Inst* from, Inst* length);
    void refuseLonger(const Inst* array, const Place&, const std::string& where);
    int largestResize();
    bool grows(const Stmt::Declarator&);
    bool lengthKnown(const Inst* a) const {
        const Lengths* l = lengths(a);
        if (given_.count(a)) return false;
        return !l || (value(l->length) && isConst(value(l->length)));
    }
    Inst* newResizable(Base, int length);
    int parameterLength(const ShaderParameter&, std::span<const std::pair<std::string, std::string>> given) const;
    std::map<const Inst*, int>
        given_; ///< arrays of parameters of open length (`float w[] = {}`), which have the length that the instance gives
    const Lengths* lengths(const Inst* array) const;
    Inst* lengthOf(const Inst* array);
    Inst* elementOf(const Inst* array, Inst* index);
    Inst* limitLength(const Inst* array, Inst* wanted);
    void copyResizable(Inst* to, const Expr& from);
    Inst* resizing(const Expr&);
    void addLengths(std::set<int>& slots) const;

    // build_call.cpp
    Inst* functionCall(const Expr&);
    std::vector<int> sharedOutputs(const Function&, const std::vector<const Expr*>& args);
    Inst* inlineFunction(const Function&, const std::vector<const Expr*>& args, Inst** array = nullptr);
    // build_outline.cpp: functions that stay functions
    /// A user function as a Function instruction, for one set of constant strings.
    struct Outlined {
        Inst* function = nullptr;  ///< null: it must be inlined
        std::vector<int> inputs;   ///< slots whose values are passed behind the arguments
        std::vector<int> assigned; ///< slots that get results behind those of the output parameters
    };
    /// What is to be known about a function from its text, with everything it calls.
    struct CallFacts {
        bool possible = true;   ///< it calls neither services nor rays nor lights
        double size = 0;        ///< nodes of the tree once everything is inlined
        std::set<int> free;     ///< slots of variables from outside
        std::set<int> assigned; ///< those of them that it sets
    };
    struct Scan {
        CallFacts callFacts;
        std::set<const Symbol*> used, own;
    };
    const CallFacts& callFacts(const Function&);
    const Scan& scan(const Function&);
    void scan(const Stmt&, Scan&);
    void scan(const Expr&, Scan&);
    void include(const Function&, Scan&);
    bool outlined(const Function&, const std::vector<Inst*>& values, Inst*& result, std::vector<Inst*>& outputs);
    bool makeFunction(const Function&, const std::vector<Inst*>& values, const CallFacts&, Outlined&);
    bool selfContained(const Region&) const;

    // build_handles.cpp: co-shaders
    struct Instance {
        const CoShader* binding;
        const std::vector<std::string>* files;
        int fileBase;                                 ///< where they begin among the kernel's
        std::unordered_map<const Symbol*, int> slots; ///< two instances of one shader have variables of their own
    };
    Type typeOfMember(const Expr&);
    bool certain_ = true;                                   ///< forHandle(): the handle is known
    bool anyHandle_ = false;                                ///< forHandle(): it may be that of any shader
    std::map<const Inst*, std::vector<std::string>> texts_; ///< arrays of texts that nothing writes to: their elements
    std::optional<std::set<const Symbol*>> written_;
    bool everWritten(const Symbol&);
    void noteTexts(const Inst* array, const Symbol&, int length, std::span<const std::pair<std::string, std::string>> given);
    bool possibleTexts(const Inst*, std::set<std::string>& out, int depth = 0) const;
    void complain(const Place&, const Raised&);
    Inst* handleText(const Expr&);
    Inst* answered(Site, std::vector<Inst*> args, Kind, const Expr* to);
    Inst* ofSurface(const Expr& handle, const std::string& name, Kind, const Expr* to);
    CoShader selfBinding_;        ///< of the shader itself, under the name that `this` has
    std::vector<size_t> current_; ///< the instances whose methods are open; the shader itself where there is none
    std::unordered_map<const Symbol*, int> ownSlots_; ///< the shader's, while those of a co-shader count
    bool isSelf(size_t i) const { return instances_[i].binding == &selfBinding_; }
    std::string thisHandle() const;
    void switchInstance(bool fromSelf, size_t from, bool toSelf, size_t to);
    void enterInstance(size_t);
    void leaveInstance();
    void beginCoShaders();
    void beginInstance(size_t);
    // build_network.cpp: parameters that take outputs of co-shaders
    enum class Pattern { Waits, Runs, Done };
    std::vector<Pattern> pattern_; ///< by instance
    std::set<std::string> connectedHandles() const;
    bool runPattern(size_t instance);
    Inst* connectedOutput(const Connected&, const Symbol& to);
    Inst* connected(const Symbol&, int element, const Connections&);
    Inst* connectedParameter(const Symbol&);
    Inst* connectedParameter(const Symbol&, const CoShader& of);
    void connectElements(const Symbol&, Inst* array, const CoShader& of);
    Inst* forHandle(const Expr& handle, Kind, const std::function<Inst*(size_t)>& code,
                    const std::function<Inst*(Inst* handle)>& light = nullptr);
    struct MethodCall; // build_methods.cpp
    static bool argumentsOf(const Function&, const Expr& call, std::vector<const Expr*>& given);
    const Function* methodOf(size_t instance, const Expr& call) const;
    const Symbol* memberOf(size_t instance, const std::string& name) const;
    Inst* memberValue(size_t instance, const Symbol&);
    /// A member that a co-shader does not have. error: if the call is certain; whenRun: printed if the running shader reaches it.
    struct Missing {
        Raised error, whenRun;
    };
    Missing noMember(size_t instance, const std::string& name) const;
    Missing otherType(size_t instance, const Symbol& has, const std::string& name, const std::string& wanted) const;
    void reportMissing(const Place&, size_t instance, const Missing&, const std::function<bool(size_t)>& has);
    Inst* methodCall(const Expr&);
    Inst* memberAccess(const Expr&);
    Inst* memberArray(const Expr&);
    Inst* memberLength(const Expr&);
    Inst* memberElement(const Expr&);
    bool takeArray(const Expr& to, Inst* from);
    Inst* getVariable(const Expr&);
    Inst* primitiveVariable(const std::string& name, const Expr* to);
    // build_messages.cpp
    bool queriedDisplacement(const Expr& call, const std::string& name, Inst*& found);
    Inst* askPrimitive(Inst* name, const Expr* to);
    /// Rows that a variable takes from a service, and what puts them there where the first row, 0 or 1, says so.
    struct Receiver {
        const Expr* to = nullptr;
        int rows = 0; ///< results that it takes
    };
    Receiver receiver(Site&, const Expr& to, const std::string& name);
    void receive(const Receiver&, std::span<Inst* const> values, Inst* found);
    Inst* readPrimitiveVariable(const Expr&);
    // build_left.cpp: members that displacement() passes on
    Inst* leftBehind(const std::string& name, Type&);
    void hearMembers();
    void objectBody(bool opacityOnly);
    Inst* evalParameter(const Expr&); // build_parameters.cpp
    Inst* hasMethod(const Expr&);
    Inst* getShader(const Expr&);
    std::vector<Inst*> handlesOf(const Expr&, std::vector<Inst*>* when = nullptr);
    Inst* storeHandles(Inst* to, const Expr&);
    std::vector<const Symbol*> membersOf(size_t instance) const;
    bool mayFill(const Expr& call, size_t argument) const;
    void scanMethod(const Expr&, std::set<int>& out);
    // build_lighthandles.cpp: lights by their handles
    Inst* lightMethod(const Expr& call, Inst* handle);
    Inst* lightMember(Inst* handle, Inst* name, Kind, const Expr* to, Inst* at = nullptr);
    Inst* getLight(const Expr&);
    std::vector<Inst*> lightHandles(const Expr&);
    Inst* isLightCategory(const Expr&);

    // build_channels.cpp
    void beginChannels();
    int channelSlot(const std::string& name, Type);
    std::vector<std::pair<std::string, int>> channelsFor(Type);
    const std::pair<int, Type>* channelNamed(const std::string& name);
    void giveChannel(int slot, const Expr& value, Inst* whole, Inst* condition);
    Inst* channelValue(const std::string& name, Type&);
    Inst* channelGiven(const std::string& name);
    std::vector<int> enteringSlots() const;
    void enters(Inst* irradiance);
    Inst* outputChannel(const Expr&);
    Inst* writeAov(const Expr&);
    Inst* readAov(const Expr&);

    // build_bsdf.cpp
    struct DistributionCall;
    std::vector<Inst*> bsdf(const Expr&);
    Inst* distributionArgument(const Distribution&, const DistributionCall&, const Parameter&, const std::vector<Inst*>& numbers,
                               size_t& next);
    std::vector<Inst*> distribution(const Distribution&, const DistributionCall&);
    Inst* noSuchDistribution(Inst* name, const Expr&);
    void checkDistribution(const Expr&);

    Inst* shadeopCall(const Expr&);
    Inst* pluginCall(const Expr&); // build_plugin.cpp
    Inst* runtimeCall(const Expr&);
    Inst* special(const Expr&);
    std::vector<Inst*> traceParts(const Expr&);
    struct ServiceCall; // build_service.cpp
    /// `part`: of a call that gives an array; -1: all in one. `points`: it is answered from point clouds.
    Inst* service(const Expr&, Op, int part = -1, bool points = false);
    struct SplineCall {
        Inst* value = nullptr;
        Kind kind{};
        Base base{};
        std::vector<Inst*> points; ///< where they are given one by one, or looked at so
        Inst *storage = nullptr, *length = nullptr;
        int most = 0; ///< control points that there can be
    };
    Inst* spline(const Expr&);
    Inst* splineOf(SplineCall, const std::string& basis, bool solve);
    Inst* transformCall(const Expr&);
    Inst* filterstep(const Expr&);
    Inst* isOutput(const Expr&);
    bool isWanted(const std::string& output) const;
    Inst* gridBound(const Expr&, float half);
    Inst* unavailable(const Expr&);
    // build_rays.cpp
    Inst* rays(const Expr&, const char* name, const std::vector<std::pair<Inst*, Type>>& positional, Inst* cone);
    Inst* tracedMap(const Expr&);
    bool ofRaysOnly(const Expr&, const std::string& parameter);
    // build_hemisphere.cpp
    struct Hemisphere;
    void hemispherePairs(const Expr&, Inst* normal, bool occlusion, Hemisphere&);
    Inst* readsPoints(const Expr&);
    Inst* tracedHemisphere(const Expr&);
    Inst* hemisphere(const Expr&);
    Inst* random(const Expr&);
    bool hasGlobal(const char* name) const;
    Inst* global(const char* name, Base);
    Inst* foldString(const std::string& op, const std::vector<Inst*>& args);
    bool isLobe(const Expr&) const;

    // build_outputs.cpp
    void output(const std::string& name);
    /// Puts out a value; of an array each element.
    void putOut(const std::string& name, Inst* value, Type);
    bool blockOutput(const std::string& name, const OutputName&);
    void elementOutput(const std::string& name, const OutputName&);
    bool parameterOutput(const std::string& name, const OutputName&);
    void globalOutput(const std::string& name, const OutputName&);
    std::vector<std::string> usualOutputs() const;
    void noteBlocks();
    bool lightsOutside() const;

    const Program& program_;
    const Shader& shader_;
    const DirectSet& direct_;
    std::deque<Frame> frames_; ///< references stay valid while functions are entered
    /// Slots of what a block of a light gives.
    struct LightBlock {
        const Stmt* stmt;
        bool solar;
        int L, Cl, Ol, lit;
        bool cone = false;  ///< solar with an angle that may be above 0
        bool built = false; ///< a block of a function is one for each call, in order of the text
        /// The only block, and one that always runs: what the shader does to Cl and Ol behind it counts too.
        bool only = false;
    };
    std::vector<LightBlock> lightBlocks_;
    int blockRan_ = -1; ///< slot: whether a block has run; a light shader is ambient where none has
    std::map<const Function*, Scan> scans_;
    std::map<const Function*, CallFacts> callFacts_;
    std::map<std::pair<const Function*, std::string>, Outlined> outlined_;
    std::vector<Inst*> functions_; ///< Function instructions, those that are called first
    std::set<int> assignedAnywhere_;
    std::unordered_map<const Inst*, Lengths> lengths_;
    int largestResize_ = -1;
    std::set<const Symbol*> grown_;
    std::vector<Instance> instances_;
    int handleDepth_ = 0;  ///< methods of co-shaders that are open
    int constructing_ = 0; ///< open construct()
    int quiet_ = 0;        ///< what runs now prints nothing
    int sharing_ = 0;      ///< open functions whose output parameters are variables of the caller
    std::set<std::pair<size_t, const Function*>> openMethods_, scannedMethods_;
    std::vector<std::pair<size_t, const Function*>> way_; ///< openMethods_ in the order of their calls
    std::optional<std::pair<size_t, const Function*>> methodByName(const Function&) const;
    std::string wayTo(size_t instance, const Function&) const;
    std::map<std::string, std::pair<int, Type>> channels_; ///< by name: slot and type
    int lightDepth_ = 0;
    int blockDepth_ = 0;   ///< blocks of a light that are open
    bool inSolar_ = false; ///< the innermost of them is solar
    /// Output parameters that lights ask for: slot and type.
    std::map<std::string, std::pair<int, Type>> messageSlots_;
    bool uniformContext_ = false; ///< the value goes to a uniform variable: one random() for all
};

} // namespace alpenglow::rsl::ir
