// Limits on the cost of untrusted files, by name. Each has a test (tests/limits).
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr int kArchiveDepth = 4096;              ///< archives and procedurals that are open at once
inline constexpr int kArchiveReads = 1'000'000;         ///< ReadArchive and similar requests executed by one reader
inline constexpr int kUnknownNames = 256;               ///< distinct unknown requests of one file, each reported once
inline constexpr int kStackDepth = 4096;                ///< blocks of one kind that are open at once, times of a motion block
inline constexpr size_t kStringBytes = 16u << 20;       ///< of one string of RIB
inline constexpr size_t kTokenBytes = 64u << 10;        ///< of one token of RIB
inline constexpr size_t kGzipRatio = 1000;              ///< decompressed : compressed, beyond the first MiB
inline constexpr size_t kGzipBytes = size_t(64) << 30;  ///< decompressed bytes of one RIB stream
inline constexpr int kReportedProblems = 1000;          ///< messages of one RIB reader; further ones are only counted
inline constexpr int kConditionDepth = 256;             ///< nesting inside one IfBegin expression
inline constexpr size_t kLights = 10'000'000;           ///< lights of one frame
inline constexpr size_t kObjectCopies = 250'000;        ///< primitives copied by instances inside objects, per reader
inline constexpr size_t kReplayedCalls = 20'000'000;    ///< requests repeated because an archive is read again
inline constexpr int kImageSide = 65536;                ///< pixels along a side
inline constexpr int kMatteRanks = 64;                  ///< objects that share a pixel of a Cryptomatte
inline constexpr size_t kMatteLayers = 8;               ///< Cryptomattes of one display
inline constexpr size_t kDeepSteps = size_t(1) << 26;   ///< of a deep shadow map
inline constexpr size_t kImageBytes = size_t(32) << 30; ///< decoded, as floats
inline constexpr int kImageChannels = 1024;             ///< channels of a picture
inline constexpr size_t kImageExpansion = 4096;         ///< decoded bytes per byte of file, above kImageSmallBytes
inline constexpr size_t kImageSmallBytes = size_t(64) << 20; ///< decoded size that is allowed regardless of the size of the file
inline constexpr int kImageScans = 200;                      ///< of a progressive JPEG
inline constexpr int kTextureTaps = 32;                      ///< samples of one filtered lookup along the major axis
inline constexpr float kDisplacementBound = 1e6f;            ///< largest displacement bound, in the units of the shader
inline constexpr int kPathDepth = 10'000;                    ///< hard limit, counted when reached, as it causes bias
inline constexpr size_t kFrameBytesPerThread = 64u << 20;    ///< suspended kernel frames (docs/design/rsl.md)
inline constexpr size_t kRequestBytes = size_t(256) << 20;   ///< of ray requests of a batch with a kernel that does not wait
inline constexpr int kLightsSampled = 8;       ///< lights sampled at a vertex under path, if there are more than that
inline constexpr int kLightsSampledDeeper = 3; ///< the same at later vertices of a path
inline constexpr int kCategoryDepth = 32;      ///< nesting of a category expression of lights
inline constexpr size_t kLightCache = 256;     ///< light samples that a strip of points caches for its next light loop
inline constexpr size_t kLightBlocks =
    256; ///< illuminate() and solar() blocks of one light shader, counting those of functions once per call
inline constexpr int kLightIterations =
    64;                                  ///< samples of a light's generateSamples() with an iteration of their own in light loops
inline constexpr int kMedia = 4;         ///< volumes that a ray tracks; deeper ones drop the outermost
inline constexpr int kLightHandles = 64; ///< handles returned by getlights()
inline constexpr int kShadowLayers = 256;                ///< transparent surfaces that a shadow ray passes
inline constexpr int kSliceRays = 4096;                  ///< children of one suspension, per slice
inline constexpr int kExpressionDepth = 256;             ///< nesting of RSL expressions and statements
inline constexpr int kTreeHeight = 1024;                 ///< height of an RSL expression tree, including long sums
inline constexpr int kIncludeDepth = 64;                 ///< of RSL #include
inline constexpr int kIncludes = 5000;                   ///< #include lines of one RSL program that are followed
inline constexpr size_t kSourceBytes = size_t(64) << 20; ///< total size of the texts of one RSL program, counting each inclusion
inline constexpr size_t kExcerptBytes =
    4u << 20;                           ///< lines stored for messages about an RSL program; lines read from files for that
inline constexpr int kMacroDepth = 128; ///< macro calls inside arguments of macro calls
inline constexpr size_t kMacroTokens = 2'000'000;            ///< tokens of one RSL program during macro expansion
inline constexpr int kCoShaderDepth = 16;                    ///< methods of co-shaders open at once
inline constexpr int kStructs = 128;                         ///< structure types in an RSL file
inline constexpr size_t kStructMembers = 4096;               ///< members of a structure, including nested ones
inline constexpr int kCallDepth = 64;                        ///< nesting of calls of RSL functions and methods
inline constexpr size_t kPatternStates = 20'000;             ///< of a match() pattern after expanding repetitions
inline constexpr size_t kPatternCache = 256;                 ///< compiled match() patterns in the cache
inline constexpr size_t kRuntimeStrings = size_t(512) << 20; ///< bytes of all strings that shaders make at run time
inline constexpr int kShaderArray = 16384;                   ///< elements of an RSL array
inline constexpr size_t kShaderMemory = 1u << 20;  ///< bytes of a kernel's local arrays per point, including derivatives
inline constexpr int kLoopIterations = 10'000'000; ///< iterations of one loop of a shader at one point; then it ends
inline constexpr size_t kKernelStack = 64u << 10;  ///< bytes of local arrays that generated code keeps on the stack
inline constexpr int kResizableArray = 64; ///< elements that a resizable RSL array can grow to, unless the shader sets more
inline constexpr int kCandidateNotes = 12; ///< candidates of a failed call that are explained
inline constexpr size_t kServerMessage = 32u << 20;      ///< bytes of one message to the language server
inline constexpr size_t kServerDocuments = 1000;         ///< texts that an editor may have open in the language server
inline constexpr int kExcerptColumns = 160;              ///< of a line in a message; the rest is dots
inline constexpr int kSourceLines = 100;                 ///< source lines read from files for messages about files parsed earlier
inline constexpr size_t kExcerptLine = 256u << 10;       ///< bytes of such a line that are read
inline constexpr size_t kServerScene = 4u << 20;         ///< bytes of a scene that the language server checks during editing
inline constexpr int kServerDiagnostics = 500;           ///< messages about one text in the language server
inline constexpr int kFolderEntries = 100'000;           ///< entries of a folder for a lookup without regard to case
inline constexpr int kFrontErrors = 100;                 ///< errors reported for one RSL file
inline constexpr size_t kInlinedInstructions = 400'000;  ///< IR of one kernel after inlining
inline constexpr int kOutlineInstructions = 400;         ///< larger RSL functions, after inlining, are called instead
inline constexpr size_t kPrintBytes = size_t(256) << 20; ///< bytes of printf() output held until it is sorted
inline constexpr size_t kPrintRuns = 64;                 ///< times that it goes to a temporary file until then
inline constexpr int kSplinePoints = 4096;               ///< control points of a spline() written one by one
inline constexpr int kSolvedSplinePoints = 512;          ///< of a spline that is solved for its value, which tries each segment
/// IR instructions of a kernel up to which calls are inlined for the affine proof
inline constexpr size_t kAffineInlining = 100'000;
inline constexpr size_t kKernelCacheBytes = size_t(512) << 20; ///< compiled kernels on disk; the least recently used go first

inline constexpr size_t kDiceQuads = 4'000'000; ///< micro-quads dicing makes of one primitive (geometry/)
/// Distance from the camera beyond which facets grow in proportion: no picture shows such detail, and a surface with one point
/// there would have millions of slivers.
inline constexpr double kDiceDistance = 1e12;
inline constexpr size_t kLimitPatternBytes = size_t(256)
                                             << 20; ///< weights of a subdivision surface's neighbourhoods; beyond: coarser ones
inline constexpr size_t kEditedFaces = 1'000'000;   ///< corners of a mesh that is refined once more for hierarchical edits
inline constexpr int kDiceEdge = 4096;              ///< steps along one edge of a patch
inline constexpr size_t kTriangulationTests = 400'000'000; ///< vertex tests for one concave polygon; beyond, it is fanned
inline constexpr size_t kShapes = 50'000'000;              ///< shapes of a frame, instances expanded
inline constexpr size_t kControlPoints = 100'000'000;      ///< of one patch mesh
inline constexpr int kNurbsOrder = 32;                     ///< of a NURBS patch or trim curve
inline constexpr size_t kTrimPieces = 200'000;             ///< Bezier pieces of the trim curves of one patch
inline constexpr size_t kModelBytes = size_t(16) << 30;    ///< of one .ply or .obj file
inline constexpr int kModelProperties = 1024;            ///< of one element in the header of a .ply file; also number of elements
inline constexpr int kModelMessages = 20;                ///< errors of one model file that are reported individually
inline constexpr int kBlobInstructions = 4'000'000;      ///< of one Blobby
inline constexpr size_t kBlobBoxes = 1'000'000;          ///< boxes for intersecting the surface of one Blobby
inline constexpr int kProgramSeconds = 60;               ///< time of a RunProgram for one answer
inline constexpr size_t kProgramBytes = size_t(4) << 30; ///< of such an answer
inline constexpr int kProgramCalls = 100'000;            ///< procedurals that programs and libraries expand for one reader
inline constexpr double kFilterWidth = 64;               ///< pixels, full width of a pixel or display filter
inline constexpr unsigned kSamplesPerPixel = 1u << 27;   ///< of one film: with more the exact sums could overflow
inline constexpr int kFilmChannels = 1024;               ///< AOV channels of one film
inline constexpr size_t kPartFileBytes = size_t(64) << 30;   ///< of one part file or checkpoint on disk
inline constexpr size_t kPartHeaderBytes = size_t(16) << 20; ///< of its header: names, metadata, ranges

inline constexpr int kShaderFilesLooked = 2000;       ///< .sl files searched for a shader without a file of its name
inline constexpr size_t kShaderFileLooked = 1u << 20; ///< bytes of one of them

} // namespace alpenglow::limits
