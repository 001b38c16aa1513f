#include "rsl/passes/affine_analysis.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::passes {

bool isMix(const Inst* i) {
    return i->op == Op::Runtime && (i->text == "al_mix_f" || i->text == "al_mix_t" || i->text == "al_mixf_t");
}

namespace {

/// What the language calls a function of the runtime: "pow" for "al_pow_tf".
std::string spoken(const std::string& symbol) {
    std::string name = symbol.substr(symbol.rfind("al_", 0) == 0 ? 3 : 0);
    const std::string whole = name;
    while (!name.empty() && !findShadeop(name)) name.resize(name.rfind('_') == std::string::npos ? 0 : name.rfind('_'));
    return name.empty() ? whole : name;
}

/// What a Float made from a result may become: component c of a triple, or any (from a Float result).
constexpr uint8_t kGrey = Dependence::kGrey;

struct Analysis {
    const Kernel& k;
    Dependence d;
    std::vector<uint8_t> channel; ///< Floats: bits of the components the value came from
    bool changed = false;
    std::string symbol; ///< the input that is followed instead of Requests

    std::string where(const Inst* i) const { return i->place.line ? " (line " + std::to_string(i->place.line) + ")" : ""; }

    void bad(const SiteSet& mask, const Inst* at, const std::string& why) {
        if (!mask) return;
        if (!symbol.empty()) {
            d.bad.emplace(-1, why + where(at));
            return;
        }
        for (size_t s = 0; s < k.sites.size(); ++s)
            if (d.ordinals[s] >= 0 && mask.has(static_cast<size_t>(d.ordinals[s])) &&
                d.bad.emplace(static_cast<int>(s), why + where(at)).second)
                changed = true;
    }

    void raise(const Inst* i, const SiteSet& mask, uint8_t ch) {
        const bool more = d.sites[i->id].join(mask);
        if (!more && (channel[i->id] | ch) == channel[i->id]) return;
        channel[i->id] |= ch;
        changed = true;
    }

    const SiteSet& dep(const Inst* i) const { return d.sites[i->id]; }
    SiteSet all(const Inst* i) const {
        SiteSet m;
        for (const Inst* a : i->args) m.join(dep(a));
        return m;
    }
    uint8_t channels(const Inst* i) const {
        uint8_t c = 0;
        for (const Inst* a : i->args) c |= channel[a->id];
        return c;
    }

    void construct(const Inst* i) {
        const auto copy = [&](const Inst* to, const Inst* from) { raise(to, dep(from), channel[from->id]); };
        switch (i->op) {
        case Op::If:
            bad(dep(i->args[0]), i, "a condition depends on it");
            for (const Region& r : i->regions) region(r);
            break;
        case Op::Loop:
        case Op::LightLoop: {
            const bool light = i->op == Op::LightLoop;
            const size_t fa = light ? 3 : 0, fp = light ? 4 : 0;
            for (size_t a = 0; a < fa; ++a) bad(dep(i->args[a]), i, "an illuminance loop depends on it");
            for (const Region& r : i->regions)
                for (size_t p = fp; p < r.params.size(); ++p) {
                    copy(r.params[p], i->args[fa + p - fp]);
                    copy(r.params[p], i->regions.back().yields[p - fp]);
                }
            for (const Region& r : i->regions) region(r);
            if (!light) bad(dep(i->regions[0].yields[0]), i, "the condition of a loop depends on it");
            break;
        }
        default:
            break;
        }
    }

    void result(const Inst* i, const Inst* o, size_t n) {
        switch (o->op) {
        case Op::If:
            for (const Region& r : o->regions) raise(i, dep(r.yields[n]), channel[r.yields[n]->id]);
            break;
        case Op::Loop:
        case Op::LightLoop: {
            const Inst* p = o->regions.back().params[n + (o->op == Op::LightLoop ? 4 : 0)];
            raise(i, dep(p), channel[p->id]);
            break;
        }
        case Op::Request: {
            const SiteSet bit = SiteSet::of(d.ordinal(o));
            raise(i, bit, i->kind == Kind::Float ? kGrey : 0);
            const bool distance =
                i->kind == Kind::Float && k.sites[static_cast<size_t>(o->site)].op == "trace"; // the form that gives no light
            if (n > 0 || distance || (i->kind != Kind::Float && i->kind != Kind::Triple))
                bad(bit, o, "another result than the light itself is used");
            break;
        }
        case Op::Runtime:
            if (isMix(o)) mix(i, o);
            break;
        default:
            break;
        }
    }

    void mix(const Inst* i, const Inst* o) {
        bad(dep(o->args[2]), o, "mix() by it is not affine");
        raise(i, dep(o->args[0]) | dep(o->args[1]), channel[o->args[0]->id] | channel[o->args[1]->id]);
    }

    void region(const Region& r) {
        for (const Inst* i : r.body) inst(i);
    }

    void inst(const Inst* i) {
        const SiteSet m = all(i);
        if (i->op == Op::Input && !symbol.empty() && k.inputs[static_cast<size_t>(i->index)].name == symbol)
            raise(i, SiteSet::of(0), 0);
        switch (i->op) {
        case Op::Result:
            result(i, i->args[0], static_cast<size_t>(i->index));
            return;
        case Op::If:
        case Op::Loop:
        case Op::LightLoop:
            construct(i);
            if (i->kind != Kind::None) result(i, i, 0);
            return;
        case Op::Request:
            bad(m, i, "the arguments of " + k.sites[static_cast<size_t>(i->site)].op + "() depend on it");
            if (i->kind != Kind::None) result(i, i, 0);
            return;
        default:
            break;
        }
        if (m) use(i, m);
    }

    /// An instruction without regions takes what depends on these sites.
    void use(const Inst* i, const SiteSet& m) {
        switch (i->op) {
        case Op::Add:
        case Op::Sub:
        case Op::Neg:
            raise(i, m, channels(i));
            return;
        case Op::Mul:
            if (dep(i->args[0]) && dep(i->args[1])) bad(m, i, "it is multiplied by another such result");
            raise(i, m, channels(i));
            return;
        case Op::Div:
            bad(dep(i->args[1]), i, "something is divided by it");
            raise(i, m, channels(i));
            return;
        case Op::Splat:
            if (channel[i->args[0]->id] & 7) bad(m, i, "one of its components is used for all");
            raise(i, m, 0);
            return;
        case Op::Triple:
            for (size_t c = 0; c < 3; ++c)
                if (channel[i->args[c]->id] & ~(kGrey | (1u << c))) bad(dep(i->args[c]), i, "its components are mixed");
            raise(i, m, 0);
            return;
        case Op::Extract:
            raise(i, m, static_cast<uint8_t>(1u << i->index));
            return;
        case Op::Select:
            bad(dep(i->args[0]), i, "a condition depends on it");
            raise(i, m, channels(i));
            return;
        case Op::Runtime:
            if (isMix(i)) {
                if (i->kind != Kind::None) mix(i, i);
                return;
            }
            bad(m, i, "the result of " + spoken(i->text) + "() is not affine in it");
            return;
        case Op::Du:
        case Op::Dv:
            return; // such results count as constant
        case Op::Output:
            if (i->args[0]->kind == Kind::Float && (channel[i->args[0]->id] & kGrey) && (channel[i->args[0]->id] & 7))
                bad(m, i, "a float and a component of a colour are added up");
            if (k.outputs[static_cast<size_t>(i->index)].name != k.light ||
                (k.kind != ShaderKind::Surface && k.kind != ShaderKind::Volume))
                bad(m, i, "the output " + k.outputs[static_cast<size_t>(i->index)].name + " depends on it");
            return;
        case Op::Call:
            bad(m, i, "it is passed to " + i->args[0]->text + "(), which is too large to look into");
            return;
        case Op::ArrayStore:
            bad(m, i, "it is stored in an array");
            return;
        case Op::Service:
            bad(m, i, k.sites[static_cast<size_t>(i->site)].op + "() takes it as an argument");
            return;
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
        case Op::NotEqual:
            bad(m, i, "it is compared");
            return;
        default:
            bad(m, i, "it is used in a way that is not affine");
            return;
        }
    }
};

} // namespace

Dependence analyseDependence(const Kernel& k) {
    Analysis a{k, {}, std::vector<uint8_t>(k.pool.size()), false, {}};
    a.d.sites.resize(k.pool.size());
    a.d.ordinals.assign(k.sites.size(), -1);
    int requests = 0;
    forEach(k.body, [&](const Inst* i) {
        if (i->op != Op::Request) return;
        int& n = a.d.ordinals[static_cast<size_t>(i->site)];
        if (n < 0) n = requests++;
    });
    do {
        a.changed = false;
        a.region(k.body);
    } while (a.changed);
    a.d.channels = std::move(a.channel);
    return a.d;
}

Dependence analyseInput(const Kernel& k, const std::string& input) {
    Analysis a{k, {}, std::vector<uint8_t>(k.pool.size()), false, input};
    a.d.sites.resize(k.pool.size());
    a.d.ordinals.assign(k.sites.size(), -1);
    do {
        a.changed = false;
        a.region(k.body);
    } while (a.changed);
    return a.d;
}

} // namespace alpenglow::rsl::passes
