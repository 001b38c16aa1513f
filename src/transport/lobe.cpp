#include "transport/lobe.h"

namespace alpenglow::transport {

extern const LobeKind kDiffuseLobe, kSpecularLobe, kPhongLobe, kUniformLobe, kCosineLobe, kPhongTraceLobe, kOrenNayarLobe, kBlinnLobe, kAshikhminShirleyLobe,
    kCookTorranceLobe, kWardLobe, kGlassLobe, kHairLobe;

std::span<const LobeKind* const> lobeKinds() {
    static constexpr const LobeKind* kAll[] = {&kDiffuseLobe, &kSpecularLobe, &kPhongLobe, &kUniformLobe, &kCosineLobe, &kPhongTraceLobe, &kOrenNayarLobe,
                                                 &kBlinnLobe,   &kAshikhminShirleyLobe, &kCookTorranceLobe, &kWardLobe, &kGlassLobe, &kHairLobe};
    return kAll;
}

const LobeKind* findLobe(std::string_view name) {
    for (const LobeKind* k : lobeKinds())
        if (k->name == name) return k;
    return nullptr;
}

} // namespace alpenglow::transport
