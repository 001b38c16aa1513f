// Textures for shaders: texture(), environment() on lat-long maps, textureinfo(). Loaded whole on first need, then only read, so
// lookups take no lock and do not depend on threads.
//
// Coordinates: (s, t) = (0, 0) is the upper left corner of the picture, s to the right, t downward (RISpec 3.2, 7.1).
// Wrap modes: those stored in the file ("wrapmodes", written by MakeTexture); a plain picture has none and is clamped, so that no
// edge bleeds (TextureSettings::plainWrap).
// Filtering: the footprint is the parallelogram of the derivatives, as a matrix of squared widths; blur adds to it in quadrature
// (convolution of boxes). Probes with trilinear interpolation lie along the major axis so that the variance of the whole kernel
// is that of the filter over the footprint; the minor axis chooses the level. A kernel is never narrower than bilinear
// interpolation. Filters with a shape (kernels.h) are sums of probes over the footprint's ellipse. Slopes of a lookup: of the
// same probes and levels, each the central difference over one texel of its level; so they are smooth across texels, as coarse as
// the value, and those of a map that is seen from afar fade as its value does. Not done: separate treatment of parallelogram and
// ellipse.
#pragma once
#include "base/diagnostics.h"
#include "base/file.h"
#include "base/matrix.h"
#include "base/readlog.h"
#include "texture/lookuplanes.h"
#include "texture/pyramid.h"
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::texture {

/// What a map was made for; how environment() and shadow() read it.
enum class Kind { Texture, LatLong, Cube, Shadow };

class ScratchFile;

/// A loaded map; immutable. Of a UDIM set and of a cube map: no levels, only tiles.
struct Texture {
    std::string path;                                ///< the file
    Kind kind = Kind::Texture;                       ///< what it was made for
    std::vector<std::string> channels;               ///< names, in the order of the numbers of a texel
    std::vector<Level> levels;                       ///< 0 is the picture
    Wrap swrap = Wrap::Clamp, twrap = Wrap::Clamp;   ///< outside 0 to 1
    std::optional<Matrix> worldToCamera, worldToNDC; ///< of shadow maps and of pictures of a camera; nothing: not stored
    int bits = 8;                                    ///< of a number in the file
    bool floating = false;                           ///< numbers in the file are floats
    /// By UDIM number, 1001 + floor(s) + 10 floor(t); faces of a cube by 0..5: px nx py ny pz nz.
    std::map<int, std::shared_ptr<const Texture>> tiles;
    std::shared_ptr<const display::DeepSamples> deep; ///< of a deep shadow map; levels[0] has its first surfaces
    float fovCotangent = 1;                           ///< of a cube face: 1 / tan(fov / 2)
    float gamma = 0;                                  ///< that the file declares; 0: none
    std::shared_ptr<const ScratchFile> scratch;       ///< holds its levels, if they are not in memory
    /// The tile of a UDIM set at (floor(s), floor(t)); null: none.
    const Texture* tileAt(float column, float row) const {
        if (!(column >= 0 && column < 10 && row >= 0 && row < 10)) return nullptr;
        const auto i = tiles.find(1001 + int(column) + 10 * int(row));
        return i == tiles.end() ? nullptr : i->second.get();
    }
    int width() const { return levels.empty() ? 0 : levels[0].width; }
    int height() const { return levels.empty() ? 0 : levels[0].height; }
    size_t bytes() const;
};
/// Null: the map is missing; lookups give the fill value (colourOfMissing() is what shaders see). Valid until the system ends, or
/// forget().
using Handle = const Texture*;

/// By RISpec name; nothing if unknown.
std::optional<Filter> filterByName(std::string_view name);

/// 3Delight manual, table 6.16.
struct LookupOptions {
    float swidth = 1, twidth = 1;     ///< multiply the derivatives
    float sblur = 0, tblur = 0;       ///< as a fraction of the map
    Filter filter = Filter::Gaussian; ///< shape of the filter
    bool asLight = false;             ///< colours of maps with a transfer curve: as linear light (TextureSettings::light)
    float squeeze = 0;                ///< 1 / n^2: the footprint is widened until its sides are at most n to 1; 0: any
    float fill = 0;                   ///< value of channels that the map does not have
    float lerp = 0;                   ///< accepted; levels are always interpolated, a switch would show as an edge
};

/// A footprint as squared widths in (s, t): the sum of the outer products of its two side vectors.
struct Footprint {
    float ss = 0, st = 0, tt = 0; ///< in maps squared
    /// From the two side vectors, (dsdx, dtdx) and (dsdy, dtdy).
    static Footprint sides(float dsdx, float dtdx, float dsdy, float dtdy);
};

/// Channels first, first+1, ... (count of them) of the map at (s, t), filtered over the footprint, into out[0..count). With
/// `slopes`: their derivatives by s into slopes[0..count), by t into slopes[count..2 count), per unit of s and t (a complete
/// map), for a fixed footprint; 0 without a map or channel. With `curves`, likewise: second derivatives by s twice, by s and t,
/// by t twice.
void lookup(Handle, int first, int count, float s, float t, const Footprint&, const LookupOptions&, float* out,
            float* slopes = nullptr, float* curves = nullptr);
/// The same with the change of (s, t) from pixel to pixel (or sample to sample).
void lookup2D(Handle, int first, int count, float s, float t, float dsdx, float dtdx, float dsdy, float dtdy,
              const LookupOptions&, float* out, float* slopes = nullptr, float* curves = nullptr);
/// texture() with four corners, in any order. Four equal corners: no filtering beyond bilinear interpolation. Slopes: when
/// all corners move together.
void lookupQuad(Handle, int first, int count, const float s[4], const float t[4], const LookupOptions&, float* out,
                float* slopes = nullptr, float* curves = nullptr);
/// Sixteen at a time (texture/lookuplanes.h), of one map; count: 1 to 4.
void lookup2DLanes(Handle, int first, int count, bool asLight, LookupLanes&);

/// Orientation of a lat-long map: latitude +90 (along pole) at the top, longitude 0 (toward zero) at the left edge, increasing
/// toward `quarter`. Renderers differ in axes and direction. The default has z up, as in old maps, and longitude from +x toward
/// +y.
struct LatLong {
    Vec3 pole{0, 0, 1}, zero{1, 0, 0}, quarter{0, 1, 0};
    /// (s, t) of a direction of any nonzero length (0 gives the centre).
    void project(const Vec3& direction, float& s, float& t) const;
    /// Change of (s, t) for a change of the direction by d. At the poles s changes by at most the complete map.
    void differentiate(const Vec3& direction, const Vec3& d, float& ds, float& dt) const;
    /// The direction of length 1 at (s, t).
    Vec3 direction(float s, float t) const;
};

/// environment(): the form that the map has, cube faces or (also for pictures that are neither) latitude-longitude. When `slopes`
/// is given: derivatives of the channels by x, y and z of the direction, in three runs of `count`; `curves`: by xx, xy, xz, yy,
/// yz, zz, six runs.
void environment(Handle, const LatLong&, int first, int count, const Vec3& direction, const Vec3& ddx, const Vec3& ddy,
                 const LookupOptions&, float* out, float* slopes = nullptr, float* curves = nullptr);
/// environment() with four directions, in any order.
void environmentQuad(Handle, const LatLong&, int first, int count, const Vec3 directions[4], const LookupOptions&, float* out,
                     float* slopes = nullptr, float* curves = nullptr);

/// Position of a direction on a cube face (0..5: px nx py ny pz nz) with this cotangent of half the field of view. Faces are seen
/// from inside: pz has x to the right and y up, the side faces follow by rotation about y, py has -z up, ny has +z up.
int cubeFace(const Vec3& direction, float fovCotangent, float& s, float& t);
/// Change of (s, t) on that face when the direction changes by d.
void cubeDifferentiate(int face, const Vec3& direction, const Vec3& d, float fovCotangent, float& ds, float& dt);

/// Lat-long maps: along a direction with its changes per pixel. Longitude wraps, latitude is clamped.
void environmentLatLong(Handle, const LatLong&, int first, int count, const Vec3& direction, const Vec3& ddx, const Vec3& ddy,
                        const LookupOptions&, float* out, float* slopes = nullptr, float* curves = nullptr);
/// The same with four directions.
void environmentLatLongQuad(Handle, const LatLong&, int first, int count, const Vec3 directions[4], const LookupOptions&,
                            float* out, float* slopes = nullptr, float* curves = nullptr);

/// textureinfo() fields.
struct TextureInfo {
    int width = 0, height = 0, channels = 0, bits = 0; ///< of level 0; bits of a number
    bool floating = false;                             ///< numbers are floats
    std::string type;                                  ///< "texture", "environment", "shadow"
    Wrap swrap = Wrap::Clamp, twrap = Wrap::Clamp;     ///< outside 0 to 1
    float gamma = 1;                                   ///< file value = light ^ gamma, as the file declares it
    int faces = 0;                                     ///< 6: a cube map
    bool alpha = false;                                ///< one of the channels is opacity, "a"
    std::optional<Matrix> viewing, projection;         ///< world to camera, world to screen (x -1..1, y 1..-1) of the map
};

/// What is the same for all maps of a world.
struct TextureSettings {
    Wrap plainWrap = Wrap::Clamp; ///< of pictures that state none
    bool linearise = true;        ///< colours of files that declare a gamma (PNG) become linear on loading, in every lookup
    /// Instead of linearise: maps keep their numbers, and lookups for light (LookupOptions::asLight) convert: by sRGB or gamma if
    /// the file declares it, by sRGB for other 8-bit pictures. Alpha and depth are never converted.
    bool light = false;
    LatLong latLong;
    ReadPolicy read{};                ///< where the names of maps may lead
    std::shared_ptr<ReadLog> reads{}; ///< gets every file that is read or missed; may be null
    std::optional<Color> missing{};   ///< colour of unreadable maps; nothing: lookups give their fill value
    /// Memory for maps in bytes; the rest is in scratch files. 0: a quarter of the machine's.
    size_t memory = 0;
    float squeeze = 0; ///< of lookups: LookupOptions::squeeze
};

/// The maps of a render. Thread safe.
class TextureSystem {
public:
    /// settings: limits of memory, search paths.
    explicit TextureSystem(Diagnostics&, TextureSettings = {});
    ~TextureSystem();
    /// Opens the map called name along a search path (base/file.h findFile: also by other case, backslashes, or base name, which
    /// is reported). "UDIM" in the name opens tiles 1001 to 1100 that exist; also "<UDIM>", "<udim>", "%(UDIM)d", "_MAPID_".
    /// "<FACE>" in a name opens six pictures, px nx py ny pz nz, as a cube map. A missing or damaged file is reported once; the
    /// handle is null. Threads that need the same file wait for one load.
    Handle open(const std::string& name, const std::vector<std::string>& searchPath = {""}, const SourcePlace& = {});
    /// Whether open() would find a file of that name, or a tile. Reports nothing.
    bool present(const std::string& name, const std::vector<std::string>& searchPath = {""});
    /// What textureinfo() says of a map; nothing for a missing one.
    std::optional<TextureInfo> info(Handle) const;
    const LatLong& latLong() const { return settings_.latLong; }
    const TextureSettings& settings() const { return settings_; }
    /// Memory of maps in bytes, and its part in pages of scratch files.
    size_t bytes() const;
    size_t scratchBytes() const;
    /// The files read, by name: bytes on disk, of the map in memory, and of levels in a scratch file.
    struct File {
        std::string path; ///< of the file
        size_t bytes = 0, memory = 0, scratch = 0;
    };
    /// Sorted by name.
    std::vector<File> files() const;
    /// Their limit (TextureSettings::memory).
    size_t memoryLimit() const { return limit_; }
    /// Releases pages of scratch files above the limit. Call now and then during lookups, from any thread. Fast if all maps fit.
    void keepWithinLimit() {
        if (scratches_.load(std::memory_order_relaxed)) trim();
    }
    /// Drops all maps, so that changed files are read again. Invalidates all handles; no lookup may run.
    void forget();

private:
    struct Entry;
    bool find(const std::string& name, const std::vector<std::string>& searchPath) const;
    std::shared_ptr<const Texture> load(const std::string& path, const SourcePlace&);
    std::shared_ptr<const Texture> loadFile(const std::string& name, const std::vector<std::string>& searchPath,
                                            const SourcePlace&);
    std::shared_ptr<const Texture> loadTiles(const std::string& name, const std::vector<std::string>& searchPath,
                                             const SourcePlace&);
    void trim();
    /// Moves the levels of a map to a scratch file if they do not fit into memory. If the disk is full they stay, with a warning.
    void pageOut(Texture&, const SourcePlace&);
    std::shared_ptr<const Texture> loadFaces(const std::string& name, const std::vector<std::string>& searchPath,
                                             const SourcePlace&);
    Diagnostics& diags_;
    TextureSettings settings_;
    size_t limit_ = 0;
    std::atomic<size_t> held_{0};   ///< memory of maps in bytes, without scratch files
    std::atomic<int> scratches_{0}; ///< scratch files
    std::atomic<size_t> filesAtTrim_{0};
    mutable std::mutex trimming_; ///< guards the following
    std::vector<std::weak_ptr<const ScratchFile>> files_;
    size_t handFile_ = 0, handByte_ = 0;  ///< where the next pages are given back
    std::map<std::string, bool> present_; ///< by name and search path
    mutable std::mutex mutex_;
    std::map<std::string, std::shared_ptr<Entry>> byRequest_, byPath_;
};

/// Position and length of the tile number ("UDIM" in any spelling) in a name. Nothing: a single file.
std::optional<std::pair<size_t, size_t>> tileNumberIn(const std::string& name);

/// A texture from a picture already in memory (its levels are used when complete, else built).
std::shared_ptr<const Texture> makeTextureFrom(display::Image, const TextureSettings& = {});

} // namespace alpenglow::texture
