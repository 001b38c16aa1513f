// The graphics state and what requests do to it. Handlers in requests/ are short because the rules live here:
// scopes and dispatch (interpreter.cpp), blocks (blocks.cpp), motion (motion_block.cpp), parameter lists (bind.cpp),
// primitives (emit.cpp, fit.cpp), archives (archive.cpp).
#pragma once
#include "ri/call.h"
#include "ri/declare.h"
#include "ri/library.h"
#include "ri/lightfilters.h"
#include "ri/openarchives.h"
#include "ri/program.h"
#include "ri/readahead.h"
#include "ri/reader.h"
#include "ri/reporter.h"
#include "ri/requests/request.h"
#include "ri/sharedarchives.h"
#include "ri/shelf.h"
#include "ri/source.h"
#include "scene/network.h"
#include "scene/scene.h"
#include "scene/solids.h"
#include <array>
#include <functional>
#include <map>
#include <set>

namespace alpenglow::ri {

/// Blocks that a scene opens and closes.
enum class BlockKind { Frame, World, Attribute, Transform, Solid, Object, Resource, Edit };
/// The requests that open and close a block, such as "AttributeBegin"; for messages.
const char* beginName(BlockKind);
const char* endName(BlockKind);

/// ErrorHandler (RISpec 3.2, 7.2).
enum class ErrorStyle { Ignore, Print, Abort };

/// The purpose of a parameter list. Decides how strictly counts are checked, and in which table names are looked up.
enum class Use { Shader, Primitive, Option, Attribute, Hider, Display, Other };

/// A value in a condition.
struct ConditionValue {
    bool isString = false; ///< else a number
    double number = 0;     ///< its value
    std::string text;      ///< its value
};

using NamedSystems = std::map<std::string, scene::Transform>; ///< by name: from the space to world; before WorldBegin to camera

/// What AttributeBegin saves.
struct GraphicsState {
    std::shared_ptr<scene::Attributes> attributes; ///< never null; copied before a change if it is shared
    scene::Transform ctm;                          ///< current to world; before WorldBegin to camera
    std::shared_ptr<const NamedSystems> scoped;    ///< ScopedCoordinateSystem
    LightFilters filters;                          ///< of the lights that follow
};

/// A stored object: primitives in its own space, and what decides whether its light indices are still valid.
struct StoredObject {
    scene::Object object;
    size_t serial = 0; ///< of its ObjectBegin
    size_t world = 0;  ///< the world it was made in, 0 = outside
    size_t lights = 0; ///< lights there were before that world: their indices hold in later worlds too
};
using ObjectRef = std::shared_ptr<StoredObject>;

/// Executes requests: keeps the graphics state, collects the frame, and gives complete frames to the consumer. Problems are
/// reported, never thrown. Handlers of requests (ri/requests) call its members. Not thread safe.
class Interpreter {
public:
    /// The consumer and the diagnostics must outlive it.
    Interpreter(ReaderOptions options, scene::FrameConsumer& consumer, Diagnostics& diagnostics);

    /// Reads a whole stream at the outermost level and closes what it leaves open.
    void readStream(std::unique_ptr<ByteSource> raw, const std::string& name);
    /// Executes one request in the current state: checks its scope, then calls its handler, or keeps the call (holdsBack()).
    void execute(const Call& call);
    /// The end of a stream, or of a program's calls: closes what is open, with an error for each, and draws a world that is open.
    void finish(const SourcePlace& end);
    /// Whether calls are not executed now: they are kept for an inline archive, or skipped by a condition.
    bool holdsBack() const { return recording_ || passesOver(); }
    /// Whether the user has stopped the run. Blocks that are open then are no errors.
    bool interrupted() const { return settings.stop && *settings.stop; }
    /// Whether no further requests are executed.
    bool stopped() const { return aborted() || interrupted(); }
    /// Whether ErrorHandler is "abort" and an error has occurred.
    bool aborted() const {
        return errorStyle_ == ErrorStyle::Abort &&
               (reporter.errors() > errorsBefore_ || reporter.errorsOfAll() > errorsOfAllBefore_);
    }

    /// RibReader::nextScene().
    void nextScene();
    /// RibReader::make(). deferred.cpp
    std::shared_ptr<const scene::Frame> make(const scene::Frame&, std::span<const int> which);
    void leavePrograms(); ///< RibReader::leavePrograms(). procedural.cpp
    void endPrograms();   ///< RibReader::endPrograms()

    // --- for handlers ---
    Reporter reporter;
    ReaderOptions settings;
    scene::FrameConsumer& consumer;
    Declarations declarations; ///< of Declare, and those that the language has
    scene::Options options;    ///< of the frame, until WorldBegin
    GraphicsState state;
    std::vector<double> nRGB; ///< ColorSamples: n x 3; empty = colours are RGB

    /// Between WorldBegin and WorldEnd.
    bool inWorld() const { return frame_ != nullptr; }
    /// The current attributes, for changes. Earlier snapshots keep their values.
    scene::Attributes& attributes();
    /// The current attributes, shared and immutable.
    scene::AttributesRef snapshot();
    /// The typed parameter list of a call. Unknown names and wrong counts are reported; such parameters are left out.
    /// `category`: the class of an Option or Attribute.
    scene::ParamList bind(const Call& call, Use use, const std::string& category = {});
    /// Reports a name of Option or Attribute that is not known (a warning) or is of another renderer (a note), once. Returns
    /// whether it has an effect.
    bool sayUnknown(bool option, const std::string& category, const scene::Param& p);
    /// The same for a parameter of Hider (true) or Display.
    bool sayUnknownParameter(bool hider, const scene::Param& p);
    /// n numbers of ColorSamples (or 3) to RGB; `numbers` may hold several colours.
    std::vector<float> toRgb(const std::vector<double>& numbers) const;
    /// The shader call of a request with a name and parameters, with the current transformation.
    scene::ShaderRef shader(const Call& call);

    /// Opens a block. False if the stack is full (reported): nothing is saved, and the matching end() does nothing.
    bool begin(BlockKind kind, const Call& call);
    /// Closes a block; one that is not open, or not the innermost, is an error.
    void end(BlockKind kind, const Call& call);
    void worldBegin(const Call& call);  ///< WorldBegin: fixes the camera, begins the frame
    void objectBegin(const Call& call); ///< ObjectBegin
    /// Makes the block that has just begun an object with a new space.
    ObjectRef beginObject(const std::string& handle);
    void beginSolid(scene::SolidOperation operation, const Call& call); ///< SolidBegin
    void beginMotion(const Call& call);                                 ///< MotionBegin
    void endMotion(const Call& call); ///< MotionEnd: joins the samples of a transformation or primitive

    /// Multiplies the current transformation by m from the left, as transform requests do.
    void concat(const scene::Transform& m, const Call& call);
    /// Replaces the current transformation.
    void replaceCtm(const scene::Transform& m, const Call& call);
    /// Gives the current space a name: for the frame, or until the end of the attribute block (`scoped`).
    void nameSystem(const std::string& name, bool scoped);
    /// From a named space to the world, before WorldBegin to the camera; nothing if the name is unknown.
    /// "world", "camera", "object", "current" and "shader" are predefined.
    std::optional<scene::Transform> namedSystem(const std::string& name) const;

    /// RIS: the shader of a Bxdf or similar request, with the patterns that its connections name now (scene/network.h).
    scene::ShaderRef network(const Call& call, scene::Keeper);
    void pattern(const Call& call);      ///< Pattern
    void risLight(const Call& call);     ///< Light
    void lightFilter(const Call& call);  ///< LightFilter
    void enableFilter(const Call& call); ///< EnableLightFilter
    void editWorld(const Call& call);    ///< EditWorldBegin
    /// EditWorldEnd.
    void endEditWorld(const Call& call);
    void linksFilters() { linksFilters_ = true; } ///< Attribute "lightfilter"
    void isRis() { ris_ = true; }                 ///< the scene has requests of RIS
    /// The shader that an Integrator sees instead of all surfaces; null: none.
    void integratorSurface(scene::ShaderRef s) { integratorSurface_ = std::move(s); }
    /// Whether the integrator lights a scene without lights from the eye.
    void headlight(bool on) { headlight_ = on; }

    void light(const Call& call, bool area); ///< LightSource, AreaLightSource
    void illuminate(const Call& call);       ///< Illuminate
    /// Adds a primitive of the kind of the request, with the current attributes, to the frame or the open object. Checks the
    /// guarantees of scene::Primitive; a primitive that cannot meet them is reported and dropped.
    void emit(scene::Primitive primitive, const Call& call);
    void instance(const Call& call); ///< ObjectInstance
    /// An instance of an object, here.
    void place(const StoredObject& object, const SourcePlace& where);

    /// The polygons of a file as primitives of this place, with these constants in addition to the file's own variables.
    void drawModel(const std::string& name, const Call& call, const scene::ParamList& constants);
    void volume(const Call& call); ///< Volume
    /// Where the depth map of a repelling plane lies; the name itself when it is not there, "" when it may not be read
    /// (reported).
    std::string depthMap(const std::string& name, const SourcePlace& place);
    /// ReadArchive: an inline archive of that name, or a file on the search path. Reported if there is none.
    void readArchive(const std::string& name, const SourcePlace& place);
    /// "DelayedReadArchive", "RunProgram" or "DynamicLoad". bound: six numbers, or none.
    void procedural(const std::string& kind, const std::vector<std::string>& arguments, const std::vector<float>& bound,
                    const Call& call);
    /// Content that `make` gives by calls of the C binding (ri/c). It gets the size in the picture (detail, pixels); the
    /// graphics state saved before and restored after. name: of the library, for messages; "" for a function of a program's own.
    void subdivide(const std::function<void(float)>& make, const std::string& name, const std::vector<float>& bound,
                   const Call& call);
    /// Numbers for lights and objects that libraries make: never the same twice.
    int nextHandle() { return ++handleSerial_; }
    /// Executes requests of our own as if they stood at the place of `call`. Their primitives get the variables `everywhere`,
    /// too.
    void expand(const std::string& requests, const Call& call, scene::ParamList everywhere = {});
    void beginRecording(const Call& call); ///< ArchiveBegin
    void resource(const Call& call);       ///< Resource: saves or restores parts of the state
    /// True while the samples of a moving primitive are gathered.
    bool gatheringMotion() const { return capture_ != nullptr; }
    /// True when MakeTexture and its kin of this frame are wanted.
    bool frameWanted() const;
    /// Option "ribparse" "varsubst" was met.
    void lookForVariables() { hasVariables_ = true; }
    /// Holds for what comes, here and while the picture is drawn. Errors before it count for nothing.
    void setErrorStyle(ErrorStyle style);
    /// Reports once per request that it is read but has no effect.
    void incapable(const Call& call, const std::string& what);
    void sayOtherType(const OtherType&, const SourcePlace&); ///< warns once a type that it is read as another

private:
    struct Block {
        BlockKind kind;
        SourcePlace place;
        GraphicsState saved;
        std::unique_ptr<scene::Options> options;        ///< Frame, World
        size_t lights = 0;                              ///< Frame: lights declared before
        std::map<std::string, int> handles;             ///< Frame, World
        NamedSystems systems;                           ///< Frame, World
        std::map<std::string, GraphicsState> resources; ///< Resource
        ObjectRef object;                               ///< Object
        bool inner = false;                             ///< World: in another one
    };
    /// Options that an archive sets in a world. They are executed unless the archive turns out to have a world itself.
    struct InnerOptions {
        size_t archive = 0; ///< index into barriers_
        scene::Options before;
        std::vector<std::pair<const Request*, SourcePlace>> calls;
    };
    /// What outlives a stream.
    struct Lasting {
        Declarations declarations;
        scene::Options options;
        GraphicsState state;
        std::vector<double> nRGB;
        std::vector<scene::Light> lights;
        std::map<std::string, int> handles;
        NamedSystems systems;
        std::map<std::string, GraphicsState> resources;
        std::map<std::string, ObjectRef> objects;
        std::map<std::string, std::shared_ptr<std::vector<Call>>> inlineArchives;
        ErrorStyle errorStyle = ErrorStyle::Print;
        int errorsBefore = 0, errorsOfAllBefore = 0;
    };
    Lasting lasting() const;
    void restore(const Lasting&);
    struct Model {
        std::string file;
        std::vector<scene::Primitive> parts;
    };
    struct Motion {
        std::vector<float> times;
        std::vector<Call> calls;
        SourcePlace place;
    };
    struct Condition {
        SourcePlace place;
        bool outer;  ///< the surroundings are executed
        bool taken;  ///< a branch has been executed
        bool active; ///< this branch is
        bool elseSeen;
    };
    struct Recording {
        std::string name;
        std::shared_ptr<std::vector<Call>> calls;
        int depth = 0;
        SourcePlace place;
    };

    /// False when an archive that is read again has used up its calls.
    bool mayReplay(const Call& call);
    /// The bound of the region of a Volume. False (reported): the arguments make none.
    bool regionOf(const Call& call, std::vector<float>& bound);
    /// A condition that does not hold, or one too deep to be asked, passes over what is in it.
    bool passesOver() const { return deepConditions_ > 0 || (!conditions_.empty() && !conditions_.back().active); }
    /// Drops blocks down to this number without an end: what they saved is saved elsewhere.
    void dropBlocks(size_t count);
    /// Runs `body`, which may recurse to here; at some depths on a new stack.
    void deeper(const std::function<void()>& body);
    /// Reads what was found: recorded calls, or a stream that messages call `file`. key distinguishes it from other open ones.
    void readOpened(const std::string& key, const std::string& file, const std::shared_ptr<std::vector<Call>>& calls,
                    std::unique_ptr<ByteSource> source, const SourcePlace& place);
    /// Does `body`, which gives back where it ended, within archives and procedurals that are open, and closes what it leaves
    /// open.
    void inPart(const std::string& key, const std::function<SourcePlace()>& body);
    /// Executes the requests of an archive that was parsed before.
    void executeParsed(const ParsedArchive& archive, const std::string& key, const std::string& file);
    /// Area of a bound in the picture, in pixels; infinite behind the eye; negative: its contents cannot change the picture.
    double detailOf(const std::vector<float>& bound) const;
    /// Expands a procedural at once.
    void makeNow(const std::string& kind, const std::vector<std::string>& arguments, const std::vector<float>& bound,
                 const Call& call);
    // sharedarchives.cpp
    /// Whether an archive that is read here may be an instance, or the object of later ones.
    bool mayShare(const std::string& name) const;
    /// Whether a DelayedReadArchive is an instance of what was read before: then that is placed here.
    bool instanceOfArchive(const std::string& name, const Call& call);
    /// Reads a DelayedReadArchive; from the second time under the same attributes on as an object.
    void readDelayed(const std::string& name, const Call& call);
    /// When an archive is read again: notes whether it has shapes only, and whether it sets attributes.
    void learn(SharedArchive& of, const std::string& file);
    // ris.cpp
    std::shared_ptr<scene::ShaderCall> networkCall(const Call&); ///< a node of a network of patterns
    /// A node of OSL with its patterns, as one shader.
    void oslPatterns(const Call&, const scene::ShaderCall& given, const scene::Param& named);
    void dropFilterLinks(scene::Frame&) const;
    void overrideAttributes(scene::Frame&); ///< at WorldEnd: lights that are on everywhere, the surface of the integrator
    void addFilters(Call& call) const;      ///< light filters as parameters of the light
    void addProfile(Call& call);            ///< an IES profile as a parameter of the light
    void turnOn(int light);                 ///< on for all primitives of the world, unless it is muted
    std::vector<std::pair<int, std::set<std::string>>> groupsOfLights(const scene::Frame& frame) const;
    void addHeadlight(scene::Frame&);
    void risOptions(scene::Options&) const; ///< defaults of a scene with requests of RIS
    // unlit.cpp
    void noteEnded(const Block&);       ///< notes lights that the end of a block turns off
    void sayUnlit(const scene::Frame&); ///< warns of lights that light no primitive
    // deferred.cpp
    /// Whether a procedural may be deferred until a ray reaches its bound; if so, adds it to the frame as a deferred one.
    bool waits(const std::string& kind, const std::vector<std::string>& arguments, const std::vector<float>& bound,
               const Call& call);
    struct Waiting;
    using Wanted = std::function<bool(int)>;            ///< whether the procedural of this number is to be made
    void putWaiting(Waiting, std::vector<float> grown); ///< adds it to the frame, with its bound grown by displacement
    void nameWaiting(size_t from);
    void markPart(scene::Attributes&) const;
    void makeWaiting(const Waiting&, std::vector<scene::PrimitiveRef>& out, const Wanted&);
    /// Copies primitives, with the contents of wanted procedurals in their place.
    void putMade(const std::vector<scene::PrimitiveRef>& from, std::vector<scene::PrimitiveRef>& out, const Wanted&);
    void orderInstances(scene::Frame&) const;
    std::shared_ptr<scene::Frame> makeSome(const scene::Frame&, const Wanted&); ///< the frame with wanted ones expanded
    /// Whether one more program or library may make content here: how many there are and how deep they nest is bounded
    /// (reported).
    bool mayMake(const Call& call);
    /// Along Option "searchpath" "procedural", --searchpath and the folder of the scene, under the first of these names that is
    /// there and may be executed (X_OK) or read (R_OK); "" otherwise. looked: the folders.
    std::string findForeign(const std::vector<std::string>& names, int access, std::string& looked) const;
    const Library* libraryOf(const std::string& name, const SourcePlace& place);
    void runLibrary(const std::string& name, const std::string& data, const std::vector<float>& bound, const Call& call);
    Program* programOf(const std::string& command, const SourcePlace& place);
    void runProgram(const std::string& command, const std::string& data, const std::vector<float>& bound, const Call& call);
    /// What locate() gives for an archive, from the shelf if that knows; nothing: reported.
    std::optional<ArchiveShelf::Found> locateArchive(const std::string& name, const SourcePlace& place);
    /// Path of a file along the search paths of archives; "" when there is none or it may not be read: reported. named: whether a
    /// name says that it is of this kind, others are read from the scene's own folders only.
    /// along: the searchpath that is looked through, "archive" or "shader".
    std::string locate(const char* what, const std::string& name, const SourcePlace& place, bool (*named)(const std::string&),
                       const char* along = "archive");
    void run(class Parser& parser);
    /// execute() without ReaderOptions::filter.
    void take(const Call& call);
    /// What execute() does, once it is to be done.
    void perform(const Call& call);
    void dispatch(const Call& call);
    // executed.cpp: ReaderOptions::executed
    /// Performs a request and passes it on, or what is in it.
    void announce(const Call& call);
    void announceProcedural(const Call& call, const std::string& kind);
    void announceName(std::string_view request, const SourcePlace& place);
    /// Options of an archive in the world, kept until it is known that it has no world itself.
    void announceHeld();
    bool conditional(const Call& call); ///< handles IfBegin and its kin; false for other requests
    bool record(const Call& call);      ///< takes the request into the archive being recorded; false: none is
    void checkScope(const Call& call);  ///< warns where the request is out of scope
    void sayOutOfScope(const Request& request, unsigned scope, const SourcePlace& place);
    // innerworld.cpp
    std::optional<size_t> archiveInWorld() const; ///< index in barriers_ of the first archive that the open world reads
    /// True for options of an archive that is read inside a world: that they are out of scope is reported later or never.
    bool waitsForInnerWorld(const Call& call);
    /// To be called when an archive has ended.
    void endInnerOptions();
    /// WorldBegin in an archive that is read in a world. False: it is not.
    bool innerWorld(const Call& call);
    unsigned scope() const; ///< flags of the innermost block (requests/request.h)
    void pop();             ///< ends the innermost block and restores what it saved
    /// Ends blocks down to this depth, with a message for each that is open.
    void unwind(size_t depth, const SourcePlace& where, bool keepWorld);
    /// At the end of a text: ends motion blocks, recordings and conditions that are open, with messages.
    void closeOpenEnds(size_t conditions, const SourcePlace& where);
    void worldEnd(Block& block); ///< completes the frame and passes it to the receiver
    /// A copy without lights from `stable` on, for attributes that were made in another world.
    static scene::AttributesRef withoutLights(const scene::AttributesRef& a, size_t stable);
    scene::Object forThisWorld(const StoredObject& o) const;
    void rebase(scene::Attributes& a, const scene::Transform& cameraToWorld);
    bool leftOutEdit(const Call& call); ///< whether a request belongs to an edit of a world that stands
    bool evaluate(const Call& call);
    /// The value of a variable of IfBegin or of a text. If it is not set: with `standard` its default, else nothing.
    std::optional<ConditionValue> variable(const std::string& name, bool standard) const;
    // variables.cpp: Option "ribparse" "varsubst"
    Call withVariables(const Call&);
    void putVariables(std::string& text, char mark, const SourcePlace&);
    void moveTransform(const Motion& m);             ///< the transforms of a motion block become one that moves
    void movePrimitive(const Motion& m);             ///< the primitives of a motion block become one that deforms
    void store(std::shared_ptr<scene::Primitive> p); ///< into the open object or the frame
    scene::Param bindOne(const Call& call, const RawParam& raw, Use use, const std::string& category, bool* keep);
    scene::Object* openObject();                  ///< of ObjectBegin; null outside of it
    const Block* innermost(BlockKind kind) const; ///< null if none is open
    std::vector<scene::Light>& lights() { return frame_ ? frame_->lights : lights_; }

    bool shared_ = true; ///< state.attributes is referenced by a snapshot
    ErrorStyle errorStyle_ = ErrorStyle::Print;
    int errorsBefore_ = 0, errorsOfAllBefore_ = 0; ///< when ErrorHandler "abort" was read
    std::vector<Block> blocks_;
    std::array<int, 8> depth_{}; ///< open blocks, by BlockKind
    int overflow_ = 0;           ///< Begins beyond limits::kStackDepth and those in them, whose Ends are ignored
    int leftOutEdits_ = 0;       ///< open EditBegins in an EditWorldBegin
    bool editsWorld_ = false;    ///< EditWorldBegin is open
    int deepConditions_ = 0;     ///< the same of IfBegin
    int nested_ = 0;             ///< calls of deeper() that have not returned
    std::optional<Motion> motion_;
    std::vector<Condition> conditions_;
    std::optional<Recording> recording_;
    scene::ParamList everywhere_;                                       ///< variables of every primitive that is emitted now
    std::vector<std::shared_ptr<scene::Primitive>>* capture_ = nullptr; ///< primitives of a motion block go here
    std::vector<scene::Light> lights_;                                  ///< before WorldBegin; shader spaces to camera
    std::map<std::string, int> handles_;                                ///< light handle -> index
    NamedSystems systems_;                                              ///< before WorldBegin to camera, inside to world
    NamedSystems worldCameraSystems_;                                   ///< those of before WorldBegin, to camera
    std::map<std::string, GraphicsState> resources_;
    std::map<std::string, ObjectRef> objects_;
    std::map<size_t, int> objectIndex_;                   ///< serial -> index in this frame
    std::map<std::string, SharedArchive> sharedArchives_; ///< of the open world, by ArchiveShelf::Found::key
    std::set<int> ended_;                                 ///< lights of this world that an AttributeEnd has ended
    std::set<int> globalLights_;                          ///< lights of this world that are on everywhere
    scene::ShaderRef integratorSurface_;                  ///< of all surfaces of this world
    bool headlight_ = true;                               ///< no integrator, or PxrDefault: what has no light is lit from the eye
    bool ris_ = false;                                    ///< the scene has requests of RIS
    bool linksFilters_ = false;                           ///< some primitive may leave out some filter of its lights
    size_t objectSerial_ = 0, worldSerial_ = 0;
    std::shared_ptr<scene::Frame> frame_;
    scene::Transform worldToCamera_;
    std::map<std::string, std::shared_ptr<std::vector<Call>>> inlineArchives_;
    std::string sceneFolder_; ///< of the stream that is read, or ""
    ReadAhead ahead_;         ///< of the archives that it names
    ArchiveShelf shelf_;      ///< those that were read before
    std::string unscanned_;   ///< the stream, before it reads one
    OpenArchives openArchives_;
    std::vector<size_t> barriers_; ///< block depth at each open archive's start
    std::optional<InnerOptions> inner_;
    int archiveReads_ = 0;
    size_t objectCopies_ = 0, replayedCalls_ = 0;
    uint32_t solidSerial_ = 0; ///< of solid blocks
    void stepInto(scene::SolidOperation operation);
    scene::AttributesRef solidPart(const Call& call);
    std::set<std::string> archivesRead_;
    std::shared_ptr<const Model> lastModel_;
    std::map<std::string, std::unique_ptr<Program>> programs_;  ///< by command; null: it is not asked again
    std::map<std::string, std::unique_ptr<Library>> libraries_; ///< by name; null: there is none
    int programCalls_ = 0, programSerial_ = 0, handleSerial_ = 0;
    std::vector<std::shared_ptr<const Waiting>> waiting_; ///< of this frame, by number
    std::string part_;                                    ///< of what is made now
    int partsWithin_ = 0;                                 ///< procedurals in it that wait
    bool hasVariables_ = false;                           ///< texts may have variables
    bool making_ = false;                                 ///< what is in procedurals that waited is being made
    bool replaying_ = false;                              ///< inside an archive that was read before
    bool announcing_ = false; ///< a request that was passed on is executed: what it makes of itself is not
    std::vector<Call> held_;  ///< announceHeld()
    Lasting base_;            ///< what a scene begins with
    size_t baseWorld_ = 0;    ///< worldSerial_ at that time
};

/// Checks and completes a primitive's variables (the guarantees in scene/scene.h). False (reported): do not draw it.
bool fitVariables(scene::Primitive& p, Reporter& reporter);

/// Value of an IfBegin expression, docs/design/ri.md. `lookup` gives a variable's numbers or strings, or nothing; where it is not
/// set, with `standard` what then holds (known::OptionDescription::answer).
using ConditionLookup = std::function<std::optional<ConditionValue>(const std::string& name, bool standard)>;
/// Unknown variables and syntax errors are reported; they are false.
bool evaluateCondition(const std::string& text, const ConditionLookup& lookup, Reporter& reporter, const SourcePlace& place);

/// Whether a file may be read.
using MayRead = std::function<bool(const std::string& path)>;
/// The path of an archive along folders: as given, then with '/' for '\', its base name, other case. "" = not found.
/// *fallback: the substitution that was made, for messages, or "".
std::string findFile(const std::string& name, const std::vector<std::string>& folders, std::string* fallback, const MayRead& may);
/// The folder that a RIB file lies in, or the zip archive that holds it; "" for the current one.
std::string folderOf(const std::string& file);
/// "a:b;c" to folders; a single letter before ":/" or ":\" is a drive, "&" and "@" are left to the caller.
std::vector<std::string> splitSearchPath(const std::string& text);

} // namespace alpenglow::ri
