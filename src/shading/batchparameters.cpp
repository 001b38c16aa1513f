// What kernels read of parameters: the values of instances, or those of primitive variables that stand for them.
#include "shading/batch.h"
#include "shading/faceindex.h"
#include <algorithm>
#include <bit>

namespace alpenglow::shading {

/// Whether a variable of a primitive holds what a parameter is: as many numbers, or elements of the same kind (arrays of open
/// length).
static bool fits(const geometry::PrimVar& v, int components, int elements) {
    if (v.type == scene::Type::String) return false;
    return v.outWidth() == components * elements ||
           (v.arrayLength > 0 && elements > 1 && v.outWidth() == components * v.elements());
}

ParameterRows::ParameterRows(const BatchPlan& plan, const ParameterBlock& block) : plan_(&plan) {
    for (const BatchPlan::Source& s : plan.inputs_) {
        if (s.from != BatchPlan::From::Parameter) continue;
        const auto found = block.numbers.find(s.name.name);
        for (int c = 0; c < s.components * s.elements; ++c)
            numbers_.push_back(found != block.numbers.end() && c < int(found->second.size()) ? found->second[size_t(c)] : 0.f);
    }
}

/// By view, the numbers of a parameter, as many as it has components; absent ones are zero. The pointers are good until the next
/// call.
void Batch::findParameter(const BatchPlan::Source& s, const Views& views) {
    const size_t size = size_t(s.components) * s.elements;
    numbers_.clear();
    found_.clear();
    for (const InstanceView& v : views.views) {
        if (v.rows && v.rows->plan_ == plan_) {
            numbers_.push_back(v.rows->numbers_.data() + s.firstNumber);
            continue;
        }
        numbers_.push_back(nullptr);
        found_.resize(views.views.size() * size, 0.f);
        const auto at =
            v.parameters ? v.parameters->numbers.find(s.name.name) : std::map<std::string, std::vector<float>>::const_iterator{};
        if (v.parameters && at != v.parameters->numbers.end())
            std::copy_n(at->second.begin(), std::min(size, at->second.size()),
                        found_.begin() + long((numbers_.size() - 1) * size));
    }
    for (size_t k = 0; k < numbers_.size() && !found_.empty(); ++k)
        if (!numbers_[k]) numbers_[k] = found_.data() + k * size;
}

LightRows::Point LightRows::operator[](size_t) const {
    static const geometry::SurfacePoint nowhere;
    return {nullptr, nowhere};
}

template <class Points>
void Batch::fillParameter(const BatchPlan::Source& s, float* row, const Points& points, const Views& views) {
    const int n = int(points.size()), np = s.parts, comps = s.components, count = s.scalar ? 1 : n;
    const size_t stride = size_t(call_.stride);
    const bool moving =
        std::any_of(views.views.begin(), views.views.end(), [](const InstanceView& v) { return v.moving != nullptr; });
    findParameter(s, views);
    bool overridden = false; // by a primitive variable of some shape
    const geometry::Shape* last = nullptr;
    for (int i = 0; s.varying && primvars_ && !overridden && i < count; ++i)
        if (const geometry::Shape* shape = points[i].shape; shape && shape != last) {
            last = shape;
            overridden = !last->primvars().empty() && last->findPrimvar(s.name.name) >= 0;
        }
    if (overridden) return fillOverridden(s, row, points, views);
    if (s.varying && s.name.name == kFaceIndex && comps == 1) {
        for (int i = 0; i < count; ++i) row[i] = points[i].shape ? float(points[i].surface.face) : 0;
        for (int p = 1; p < np && !s.scalar; ++p) std::fill_n(row + size_t(p) * stride, n, 0.f);
        return;
    }
    for (int c = 0; c < comps * s.elements; ++c) { // component by component: a value for each instance, then a row
        valueOf_.clear();
        for (const float* numbers : numbers_) valueOf_.push_back(numbers[c]);
        float* to = s.scalar ? row + c : row + size_t(c) * np * stride;
        const bool same = std::all_of(valueOf_.begin(), valueOf_.end(), [&](float v) {
            return std::bit_cast<uint32_t>(v) == std::bit_cast<uint32_t>(valueOf_[0]);
        });
        if (same) std::fill_n(to, count, valueOf_[0]);
        else
            for (int i = 0; i < count; ++i) to[i] = valueOf_[views.index(i)];
        for (int i = 0; moving && i < count; ++i)
            if (views[i].moving) to[i] += views[i].moving->change(s.name.name, size_t(c), points[i].shutter);
        if (!s.scalar)
            for (int p = 1; p < np; ++p) std::fill_n(to + size_t(p) * stride, n, 0.f);
    }
}

/// The same where variables of primitives stand for the parameter at some of the points.
template <class Points>
void Batch::fillOverridden(const BatchPlan::Source& s, float* row, const Points& points, const Views& views) {
    const int n = int(points.size()), np = s.parts, comps = s.components, count = s.scalar ? 1 : n;
    const size_t stride = size_t(call_.stride);
    const auto at = [&](int component, int part, int point) -> float& {
        return s.scalar ? row[component] : row[(size_t(component) * np + part) * stride + point];
    };
    if (s.scalar) std::fill_n(row, size_t(comps) * s.elements, 0.f);
    else
        for (size_t r = 0; r < s.rows; ++r) std::fill_n(row + r * stride, n, 0.f);
    std::vector<float> interpolated; // value, du, dv
    for (int i = 0; i < count; ++i) {
        if (points[i].shape) {
            const int v = points[i].shape->findPrimvar(s.name.name);
            const geometry::PrimVar* variable = v >= 0 ? &points[i].shape->primvars()[size_t(v)] : nullptr;
            if (variable && fits(*variable, comps, s.elements)) {
                const size_t width = size_t(variable->outWidth());
                interpolated.resize(3 * width);
                float *value = interpolated.data(), *du = value + width, *dv = du + width;
                points[i].shape->interpolate(v, points[i].surface, value, du, dv);
                for (int c = 0; c < std::min(comps * s.elements, int(width)); ++c) {
                    at(c, 0, i) = value[c];
                    if (np > 1) {
                        at(c, 1, i) = du[c];
                        at(c, 2, i) = dv[c];
                    }
                }
                continue;
            }
        }
        if (points[i].shape && comps * s.elements == 1 && s.name.name == kFaceIndex) {
            at(0, 0, i) = float(points[i].surface.face);
            continue;
        }
        const float* numbers = numbers_[views.index(i)];
        for (int c = 0; c < comps * s.elements; ++c) {
            at(c, 0, i) = numbers[c];
            if (views[i].moving) at(c, 0, i) += views[i].moving->change(s.name.name, size_t(c), points[i].shutter);
        }
    }
}

void Batch::give(std::string_view parameter, int point, const GivenValue& v) {
    using Name = rsl::InputName::Kind;
    const size_t stride = size_t(call_.stride), elements = v.numbers.size() / size_t(rsl::ir::components(v.kind));
    bool fits = false;
    for (const BatchPlan::Source& s : plan_->inputs_) {
        const bool own = s.name.kind == Name::Parameter && !s.scalar, sent = s.name.kind == Name::Sent && !s.name.length;
        if ((!own && !sent) || s.name.name != parameter || s.kind != v.kind || s.array != v.array) continue;
        fits |= sent;
        float* row = storage_.get() + s.firstRow * stride + size_t(point);
        const size_t numbers = std::min(elements, size_t(s.elements)) * size_t(s.components);
        for (size_t c = 0; c < numbers; ++c)
            for (size_t part = 0; part < size_t(s.parts); ++part)
                row[(c * size_t(s.parts) + part) * stride] = part ? 0 : v.numbers[c];
    }
    for (const BatchPlan::Source& s : plan_->inputs_)
        if (fits && s.name.kind == Name::Sent && s.name.length && s.name.name == parameter)
            storage_[s.firstRow * stride + size_t(point)] = float(elements + 1);
}

template void Batch::fillParameter(const BatchPlan::Source&, float*, const std::span<const ShadePoint>&, const Views&);
template void Batch::fillParameter(const BatchPlan::Source&, float*, const SurfaceRows&, const Views&);
template void Batch::fillParameter(const BatchPlan::Source&, float*, const LightRows&, const Views&);

} // namespace alpenglow::shading
