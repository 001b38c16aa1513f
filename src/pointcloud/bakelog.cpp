#include "pointcloud/bakelog.h"
#include "base/file.h"
#include "pointcloud/bakefile.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/limits.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

namespace alpenglow::pointcloud {

namespace {

/// As many entries of one sample are compared with each other.
constexpr size_t kFew = 16;

size_t rowOf(const BakeLayout& l) { return size_t(l.width) + (l.flat ? 2 : 7); }

/// The points of a cloud. If several calls bake at one point, new channels are added to the existing point, unless it already has
/// other values for them.
struct Joined {
    PointCloud& cloud;
    std::vector<size_t> counts; ///< of each number: points that have it
    struct At {
        size_t point = 0;
        std::vector<bool> given;
    };
    std::unordered_map<std::string_view, At> places; ///< by the bits of P, N and radius

    /// `n`: P, N, radius, and the numbers that go `to` places among those of the channels.
    void add(const float* n, const std::vector<int>& to, bool several) {
        const size_t width = size_t(cloud.width());
        At* at = several ? &places[{reinterpret_cast<const char*>(n), 7 * sizeof(float)}] : nullptr;
        if (at && !at->given.empty()) {
            float* there = &cloud.values[at->point * width];
            bool fresh = false, same = true;
            for (size_t i = 0; i < to.size(); ++i) {
                const bool given = at->given[size_t(to[i])];
                fresh |= !given;
                same &= !given || there[to[i]] == n[7 + i];
            }
            if (fresh && same) return put(there, n, to, at);
        }
        if (at) *at = {cloud.size(), std::vector<bool>(width)};
        const std::vector<float> zeros(width, 0.f);
        cloud.add({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6], zeros);
        put(width ? &cloud.values[(cloud.size() - 1) * width] : nullptr, n, to, at);
    }

private:
    void put(float* there, const float* n, const std::vector<int>& to, At* at) {
        for (size_t i = 0; i < to.size(); ++i) {
            there[to[i]] = n[7 + i];
            counts[size_t(to[i])] += !at || !at->given[size_t(to[i])];
            if (at) at->given[size_t(to[i])] = true;
        }
    }
};

/// All of a key but the sample, and the call.
auto pointOf(const BakeKey& k, const BakeLayout& l) {
    return std::tuple(k.camera, k.y, k.x, k.layers, k.vertex, std::string_view(l.where));
}

} // namespace

bool BakeLog::add(const std::string& file, const BakeLayout& layout, const BakeKey& key, std::span<const float> numbers) {
    const std::lock_guard lock(mutex_);
    const size_t bytes = numbers.size() * sizeof(float) + sizeof(Entry);
    if (full_ || bytes_ + bytes > limits::kCloudBytes) {
        full_ = true;
        return false;
    }
    bytes_ += bytes;
    File& f = files_[file];
    if (!std::all_of(numbers.begin(), numbers.end(), [](float v) { return std::isfinite(v); })) {
        ++f.notFinite;
        return true;
    }
    f.entries.push_back({key, &layout, f.pending.size()});
    f.pending.insert(f.pending.end(), numbers.begin(), numbers.end());
    return true;
}

void BakeLog::commit() {
    const std::lock_guard lock(mutex_);
    for (auto& [name, f] : files_) commit(f);
    count();
}

/// Counts records after averaging samples.
void BakeLog::count() {
    bytes_ = 0;
    for (const auto& [name, f] : files_) bytes_ += f.committed.size() * sizeof(float) + f.rows.size() * sizeof(Row);
}

/// Records of one point and call are consecutive, sample by sample. If all samples have equally many, they are averaged one by
/// one.
void BakeLog::commit(File& f) {
    const auto less = [&](const Entry& a, const Entry& b) {
        const auto x = pointOf(a.key, *a.layout), y = pointOf(b.key, *b.layout);
        return x != y ? x < y : a.key.sample < b.key.sample;
    };
    std::stable_sort(f.entries.begin(), f.entries.end(), less);
    std::vector<const Entry*> group;
    std::unordered_set<std::string_view> known; // the bits of those of one sample, where they are more than a few
    for (size_t i = 0, end; i < f.entries.size(); i = end) {
        const Entry& first = f.entries[i];
        const size_t width = rowOf(*first.layout);
        group.clear();
        for (end = i; end < f.entries.size() && !less(first, f.entries[end]); ++end) {}
        while (end < f.entries.size() && pointOf(f.entries[end].key, *f.entries[end].layout) == pointOf(first.key, *first.layout))
            ++end;
        std::vector<size_t> begins;                  // of samples, in group
        for (size_t k = i, from = 0; k < end; ++k) { // bitwise duplicates count once
            if (k == i || f.entries[k].key.sample != f.entries[k - 1].key.sample) {
                begins.push_back(from = group.size());
                if (!known.empty()) known = {}; // clear() would take as long as the largest loop did
            }
            const auto bits = [&](const Entry& e) {
                return std::string_view(reinterpret_cast<const char*>(&f.pending[e.at]), width * sizeof(float));
            };
            const std::string_view mine = bits(f.entries[k]);
            if (group.size() - from < kFew) {
                const auto same = [&](const Entry* e) { return bits(*e) == mine; };
                if (std::any_of(group.begin() + long(from), group.end(), same)) continue;
            } else {
                if (known.empty()) // a loop that bakes
                    for (size_t j = from; j < group.size(); ++j) known.insert(bits(*group[j]));
                if (!known.insert(mine).second) continue;
            }
            group.push_back(&f.entries[k]);
        }
        const auto put = [&](auto&& number) {
            f.rows.push_back({first.layout, f.committed.size()});
            for (size_t k = 0; k < width; ++k) f.committed.push_back(number(k));
        };
        const size_t samples = begins.size(), each = group.size() / samples;
        bool even = !first.key.camera && samples > 1;
        for (size_t s = 0; s < samples; ++s) even &= begins[s] == s * each;
        even &= group.size() == samples * each;
        if (!even) {
            for (const Entry* e : group) put([&](size_t k) { return f.pending[e->at + k]; });
            continue;
        }
        for (size_t n = 0; n < each; ++n)
            put([&](size_t k) {
                double sum = 0;
                for (size_t s = 0; s < samples; ++s) sum += double(f.pending[group[s * each + n]->at + k]);
                return float(sum / double(samples));
            });
    }
    f.entries.clear();
    f.pending.clear();
}

bool BakeLog::pending() const {
    return std::any_of(files_.begin(), files_.end(), [](const auto& f) { return !f.second.entries.empty(); });
}

void BakeLog::discard() {
    const std::lock_guard lock(mutex_);
    for (auto& [name, f] : files_) {
        f.entries.clear();
        f.pending.clear();
    }
    count();
}

bool BakeLog::writeFlat(const std::string& name, const File& f, const OutputPolicy& policy, Diagnostics& d) const {
    const BakeLayout& first = *f.rows.front().layout;
    Baked b;
    b.type = first.channels.front().type;
    std::set<const BakeLayout*> leftOut;
    for (const Row& r : f.rows) {
        if (!r.layout->flat || sizeOf(r.layout->channels.front().type) != sizeOf(b.type)) {
            const std::string has = r.layout->flat ? "bake(): \"" + name + "\" has values of type " + nameOf(b.type) + " already"
                                                   : "bake3d(): \"" + name + "\" has points of bake() as well";
            if (leftOut.insert(r.layout).second)
                d.report(Severity::Error, Rie::Consistency, r.layout->place, has + "; these are left out");
            continue;
        }
        b.rows.insert(b.rows.end(), f.committed.begin() + long(r.at), f.committed.begin() + long(r.at + rowOf(*r.layout)));
    }
    return saveBaked(name, b, policy, d, first.place);
}

bool BakeLog::writeCloud(const std::string& name, const File& f, const OutputPolicy& policy, Diagnostics& d) const {
    PointCloud cloud;
    struct Known {
        bool fits = true;
        std::vector<int> to;
    };
    std::map<const BakeLayout*, Known> known; // by layout, where its numbers go
    std::vector<const BakeLayout*> order;
    for (const Row& r : f.rows)
        if (known.try_emplace(r.layout).second) order.push_back(r.layout);
    for (const BakeLayout* l : order)
        for (const Channel& c : l->channels) {
            const auto same = [&](const Channel& other) { return other.name == c.name; };
            const auto at = std::find_if(cloud.channels.begin(), cloud.channels.end(), same);
            if (at == cloud.channels.end()) cloud.channels.push_back(c);
            else if (at->type != c.type) known[l].fits = false;
        }
    for (const BakeLayout* l : order) {
        Known& k = known[l];
        if (!k.fits || l->flat)
            d.report(Severity::Error, Rie::Consistency, l->place,
                     "bake3d(): \"" + name + "\" has " +
                         (l->flat ? "points of bake() as well" : "channels of these names and other types already") +
                         "; these points are dropped");
        k.fits &= !l->flat;
        for (const Channel& c : l->channels)
            for (int n = 0, at = cloud.offsetOf(c.name); n < sizeOf(c.type); ++n) k.to.push_back(at + n);
    }
    Joined joined{cloud, std::vector<size_t>(size_t(cloud.width())), {}};
    cloud.reserve(f.rows.size());
    bool several = false; // calls with different channels
    for (const auto& [layout, k] : known) several |= k.fits && k.to.size() < size_t(cloud.width());
    for (const Row& r : f.rows)
        if (const Known& k = known[r.layout]; k.fits) joined.add(&f.committed[r.at], k.to, several);
    for (const Channel& c : cloud.channels)
        if (const size_t n = joined.counts[size_t(cloud.offsetOf(c.name))]; n < cloud.size())
            d.report(Severity::Warning, Rie::Consistency, order.front()->place,
                     "bake3d(): " + std::to_string(cloud.size() - n) + " of " + std::to_string(cloud.size()) + " points of \"" +
                         name + "\" have no channel \"" + c.name + "\"; it is 0 there",
                     "all calls that bake into one file must write the same channels, or other channels at the same points");
    return saveCloud(name, cloud, policy, d, f.rows.front().layout->place);
}

bool BakeLog::write(const OutputPolicy& policy, Diagnostics& d, FileOwners owners) {
    commit();
    bool all = true;
    for (const auto& [name, f] : files_) {
        if (f.notFinite)
            d.report(Severity::Warning, Rie::Math, {},
                     "\"" + name + "\": " + std::to_string(f.notFinite) +
                         " baked points have numbers that are not finite; they are dropped");
        if (f.rows.empty()) continue;
        const BakeLayout& first = *f.rows.front().layout;
        const std::string call = first.flat ? "bake()" : "bake3d()";
        bool binary = false;
        const std::string file = bakeFileName(name, &binary);
        const auto [owner, mine] = owners.try_emplace(fileIdentity(file), call + " of \"" + name + "\"");
        if (!mine) {
            d.report(Severity::Error, Rie::Consistency, first.place,
                     call + ": \"" + name + "\" is not written: " + owner->second + " writes that file",
                     "give each a name of its own");
            all = false;
            continue;
        }
        const bool written = f.rows.front().layout->flat ? writeFlat(name, f, policy, d) : writeCloud(name, f, policy, d);
        all &= written;
        if (written)
            d.report(Severity::Info, Rie::NoError, {}, "baked \"" + name + "\": " + std::to_string(f.rows.size()) + " points");
    }
    if (full_)
        d.report(Severity::Error, Rie::Limit, {},
                 "the frame bakes more than " + std::to_string(limits::kCloudBytes >> 30) + " GiB; the rest is not written",
                 "a larger ShadingRate makes fewer points");
    files_.clear();
    bytes_ = 0;
    full_ = false;
    return all;
}

} // namespace alpenglow::pointcloud
