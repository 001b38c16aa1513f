#include "bsdf/lobe.h"

namespace alpenglow::bsdf {

namespace {
/// Writes the rows that a kind reads, `stride` floats apart.
void give(float* rows, size_t stride, int needs, const LobeParams& p, const DistributionParams* more) {
    const auto set = [&](int row, float x) { rows[size_t(row) * stride] = x; };
    const auto triple = [&](int row, const Vec3& v) { set(row, v.x), set(row + 1, v.y), set(row + 2, v.z); };
    triple(kRowAxis, p.axis);
    if (needs & kNeedsWo) triple(kRowWo, p.wo);
    if (needs & kNeedsHorizon) {
        triple(kRowHorizon, p.horizon);
        set(kRowHasHorizon, p.hasHorizon ? 1 : 0);
    }
    if (needs & kNeedsA) set(kRowA, p.a);
    if (needs & kNeedsSurface) {
        set(kRowRoughness, more->roughness);
        set(kRowRoughnessV, more->roughnessv);
        triple(kRowUdir, more->udir);
        triple(kRowEta, more->eta);
        triple(kRowK, more->k);
        triple(kRowAbsorption, more->absorption);
        set(kRowPart, float(more->part));
    }
    if (needs & kNeedsNumbers) {
        const int count = std::min(int(more->lobes.size()), kMostLobeNumbers);
        set(kRowCount, float(count));
        for (int i = 0; i < kMostLobeNumbers; ++i) set(kRowLobes + i, i < count ? more->lobes[size_t(i)] : 0);
    }
}
const LobeLanesList& one() {
    static const LobeLanesList list = lobeLanes(1);
    return list;
}
} // namespace

Bsdf::Bsdf(const LobeKind& kind, const LobeParams& p) : lanes_(&one().lobes[kind.index]) {
    give(rows_, 1, lanes_->needs, p, p.more.get());
    lanes_->prepare(rows_, 1);
}
LobeValue Bsdf::value(const Vec3& w) const {
    const float from[3] = {w.x, w.y, w.z};
    float v[kValueRows];
    lanes_->evaluate(rows_, 1, from, v);
    return {{v[0], v[1], v[2]}, v[kRowFcos], v[kRowPdf]};
}
bool Bsdf::sample(Vec2 u, Vec3& w) const {
    const float numbers[2] = {u.x, u.y};
    float drawn[kDrawnRows];
    lanes_->sample(rows_, 1, numbers, drawn);
    w = {drawn[0], drawn[1], drawn[2]};
    return drawn[kRowDrawn] != 0;
}

bool LobeKind::isDelta(const LobeParams& p) const { return Bsdf(*this, p).delta(); }
float LobeKind::fcos(const LobeParams& p, Vec3 w) const { return Bsdf(*this, p).value(w).fcos; }
float LobeKind::pdf(const LobeParams& p, Vec3 w) const { return Bsdf(*this, p).value(w).pdf; }
bool LobeKind::sample(const LobeParams& p, Vec2 u, Vec3& w) const { return Bsdf(*this, p).sample(u, w); }
float LobeKind::albedo(const LobeParams& p) const { return Bsdf(*this, p).albedo(); }
float LobeKind::spread(const LobeParams& p) const { return Bsdf(*this, p).spread(); }

BsdfBatch::BsdfBatch() : lanes_(lobeLanes(lobeWidth())), kinds_(size_t(lanes_.count)) {}

void BsdfBatch::clear() {
    for (Kind& k : kinds_) {
        for (int b : k.asked) k.blocks[size_t(b)].asked = 0;
        k.asked.clear();
        k.count = k.ready = 0;
    }
}

BsdfBatch::Place BsdfBatch::add(const LobeKind& kind, const LobeParams& p, const DistributionParams* more) {
    Kind& k = kinds_[size_t(kind.index)];
    const Place place{kind.index, k.count++};
    if (size_t(place.at / kLobeBlock) == k.blocks.size()) k.blocks.emplace_back();
    give(&block(place).rows[0][lane(place)], kLobeBlock, lanes_.lobes[kind.index].needs, p, more ? more : p.more.get());
    return place;
}

void BsdfBatch::prepare() {
    for (size_t i = 0; i < kinds_.size(); ++i) {
        Kind& k = kinds_[i];
        for (int at = k.ready / kLobeBlock * kLobeBlock; at < k.count; at += kLobeBlock) {
            const int lanes = std::min(k.count - at, kLobeBlock);
            lanes_.lobes[i].prepare(k.blocks[size_t(at / kLobeBlock)].rows[0], (1u << lanes) - 1);
        }
        k.ready = k.count;
    }
}

void BsdfBatch::evaluate() {
    for (size_t i = 0; i < kinds_.size(); ++i) {
        for (int b : kinds_[i].asked) {
            Block& block = kinds_[i].blocks[size_t(b)];
            lanes_.lobes[i].evaluate(block.rows[0], block.asked, block.in[0], block.value[0]);
            block.asked = 0;
        }
        kinds_[i].asked.clear();
    }
}

void BsdfBatch::sample() {
    for (size_t i = 0; i < kinds_.size(); ++i) {
        for (int b : kinds_[i].asked) {
            Block& block = kinds_[i].blocks[size_t(b)];
            lanes_.lobes[i].sample(block.rows[0], block.asked, block.in[0], block.value[0]);
            block.asked = 0;
        }
        kinds_[i].asked.clear();
    }
}

std::span<const LobeKind* const> lobeKinds() {
    static const auto kinds = [] {
        std::vector<LobeKind> list;
        for (int i = 0; i < one().count; ++i) {
            const LobeLanes& k = one().lobes[i];
            list.push_back({k.name, k.doc, k.distribution, i, k.traits, k.eta});
        }
        return list;
    }();
    static const auto all = [] {
        std::vector<const LobeKind*> list;
        for (const LobeKind& k : kinds) list.push_back(&k);
        return list;
    }();
    return all;
}

const LobeKind* findLobe(std::string_view name) {
    for (const LobeKind* k : lobeKinds())
        if (k->name == name) return k;
    return nullptr;
}

} // namespace alpenglow::bsdf
