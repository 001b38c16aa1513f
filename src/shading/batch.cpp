#include "shading/batch.h"
#include "shading/faceindex.h"
#include <algorithm>
#include <cstddef>
#include <cstring>

namespace alpenglow::shading {

namespace {

constexpr int16_t kZero = -1, kOne = -2, kThree = -3;
constexpr int16_t kLitNormal = -4; // Ng of ShadePoint::lit, Ns where it is not known
constexpr int16_t kAlongNg = -5;   // surface.Ng where that is known, else n
constexpr float kConstants[3] = {0, 1, 3};

// One line per predefined variable (RISpec 3.2, 12): where its parts {v, du, dv, duu, duv, dvv} lie in a ShadePoint. Second
// derivatives that the geometry does not know are zero.
struct Variable {
    const char* name;
    int16_t part[6];
};
#define AT(member) int16_t(offsetof(ShadePoint, member))
const Variable kVariables[] = {
    {"P", {AT(P), AT(surface.dPdu), AT(surface.dPdv), AT(surface.Puu), AT(surface.Puv), AT(surface.Pvv)}},
    {"dPdu", {AT(surface.dPdu), AT(surface.Puu), AT(surface.Puv), kZero, kZero, kZero}},
    {"dPdv", {AT(surface.dPdv), AT(surface.Puv), AT(surface.Pvv), kZero, kZero, kZero}},
    {"N", {AT(N), AT(surface.dNdu), AT(surface.dNdv), kZero, kZero, kZero}},
    {"Ng", {AT(surface.Ng), AT(surface.dNdu), AT(surface.dNdv), kZero, kZero, kZero}},
    {rsl::kSideNormal, {kAlongNg, kZero, kZero, kZero, kZero, kZero}},
    {"u", {AT(surface.u), kOne, kZero, kZero, kZero, kZero}},
    {"v", {AT(surface.v), kZero, kOne, kZero, kZero, kZero}},
    {"du", {AT(du), kZero, kZero, kZero, kZero, kZero}},
    {"dv", {AT(dv), kZero, kZero, kZero, kZero, kZero}},
    {"s", {AT(surface.s), AT(surface.dsdu), AT(surface.dsdv), kZero, kZero, kZero}},
    {"t", {AT(surface.t), AT(surface.dtdu), AT(surface.dtdv), kZero, kZero, kZero}},
    {"I", {AT(I), AT(surface.dPdu), AT(surface.dPdv), AT(surface.Puu), AT(surface.Puv), AT(surface.Pvv)}},
    {"E", {AT(E), kZero, kZero, kZero, kZero, kZero}},
    {"Ci", {AT(Ci), kZero, kZero, kZero, kZero, kZero}},
    {"Oi", {AT(Oi), kZero, kZero, kZero, kZero, kZero}},
    {"alpha", {AT(alpha), kZero, kZero, kZero, kZero, kZero}},
    {"Ps", {AT(Ps), kZero, kZero, kZero, kZero, kZero}},
    {"Ns", {AT(Ns), kZero, kZero, kZero, kZero, kZero}},
    {"Ngs", {kLitNormal, kZero, kZero, kZero, kZero, kZero}},
    {"ncomps", {kThree, kZero, kZero, kZero, kZero, kZero}},
    {"time", {AT(time), kZero, kZero, kZero, kZero, kZero}},
    {"dtime", {AT(dtime), kZero, kZero, kZero, kZero, kZero}},
    {"dPdtime", {AT(dPdtime), kZero, kZero, kZero, kZero, kZero}},
};
#undef AT

/// What of a surface lies at an offset of ShadePoint.
uint32_t needOf(int16_t offset, uint32_t& lit) {
    if (offset == kLitNormal) lit |= geometry::kNeedNg;
    const auto within = [&](size_t from, size_t size) { return offset >= int(from) && offset < int(from + size); };
#define OF(member) within(offsetof(ShadePoint, member), sizeof(ShadePoint::member))
#define OF_SURFACE(member) within(offsetof(ShadePoint, surface.member), sizeof(geometry::SurfacePoint::member))
    if (OF(N) || OF_SURFACE(N)) return geometry::kNeedN;
    if (OF(du) || OF(dv) || OF_SURFACE(dPdu) || OF_SURFACE(dPdv) || OF_SURFACE(Puu) || OF_SURFACE(Puv) || OF_SURFACE(Pvv))
        return geometry::kNeedPartials;
    if (OF_SURFACE(Ng)) return geometry::kNeedNg;
    if (OF_SURFACE(dNdu) || OF_SURFACE(dNdv)) return geometry::kNeedNormalSlopes;
    if (OF_SURFACE(u) || OF_SURFACE(v)) return geometry::kNeedUV;
    if (OF_SURFACE(s) || OF_SURFACE(t)) return geometry::kNeedST;
    if (OF_SURFACE(dsdu) || OF_SURFACE(dsdv) || OF_SURFACE(dtdu) || OF_SURFACE(dtdv)) return geometry::kNeedSTSlopes;
#undef OF
#undef OF_SURFACE
    return 0;
}

constexpr int16_t kLightVariables[] = {offsetof(ShadePoint, P), offsetof(ShadePoint, N), offsetof(ShadePoint, Ps)}; // LightRows
bool inLightRows(int16_t offset) {
    return std::find(std::begin(kLightVariables), std::end(kLightVariables), offset) != std::end(kLightVariables);
}

bool isNoMember(int16_t offset) { return offset == kZero || offset == kOne || offset == kThree || offset == kAlongNg; }
const Vec3& alongNg(const geometry::SurfacePoint& p) { return p.Ng == Vec3() ? p.n : p.Ng; }
/// Ci, Oi and alpha of surfaces are zero before they are shaded.
bool isZeroOfSurfaces(int16_t offset) {
    return offset == offsetof(ShadePoint, Ci) || offset == offsetof(ShadePoint, Oi) || offset == offsetof(ShadePoint, alpha);
}
/// The rows of SurfaceRows that hold it; none: it is of the surface.
std::span<const float> ownRows(const SurfaceRows& r, int16_t offset) {
    return offset == offsetof(ShadePoint, I)    ? r.I
           : offset == offsetof(ShadePoint, E)  ? r.E
           : offset == offsetof(ShadePoint, du) ? r.du
           : offset == offsetof(ShadePoint, dv) ? r.dv
                                                : std::span<const float>();
}
bool inOwnRows(int16_t offset) {
    constexpr size_t kOwn[] = {offsetof(ShadePoint, I), offsetof(ShadePoint, E), offsetof(ShadePoint, du),
                               offsetof(ShadePoint, dv)};
    return offset >= 0 &&
           (std::find(std::begin(kOwn), std::end(kOwn), size_t(offset)) != std::end(kOwn) || isZeroOfSurfaces(offset));
}
/// Where in a SurfacePoint lies what is at an offset of a ShadePoint whose surface is not moved; -1: nowhere.
int geometryOffset(int16_t offset) {
    if (offset == offsetof(ShadePoint, P)) return offsetof(geometry::SurfacePoint, P);
    if (offset == offsetof(ShadePoint, N)) return offsetof(geometry::SurfacePoint, N);
    const int at = int(offset) - int(offsetof(ShadePoint, surface));
    return at >= 0 && at < int(sizeof(geometry::SurfacePoint)) ? at : -1;
}

} // namespace

size_t MovingSpace::keyAt(float time, float& way) const {
    way = 0;
    if (times.size() < 2 || !(time > times.front())) return 0;
    if (time >= times.back()) return way = 1, times.size() - 2;
    const size_t k = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin()) - 1;
    way = (time - times[k]) / (times[k + 1] - times[k]);
    return k;
}

Matrix MovingSpace::at(float time) const {
    float way;
    const size_t k = keyAt(time, way);
    Matrix m = toCurrent[k];
    if (way > 0)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) m.m[y][x] += double(way) * (toCurrent[k + 1].m[y][x] - m.m[y][x]);
    return m;
}

float MovingSpace::change(const std::string& parameter, size_t component, float time) const {
    float way;
    const size_t k = keyAt(time, way);
    const auto value = [&](size_t key) {
        const auto i = parameters[key].numbers.find(parameter);
        return i != parameters[key].numbers.end() && component < i->second.size() ? i->second[component] : 0.f;
    };
    const float there = value(k);
    return there - value(0) + (way > 0 ? way * (value(k + 1) - there) : 0.f);
}

BatchPlan::BatchPlan(const rsl::CompiledKernel& kernel, bool mixed) {
    for (const rsl::ir::Input& input : kernel.inputs()) {
        Source s;
        s.components = rsl::ir::components(input.kind);
        s.elements = std::max(1, input.array);
        s.parts = rsl::inputParts(input);
        s.scalar = input.uniform && !mixed;
        s.varying = !input.uniform;
        s.array = input.array != 0;
        s.kind = input.kind;
        s.firstRow = rows_;
        s.rows = size_t(s.components) * s.elements * s.parts;
        rows_ += s.rows;
        s.name = rsl::InputName::parse(input.name);
        if (s.name.kind == rsl::InputName::Kind::Space) {
            s.from = From::Space;
        } else if (s.name.kind == rsl::InputName::Kind::Parameter) {
            s.from = From::Parameter;
            s.firstNumber = numbers_;
            numbers_ += size_t(s.components) * s.elements;
        } else if (s.name.kind == rsl::InputName::Kind::Displacement) {
            s.from = From::Displacement;
            using rsl::OutputName;
            const auto hear = [&](int element, int part, OutputName::What what) {
                s.outputs.push_back({s.name.member ? OutputName::left(s.name.name, s.name.length, what)
                                                   : OutputName::parameterOf(s.name.name, -1, what),
                                     std::max(element, 0), part});
                s.outputs.back().output.element = element;
            };
            hear(-1, 0, OutputName::What::Value);
            for (int e = 0; e < s.elements; ++e) hear(e, 0, OutputName::What::Value);
            if (s.parts > 1) hear(-1, 1, OutputName::What::Du), hear(-1, 2, OutputName::What::Dv);
        } else if (input.name == "Cs" || input.name == "Os") {
            s.from = input.name == "Cs" ? From::Cs : From::Os;
        } else {
            for (const Variable& v : kVariables)
                if (input.name == v.name) {
                    footprint_ |= input.name == "du" || input.name == "dv";
                    s.from = From::Variable;
                    std::copy(v.part, v.part + 6, s.offset);
                    for (int part = 0; part < s.parts; ++part) needs_ |= needOf(v.part[part], litNeeds_);
                }
        }
        const auto inSurfaceRows = [&](int16_t offset) {
            return geometryOffset(offset) >= 0 || inOwnRows(offset) || isNoMember(offset);
        };
        if (s.from == From::Variable) surfaceRows_ &= std::all_of(s.offset, s.offset + s.parts, inSurfaceRows) && !s.scalar;
        else surfaceRows_ &= s.from != From::Displacement && s.from != From::Nothing;
        normal_ |= s.from == From::Variable && s.offset[0] == offsetof(ShadePoint, N);
        if (s.from == From::Parameter) lightRows_ &= !s.varying || s.name.name != kFaceIndex;
        else lightRows_ &= s.from == From::Variable && !s.scalar && inLightRows(s.offset[0]) && s.parts == 1;
        inputs_.push_back(std::move(s));
    }
    for (const rsl::ir::OutputSlot& o : kernel.outputs()) {
        outputRow_.push_back(rows_);
        outputs_.push_back(rsl::OutputName::parse(o.name));
        rows_ += size_t(rsl::ir::components(o.kind));
    }
    Ci = output("Ci");
    Oi = output("Oi");
    P = output("P");
    N = output("N");
}

bool BatchPlan::overriddenBy(const geometry::Shape& shape) const {
    return std::any_of(inputs_.begin(), inputs_.end(), [&](const Source& s) {
        return s.from == From::Parameter && s.varying && shape.findPrimvar(s.name.name) >= 0;
    });
}

int BatchPlan::output(const rsl::OutputName& name) const {
    const auto at = std::find(outputs_.begin(), outputs_.end(), name);
    return at == outputs_.end() ? -1 : int(at - outputs_.begin());
}

int BatchPlan::output(std::string_view name) const {
    for (size_t i = 0; i < outputs_.size(); ++i) {
        const rsl::OutputName& o = outputs_[i];
        if (o.what == rsl::OutputName::What::Value && !o.parameter && o.element < 0 && o.block == 0 && o.name == name)
            return int(i);
    }
    return -1;
}

Batch::Batch(std::shared_ptr<const rsl::CompiledKernel> k, const BatchPlan& plan, std::span<const ShadePoint> points,
             std::span<const InstanceView> views, const SpaceResolver& spaces) {
    // A batch holds few instances, mostly in turns: the last ones are looked through, so that names are searched about once each.
    constexpr size_t kLast = 8;
    std::vector<InstanceView> different;
    std::vector<uint32_t> of;
    of.reserve(views.size());
    for (const InstanceView& v : views) {
        size_t last = different.size(), end = last > kLast ? last - kLast : 0;
        auto same = [&](const InstanceView& a) { return a.parameters == v.parameters && a.shaderToCurrent == v.shaderToCurrent; };
        while (last > end && !same(different[last - 1])) --last;
        if (last == end) {
            different.push_back(v);
            last = different.size();
        }
        of.push_back(uint32_t(last - 1));
    }
    assign(std::move(k), plan, points, different, of, spaces);
}

/// Memory for a call over so many points; outputs are zero.
void Batch::layOut(std::shared_ptr<const rsl::CompiledKernel> k, const BatchPlan& plan, size_t points) {
    kernel_ = std::move(k);
    plan_ = &plan;
    size_t lanes = size_t(std::max(1, kernel_->lanes()));
    call_.n = int32_t(points);
    call_.stride = int32_t((points + 63) / 64 * 64);
    call_.strings = kernel_->strings().data();
    size_t stride = size_t(call_.stride), total = std::max<size_t>(1, plan.rows_) * std::max<size_t>(stride, 64);
    padded_ = std::min(stride, (points + lanes - 1) / lanes * lanes);
    if (total > capacity_) {
        storage_.reset();
        storage_.reset(static_cast<float*>(::operator new[](total * sizeof(float), std::align_val_t(64))));
        capacity_ = total;
    }
    in_.clear();
    out_.clear();
    for (const BatchPlan::Source& s : plan.inputs_) in_.push_back(storage_.get() + s.firstRow * stride);
    for (size_t row : plan.outputRow_) out_.push_back(storage_.get() + row * stride);
    if (!plan.outputRow_.empty()) // what lanes leave unwritten must not be garbage
        for (size_t row = plan.outputRow_[0]; row < plan.rows_; ++row) std::fill_n(storage_.get() + row * stride, padded_, 0.f);
    call_.in = in_.data();
    call_.out = out_.data();
}

template <class Points> void Batch::fillInputs(const Points& points, const Views& views, const SpaceResolver& spaces) {
    fillVariables(points);
    primvars_ = false;
    const geometry::Shape* last = nullptr;
    for (size_t i = 0; i < points.size() && !primvars_; ++i)
        if (const geometry::Shape* shape = points[i].shape; shape != last && (last = shape))
            primvars_ = !last->primvars().empty();
    for (const BatchPlan::Source& s : plan_->inputs_) {
        float* row = storage_.get() + s.firstRow * size_t(call_.stride);
        if (s.from != BatchPlan::From::Variable) fill(s, row, points, views, spaces);
        pad(s, row);
    }
}

void Batch::assign(std::shared_ptr<const rsl::CompiledKernel> k, const BatchPlan& plan, std::span<const ShadePoint> points,
                   std::span<const InstanceView> views, std::span<const uint32_t> viewOf, const SpaceResolver& spaces) {
    layOut(std::move(k), plan, points.size());
    if (!points.empty()) fillInputs(points, {views, viewOf}, spaces);
}

void Batch::assign(std::shared_ptr<const rsl::CompiledKernel> k, const BatchPlan& plan, const SurfaceRows& rows,
                   std::span<const InstanceView> views, std::span<const uint32_t> viewOf, const SpaceResolver& spaces) {
    layOut(std::move(k), plan, rows.size());
    fillInputs(rows, {views, viewOf}, spaces);
}

void Batch::assign(std::shared_ptr<const rsl::CompiledKernel> k, const BatchPlan& plan, const LightRows& rows,
                   std::span<const InstanceView> views, std::span<const uint32_t> viewOf) {
    const size_t points = rows.size();
    layOut(std::move(k), plan, points);
    primvars_ = false;
    const std::span<const float> of[] = {rows.P, rows.N, rows.Ps};
    for (const BatchPlan::Source& s : plan.inputs_) {
        float* row = storage_.get() + s.firstRow * size_t(call_.stride);
        if (s.from == BatchPlan::From::Parameter) {
            fillParameter(s, row, rows, {views, viewOf});
            pad(s, row);
            continue;
        }
        const auto from = of[std::find(std::begin(kLightVariables), std::end(kLightVariables), s.offset[0]) - kLightVariables];
        for (size_t c = 0; c < 3; ++c) std::copy_n(from.data() + c * points, points, row + c * size_t(call_.stride));
        pad(s, row);
    }
}

// Lanes past n repeat the last point, so that no garbage is computed on.
void Batch::pad(const BatchPlan::Source& s, float* row) {
    if (s.scalar) return;
    size_t stride = size_t(call_.stride), n = size_t(call_.n);
    if (padded_ > n)
        for (size_t r = 0; r < s.rows; ++r) std::fill(row + r * stride + n, row + r * stride + padded_, row[r * stride + n - 1]);
}

void Batch::takeDisplacement(const Batch& displaced) {
    const size_t stride = size_t(call_.stride);
    for (const BatchPlan::Source& s : plan_->inputs_) {
        if (s.from != BatchPlan::From::Displacement) continue;
        float* row = storage_.get() + s.firstRow * stride;
        for (const BatchPlan::Source::Output& h : s.outputs) {
            const int o = displaced.output(h.output);
            for (int c = 0; o >= 0 && c < s.components; ++c)
                std::memcpy(row + size_t((h.element * s.components + c) * s.parts + h.part) * stride,
                            displaced.out_[size_t(o)] + size_t(c) * size_t(displaced.call_.stride),
                            size_t(call_.n) * sizeof(float));
        }
        pad(s, row);
    }
}

void Batch::fillVariables(std::span<const ShadePoint> points) {
    // Some points at a time for all variables: their structures then come from memory once.
    constexpr size_t kTogether = 32;
    size_t stride = size_t(call_.stride), n = points.size();
    for (size_t first = 0; first < n; first += kTogether) {
        size_t end = std::min(n, first + kTogether);
        for (const BatchPlan::Source& s : plan_->inputs_) {
            if (s.from != BatchPlan::From::Variable || (s.scalar && first > 0)) continue;
            size_t to = s.scalar ? 1 : end, parts = s.scalar ? 1 : size_t(s.parts), next = s.scalar ? 1 : stride;
            float* row = storage_.get() + s.firstRow * stride;
            for (size_t c = 0; c < size_t(s.components); ++c)
                for (size_t p = 0; p < parts; ++p, row += next) {
                    if (s.offset[p] == kLitNormal) {
                        for (size_t i = first; i < to; ++i)
                            row[i] = points[i].lit ? points[i].lit->Ng[int(c)] : points[i].Ns[int(c)];
                        continue;
                    }
                    if (s.offset[p] == kAlongNg) {
                        for (size_t i = first; i < to; ++i) row[i] = alongNg(points[i].surface)[int(c)];
                        continue;
                    }
                    if (s.offset[p] < 0) {
                        std::fill(row + first, row + to, kConstants[-1 - s.offset[p]]);
                        continue;
                    }
                    const char* from = reinterpret_cast<const char*>(points.data()) + s.offset[p] + c * sizeof(float);
                    for (size_t i = first; i < to; ++i) std::memcpy(row + i, from + i * sizeof(ShadePoint), sizeof(float));
                }
        }
    }
}

void Batch::fillVariables(const SurfaceRows& points) {
    const size_t stride = size_t(call_.stride), n = points.size();
    constexpr size_t kTogether = 32; // as above
    for (size_t first = 0; first < n; first += kTogether) {
        const size_t count = std::min(n - first, kTogether);
        for (const BatchPlan::Source& s : plan_->inputs_) {
            if (s.from != BatchPlan::From::Variable) continue;
            float* row = storage_.get() + s.firstRow * stride + first;
            for (size_t c = 0; c < size_t(s.components); ++c)
                for (size_t p = 0; p < size_t(s.parts); ++p, row += stride) fillRow(points, s.offset[p], c, first, {row, count});
        }
    }
}

/// A component of a variable at some points from `first` on.
void Batch::fillRow(const SurfaceRows& points, int16_t offset, size_t component, size_t first, std::span<float> row) {
    if (offset == kAlongNg) {
        for (size_t i = 0; i < row.size(); ++i) row[i] = alongNg(points.surfaces[first + i])[int(component)];
    } else if (offset < 0 || isZeroOfSurfaces(offset)) {
        std::fill(row.begin(), row.end(), offset < 0 ? kConstants[-1 - offset] : 0.f);
    } else if (inOwnRows(offset)) {
        std::copy_n(ownRows(points, offset).data() + component * points.size() + first, row.size(), row.data());
    } else {
        const char* from =
            reinterpret_cast<const char*>(points.surfaces.data() + first) + geometryOffset(offset) + component * sizeof(float);
        for (size_t i = 0; i < row.size(); ++i) std::memcpy(&row[i], from + i * sizeof(geometry::SurfacePoint), sizeof(float));
    }
}

template <class Points>
void Batch::fill(const BatchPlan::Source& s, float* row, const Points& points, const Views& views, const SpaceResolver& spaces) {
    using From = BatchPlan::From;
    switch (s.from) {
    case From::Variable:
        return; // fillVariables
    case From::Cs:
    case From::Os:
        return fillColor(s, row, points);
    case From::Space:
        return fillSpace(s, row, points, views, spaces);
    case From::Parameter:
        return fillParameter(s, row, points, views);
    case From::Displacement: // takeDisplacement()
    case From::Nothing:
        std::fill_n(row, s.rows * size_t(call_.stride), 0.f);
        return;
    }
}

/// Cs and Os: attributes, or variables of primitives.
template <class Points> void Batch::fillColor(const BatchPlan::Source& s, float* row, const Points& points) {
    const bool isColor = s.from == BatchPlan::From::Cs;
    const int np = s.parts, comps = s.components, count = s.scalar ? 1 : int(points.size());
    const size_t stride = size_t(call_.stride);
    const auto at = [&](int component, int part, int point) -> float& {
        return s.scalar ? row[component] : row[(size_t(component) * np + part) * stride + point];
    };
    const geometry::Shape* last = nullptr; // neighbours are mostly of one shape: its variables are searched once
    int v = -1;
    for (int i = 0; i < count; ++i) {
        const geometry::Shape* shape = points[i].shape;
        if (shape && shape->primvars().empty()) { // the usual case
            const Color& c = isColor ? shape->attributes().color : shape->attributes().opacity;
            for (int k = 0; k < std::min(comps, 3); ++k) {
                at(k, 0, i) = c[k];
                if (!s.scalar)
                    for (int p = 1; p < np; ++p) at(k, p, i) = 0;
            }
            continue;
        }
        float value[16] = {1, 1, 1}, du[16] = {}, dv[16] = {};
        if (shape) {
            const Color& c = isColor ? shape->attributes().color : shape->attributes().opacity;
            for (int k = 0; k < 3; ++k) value[k] = c[k];
            if (shape != last) {
                v = shape->findPrimvar(isColor ? "Cs" : "Os");
                last = shape;
            }
            if (v >= 0) shape->interpolate(v, points[i].surface, value, du, dv);
        }
        for (int c = 0; c < comps; ++c) {
            at(c, 0, i) = value[c];
            if (np > 1 && !s.scalar) {
                at(c, 1, i) = du[c];
                at(c, 2, i) = dv[c];
                for (int p = 3; p < np; ++p) at(c, p, i) = 0;
            }
        }
    }
}

/// Matrices between spaces.
template <class Points>
void Batch::fillSpace(const BatchPlan::Source& s, float* row, const Points& points, const Views& views,
                      const SpaceResolver& spaces) {
    const int np = s.parts, count = s.scalar ? 1 : int(points.size());
    const auto at = [&](int component, int part, int point) -> float& {
        return s.scalar ? row[component] : row[(size_t(component) * np + part) * size_t(call_.stride) + point];
    };
    for (int i = 0; i < count; ++i) {
        const geometry::Shape* shape = points[i].shape;
        const float shutter = points[i].shutter;
        if (i > 0 && shape == points[i - 1].shape && views.index(i) == views.index(i - 1) && shutter == points[i - 1].shutter) {
            for (int c = 0; c < 16; ++c) at(c, 0, i) = at(c, 0, i - 1);
            continue;
        }
        Matrix m;
        auto own = [&](const std::string& space, Matrix& toCurrent) {
            if (space == "object" && shape) {
                toCurrent = shape->toCameraAt(shutter);
                return true;
            }
            if (space == "shader" && views[i].shaderToCurrent) {
                toCurrent = views[i].moving ? views[i].moving->at(shutter) : *views[i].shaderToCurrent;
                return true;
            }
            return false;
        };
        if (!(s.name.to == "current" && own(s.name.from, m))) {
            if (s.name.from == "current" && own(s.name.to, m)) m = inverse(m);
            else spaces.matrix(s.name.from, s.name.to, m);
        }
        for (int c = 0; c < 16; ++c) at(c, 0, i) = float(m.m[c / 4][c % 4]);
    }
}

} // namespace alpenglow::shading
