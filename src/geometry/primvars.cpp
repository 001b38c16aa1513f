#include "geometry/primvars.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Type;

namespace {

std::vector<float> toCameraValues(const scene::Param& p, const Matrix& m) {
    std::vector<float> r(p.numbers.size());
    int c = scene::componentCount(p.type);
    for (size_t i = 0; i + c <= p.numbers.size(); i += c) {
        const float* s = &p.numbers[i];
        if (p.type == Type::HPoint) {
            for (int k = 0; k < 4; ++k)
                r[i + k] = float(s[0] * m.m[0][k] + s[1] * m.m[1][k] + s[2] * m.m[2][k] + s[3] * m.m[3][k]);
            continue;
        }
        Vec3d v(s[0], s[1], s[2]);
        Vec3d q = p.type == Type::Point    ? transformPoint(m, v)
                  : p.type == Type::Vector ? transformVector(m, v)
                                           : transformNormal(m, v);
        for (int k = 0; k < 3; ++k) r[i + k] = float(q[k]);
    }
    return r;
}

} // namespace

const scene::Param* lastParam(const scene::ParamList& list, std::string_view name) {
    const scene::Param* found = nullptr;
    for (const scene::Param& p : list)
        if (p.name == name) found = &p;
    return found;
}

bool makePrimVar(const scene::Param& p, size_t count, const Matrix& toCamera, const std::string& kind, Diagnostics& diag,
                 PrimVar& out) {
    out.name = p.name;
    out.cls = p.cls;
    out.type = p.type;
    out.arrayLength = p.arrayLength;
    out.param = &p;
    if ((p.name == "Cs" || p.name == "Os") && (p.type == Type::String || out.outWidth() != 3)) {
        diag.report(Severity::Error, Rie::BadToken, p.place,
                    kind + " \"" + p.name + "\" is not declared as a color; the variable is ignored");
        return false;
    }
    size_t have = p.type == Type::String ? p.strings.size() : p.numbers.size();
    size_t per = p.type == Type::String ? size_t(out.elements()) : size_t(out.width());
    size_t need = count * per;
    if (have < need) {
        diag.report(Severity::Error, Rie::MissingData, p.place,
                    kind + " \"" + p.name + "\": " + std::to_string(have) + " values given, " + std::to_string(need) +
                        " needed; the variable is ignored");
        return false;
    }
    if (have > need)
        diag.report(Severity::Warning, Rie::Consistency, p.place,
                    kind + " \"" + p.name + "\": " + std::to_string(have) + " values given, only the first " +
                        std::to_string(need) + " are used");
    if (p.type != Type::String &&
        !std::all_of(p.numbers.begin(), p.numbers.begin() + ptrdiff_t(need), [](float f) { return std::isfinite(f); })) {
        diag.report(Severity::Error, Rie::Range, p.place,
                    kind + " \"" + p.name + "\" holds a number that is not finite; the variable is ignored");
        return false;
    }
    if (p.type == Type::Point || p.type == Type::Vector || p.type == Type::Normal || p.type == Type::HPoint)
        out.cameraValues = toCameraValues(p, toCamera);
    return true;
}

void interpolatePrimVar(const PrimVar& var, const Weight* w, int n, float* out, float* du, float* dv) {
    int width = var.width();
    const float* data = var.data();
    auto sum = [&](int c, double& f, double& fu, double& fv) {
        f = fu = fv = 0;
        for (int i = 0; i < n; ++i) {
            double x = data[w[i].index * size_t(width) + size_t(c)];
            f += w[i].w * x;
            fu += w[i].du * x;
            fv += w[i].dv * x;
        }
    };
    double f, fu, fv;
    if (var.type != Type::HPoint) {
        for (int c = 0; c < width; ++c) {
            sum(c, f, fu, fv);
            out[c] = float(f);
            if (du) du[c] = float(fu);
            if (dv) dv[c] = float(fv);
        }
        return;
    }
    for (int e = 0; e < var.elements(); ++e) {
        double h, hu, hv;
        sum(4 * e + 3, h, hu, hv);
        double inv = h != 0 ? 1 / h : 0;
        for (int c = 0; c < 3; ++c) {
            sum(4 * e + c, f, fu, fv);
            double q = f * inv;
            out[3 * e + c] = float(q);
            if (du) du[3 * e + c] = float((fu - q * hu) * inv);
            if (dv) dv[3 * e + c] = float((fv - q * hv) * inv);
        }
    }
}

} // namespace alpenglow::geometry
