// TextureSystem: memory limit of maps. Maps stay in memory while all of them fit into the limit; a map that does not fit goes to
// a scratch file with all of its levels.
#include "base/memory.h"
#include "texture/scratch.h"
#include "texture/texture.h"
#include <functional>

namespace alpenglow::texture {

namespace {

constexpr size_t kHand = size_t(256) << 10; ///< bytes that are given back at a time
constexpr size_t kSmall = size_t(64) << 10; ///< maps that are no larger stay in memory

/// Every array of numbers of a map and its tiles.
void eachArray(Texture& t, const std::function<void(Level&)>& of) {
    for (Level& l : t.levels) of(l);
    for (auto& [number, tile] : t.tiles) eachArray(const_cast<Texture&>(*tile), of);
}

/// Offsets of the arrays of a level in the file.
struct Places {
    size_t values = 0, codes = 0, light = 0;
};

template <class T> void pointInto(Texels<T>& texels, const std::shared_ptr<const ScratchFile>& file, size_t at) {
    if (!texels.empty()) texels = Texels<T>(file, reinterpret_cast<const T*>(file->data() + at), texels.size());
}

} // namespace

void TextureSystem::pageOut(Texture& t, const SourcePlace& place) {
    const size_t bytes = t.bytes();
    // A quarter is reserved for pages of scratch files, which would otherwise be reloaded for every lookup.
    if (held_.fetch_add(bytes) + bytes <= limit_ - limit_ / 4 || t.kind == Kind::Shadow || bytes < kSmall) return;
    std::string why;
    const std::shared_ptr<ScratchFile> file = ScratchFile::create(why);
    std::vector<Places> places;
    bool good = file != nullptr;
    const auto append = [&](const auto& texels, size_t& at) {
        if (good && !texels.empty()) good = file->append(texels.data(), texels.size() * sizeof(*texels.data()), at, why);
    };
    eachArray(t, [&](Level& l) {
        Places& p = places.emplace_back();
        append(l.values, p.values);
        append(l.codes, p.codes);
        append(l.light, p.light);
    });
    if (!good || !file->map(why)) {
        diags_.reportOnce("texture:scratch",
                          {Severity::Warning,
                           Rie::System,
                           place,
                           "maps take more than " + memorySizeText(limit_) + " and stay in memory: " + why,
                           "TMPDIR names the folder of scratch files; Option \"limits\" \"texturememory\" the limit, in kB",
                           {}});
        return;
    }
    size_t n = 0;
    eachArray(t, [&](Level& l) {
        const Places& p = places[n++];
        pointInto(l.values, file, p.values);
        pointInto(l.codes, file, p.codes);
        pointInto(l.light, file, p.light);
    });
    t.scratch = file;
    held_ -= bytes;
    std::lock_guard lock(trimming_);
    files_.push_back(file);
    ++scratches_;
}

size_t TextureSystem::scratchBytes() const {
    std::lock_guard lock(trimming_);
    size_t n = 0;
    for (const auto& weak : files_)
        if (const auto file = weak.lock()) n += file->resident();
    return n;
}

void TextureSystem::trim() {
    const size_t own = held_.load(), allowed = limit_ > own ? limit_ - own : 0, now = bytesOfFiles();
    if (now < filesAtTrim_.load(std::memory_order_relaxed) + allowed / 4) return;
    std::unique_lock lock(trimming_, std::try_to_lock);
    if (!lock) return; // another thread does it
    size_t resident = 0, all = 0;
    std::vector<std::shared_ptr<const ScratchFile>> files;
    for (const auto& weak : files_)
        if (const auto file = weak.lock()) {
            files.push_back(file);
            resident += file->resident();
            all += file->size();
        }
    if (!files.empty() && resident > allowed - allowed / 4) {
        // Clock algorithm over all files: releases pages as it passes; those still in use are reloaded.
        for (size_t passed = 0; resident > allowed / 2 && passed <= all;) {
            if (handFile_ >= files.size()) handFile_ = handByte_ = 0;
            const ScratchFile& f = *files[handFile_];
            resident -= std::min(resident, f.release(handByte_, kHand));
            passed += kHand;
            handByte_ += kHand;
            if (handByte_ < f.size()) continue;
            handByte_ = 0;
            ++handFile_;
        }
    }
    filesAtTrim_ = bytesOfFiles();
}

} // namespace alpenglow::texture
