#include "geometry/build.h"
#include "base/exact.h"
#include "base/limits.h"
#include "geometry/dice.h"
#include "geometry/factories.h"
#include "geometry/given_normals.h"
#include "geometry/instance_attributes.h"
#include "geometry/placed.h"
#include "scene/deferred.h"
#include "scene/primitivekinds.h"
#include "scene/scene.h"
#include "scene/solids.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

namespace alpenglow::geometry {
namespace {

void once(Diagnostics& diag, const std::string& key, Rie code, const SourcePlace& place, const std::string& message) {
    Diagnostic d;
    d.severity = Severity::Warning;
    d.code = code;
    d.place = place;
    d.message = message;
    diag.reportOnce("geometry:" + key, d);
}

bool unset(const scene::Basis& b) {
    for (auto& row : b.m)
        for (double x : row)
            if (x != 0) return false;
    return true;
}

// RenderMan's defaults if the caller has no attributes or basis.
void fillBasis(scene::Basis& b) {
    if (!unset(b)) return;
    static constexpr double bezier[4][4] = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
    std::memcpy(b.m, bezier, sizeof bezier);
    b.step = 3;
}

} // namespace

ShapeRef buildShape(const scene::PrimitiveRef& prim, const scene::AttributesRef& given, const Matrix& toCamera, int instance,
                    Diagnostics& diag, Facing facing, const Shape* like) {
    const Factory* entry = nullptr;
    for (const Factory& e : kFactories)
        if (prim->kind == e.kind) entry = &e;
    if (!entry) {
        std::string what = prim->kind;
        if (what == "Geometry" && !prim->strings.empty()) what += " \"" + prim->strings[0] + "\"";
        once(diag, "kind:" + what, Rie::Unimplement, prim->place, what + " is not yet drawn");
        return nullptr;
    }
    // Exporters invert matrices in single precision: rounding errors in the last column are no perspective.
    constexpr double noise = 1e-7;
    bool affine = std::fabs(toCamera.m[0][3]) < noise && std::fabs(toCamera.m[1][3]) < noise &&
                  std::fabs(toCamera.m[2][3]) < noise && std::fabs(toCamera.m[3][3] - 1) < noise;
    bool finite = true;
    for (auto& row : toCamera.m)
        for (double x : row) finite = finite && std::isfinite(x);
    if (!finite || determinant3(toCamera) == 0) {
        diag.report(Severity::Warning, Rie::Math, prim->place,
                    prim->kind + " has a transformation without inverse; it is not drawn");
        return nullptr;
    }
    if (!affine)
        once(diag, "projective", Rie::Incapable, prim->place,
             "a transformation of this " + prim->kind + " contains a perspective; derivatives and quadrics ignore it");
    ShapeSource s;
    s.primitive = prim;
    s.toCamera = toCamera;
    s.instance = instance;
    s.facing = facing;
    s.attributes = given;
    s.like = like;
    const bool basis = scene::has(prim->kind, scene::kTakesBasis);
    if (!given || (basis && (unset(given->ubasis) || unset(given->vbasis)))) {
        auto a = given ? std::make_shared<scene::Attributes>(*given) : std::make_shared<scene::Attributes>();
        fillBasis(a->ubasis);
        fillBasis(a->vbasis);
        s.attributes = std::move(a);
    }
    return entry->make(std::move(s), diag);
}

namespace {

using scene::PrimitiveRef;
using scene::Transform;

bool affine(const Matrix& m) {
    constexpr double noise = 1e-7;
    return std::fabs(m.m[0][3]) < noise && std::fabs(m.m[1][3]) < noise && std::fabs(m.m[2][3]) < noise &&
           std::fabs(m.m[3][3] - 1) < noise;
}
bool invertible(const Matrix& m) {
    bool singular = false;
    inverse(m, &singular);
    return !singular && determinant3(m) != 0;
}

/// Centroid of a primitive's points, object space; for a quadric, its origin.
Vec3d centreOf(const scene::Primitive& p) {
    Bounds b;
    if (const scene::Param* P = scene::find(p.params, "P"))
        for (size_t i = 0; i + 2 < P->numbers.size(); i += 3) b.add(Vec3(P->numbers[i], P->numbers[i + 1], P->numbers[i + 2]));
    if (b.empty()) b.add(Vec3(0.f));
    return Vec3d(b.lo) * 0.5 + Vec3d(b.hi) * 0.5;
}

/// Makes the shapes of one frame.
class FrameBuilder {
public:
    FrameBuilder(const scene::Frame& f, Diagnostics& d, const BuildOptions& o)
        : frame_(f), diag_(d), options_(o), shutter_(f.options), camera_(scene::at(f.options.worldToCamera, shutter_.open)),
          // REYES turned them to the eye; with ray tracing they turn to each ray.
          facing_(f.options.hider != "hidden"             ? Facing::Ray
                  : f.options.projection == "perspective" ? Facing::Eye
                                                          : Facing::Picture) {}
    std::vector<ShapeRef> run();

private:
    struct Shared {
        ShapeRef geometry;
        Matrix from; ///< its space to object space
        std::shared_ptr<SharedBounds> bounds;
        bool normalsDecide = false; ///< which side is the front, in all places
    };
    struct Usage {
        std::vector<const scene::Instance*> by;
    };

    bool full(const SourcePlace&);
    /// place: object to camera, over the shutter.
    void add(const PrimitiveRef&, const scene::AttributesRef&, Transform place, int instance);
    void addShared(const PrimitiveRef&, const scene::AttributesRef&, const Transform& place, const scene::Instance&,
                   int instance);
    ShapeRef geometryOf(const PrimitiveRef&, const scene::AttributesRef&, const Matrix& toCamera, int instance);
    /// buildShape(), with the front where given normals are.
    ShapeRef shapeOf(const PrimitiveRef&, const scene::AttributesRef&, const Matrix& toCamera, int instance);
    const scene::AttributesRef& turned(const scene::AttributesRef&); ///< with ReverseOrientation
    scene::AttributesRef coarser(const scene::AttributesRef&, const scene::Primitive&, const Transform& place) const;
    bool shares(const scene::Primitive&, const scene::Attributes*, size_t instances) const;
    const Matrix& nearest(const scene::Instance&, const scene::Primitive&);
    Transform overShutter(const Transform& toWorld) const;

    const scene::Frame& frame_;
    Diagnostics& diag_;
    const BuildOptions& options_;
    scene::Shutter shutter_;
    Matrix camera_;
    Facing facing_;
    std::vector<ShapeRef> out_;
    std::vector<Usage> usage_; ///< by object
    std::map<std::tuple<int, const scene::Primitive*, const void*>, Shared>
        shared_; ///< by object, primitive and the attributes that matter
    std::map<std::pair<int, const scene::Primitive*>, Matrix> nearest_;
    std::map<scene::AttributesRef, scene::AttributesRef> turned_;
};

bool FrameBuilder::full(const SourcePlace& place) {
    if (out_.size() < options_.most) return false;
    once(diag_, "limit", Rie::Limit, place,
         "the frame has more than " + std::to_string(options_.most) + " primitives; the rest is not drawn");
    return true;
}

/// Object to camera, over the shutter.
Transform FrameBuilder::overShutter(const Transform& toWorld) const {
    Transform t = scene::overShutter(toWorld, shutter_);
    for (Matrix& m : t.keys) m = m * camera_;
    return t;
}

const scene::AttributesRef& FrameBuilder::turned(const scene::AttributesRef& a) {
    scene::AttributesRef& other = turned_[a];
    if (!other) {
        auto copy = std::make_shared<scene::Attributes>(*a);
        (copy->absoluteHandedness ? copy->rightHanded : copy->inside) ^= true;
        other = std::move(copy);
    }
    return other;
}

ShapeRef FrameBuilder::shapeOf(const PrimitiveRef& p, const scene::AttributesRef& a, const Matrix& toCamera, int instance) {
    ShapeRef s = buildShape(p, a, toCamera, instance, diag_, facing_);
    if (!s || normalsSay(*s, diag_) != NormalsSay::Back) return s;
    Diagnostics reported; // messages of the primitive have been reported
    return buildShape(p, turned(s->attributesRef()), toCamera, instance, reported, facing_);
}

/// The primitive at one or several times of the shutter, in the space that toCamera leads to. Null: reported.
ShapeRef FrameBuilder::geometryOf(const PrimitiveRef& p, const scene::AttributesRef& a, const Matrix& toCamera, int instance) {
    std::vector<float> times = scene::keysOverShutter(*p, shutter_);
    if (times.size() > 1) {
        // Quadrics interpolate their parameters, not their points: keys follow the parameters.
        const PrimitiveRef last = scene::primitiveAt(p, shutter_.close);
        if (scene::has(p->kind, scene::kQuadric) && p->numbers != last->numbers) {
            std::vector<float> more;
            for (size_t i = 0; i + 1 < times.size(); ++i)
                for (int k = 0; k < 8; ++k) more.push_back(times[i] + (times[i + 1] - times[i]) * float(k) / 8);
            more.push_back(1);
            times = std::move(more);
        }
    }
    std::vector<ShapeRef> keys;
    for (float t : times) {
        PrimitiveRef now = scene::primitiveAt(p, shutter_.at(t));
        const bool pieces = scene::has(p->kind, scene::kPieces);
        if (pieces && times.size() > 1 && keys.empty() && now->motionKeys.empty()) { // the shutter opens between keys: isKey()
            auto first = std::make_shared<scene::Primitive>(*now);
            first->motionKeys = p->motionKeys;
            now = std::move(first);
        }
        ShapeRef k = keys.empty() ? shapeOf(now, a, toCamera, instance)
                                  : buildShape(now, keys[0]->attributesRef(), toCamera, instance, diag_, facing_, keys[0].get());
        if (!k) return nullptr;
        keys.push_back(std::move(k));
    }
    if (keys.size() == 1) return keys[0];
    if (auto keyed = std::dynamic_pointer_cast<KeyedShape>(keys[0])) {
        if (!keyed->join({keys.begin() + 1, keys.end()}, std::move(times), diag_)) reportUnlike(*keyed, diag_);
        return keyed;
    }
    ShapeSource s = keys[0]->source();
    return std::make_shared<Deforming>(std::move(s), std::move(keys), std::move(times));
}

void FrameBuilder::add(const PrimitiveRef& p, const scene::AttributesRef& a, Transform place, int instance) {
    if (full(p->place)) return;
    if (place.moves() && !std::all_of(place.keys.begin(), place.keys.end(), affine)) {
        once(diag_, "movingprojective", Rie::Incapable, p->place,
             "a moving transformation of this " + p->kind + " contains a perspective: its motion is ignored");
        place = Transform(place.first());
    }
    const Matrix open = place.first();
    const bool deforms = scene::keysOverShutter(*p, shutter_).size() > 1;
    if (!place.moves() && !deforms) {
        if (ShapeRef s = shapeOf(scene::primitiveAt(p, shutter_.open), a, open, instance)) out_.push_back(std::move(s));
        return;
    }
    // The geometry's space is that at shutter open, so that static parts have the numbers of a still picture.
    Matrix home = open;
    if (!invertible(home))
        for (const Matrix& m : place.keys)
            if (invertible(m)) home = m;
    const ShapeRef geometry = geometryOf(p, coarser(a, *p, place), home, instance);
    if (!geometry) return;
    const Matrix back = inverse(home);
    for (Matrix& m : place.keys) m = m == home ? Matrix() : back * m;
    ShapeSource s = geometry->source();
    s.toCamera = open;
    out_.push_back(std::make_shared<Placed>(std::move(s), geometry, place));
}

/// GeometricApproximation "motionfactor": fast objects need fewer micropolygons. Multiplies ShadingRate by the factor times a
/// sixteenth of the motion in pixels, as in 3Delight.
scene::AttributesRef FrameBuilder::coarser(const scene::AttributesRef& a, const scene::Primitive& p,
                                           const Transform& place) const {
    const scene::Param* f = a ? a->value("GeometricApproximation:motionfactor") : nullptr;
    if (!f || f->numbers.empty() || !(f->numbers[0] > 0) || !place.moves()) return a;
    const DiceCamera camera = DiceCamera::from(frame_.options);
    const Vec3d centre = centreOf(p), from = transformPoint(place.first(), centre);
    double pixels = 0;
    for (const Matrix& m : place.keys) pixels = std::max(pixels, camera.pixels(from, transformPoint(m, centre) - from));
    const double rate = double(f->numbers[0]) / 16 * pixels;
    if (!(rate > 1)) return a;
    auto out = std::make_shared<scene::Attributes>(*a);
    out->shadingRate = float(std::min(double(a->shadingRate) * rate, 1e4));
    return out;
}

/// Whether the instances of a primitive share its geometry: if it is large enough, and no result that depends on the position
/// (the grid of a displaced shape, the area of an emitter) differs between instances.
bool FrameBuilder::shares(const scene::Primitive& p, const scene::Attributes* a, size_t instances) const {
    if (instances < 2 || !a || a->displacement || a->areaLight >= 0) return false;
    if (facing_ != Facing::Ray && scene::has(p.kind, scene::kTurnsToEye)) return false; // each turns to the eye
    size_t numbers = 0;
    for (const scene::Param& v : p.params)
        if (v.name == "P" || v.name == "Pw" || v.name == "Pz") numbers += v.numbers.size();
    return numbers > 0 && instances * numbers > options_.shareFrom;
}

/// The instance of a primitive that appears largest: dicing for it is fine enough for all.
const Matrix& FrameBuilder::nearest(const scene::Instance& inst, const scene::Primitive& p) {
    const auto [at, fresh] = nearest_.try_emplace({inst.object, &p});
    if (!fresh) return at->second;
    const Vec3d centre = centreOf(p);
    double largest = -1;
    for (const scene::Instance* i : usage_[size_t(inst.object)].by) {
        const Matrix m = scene::at(p.toWorld, shutter_.open) * scene::at(i->toWorld, shutter_.open) * camera_;
        if (!invertible(m) || !affine(m)) continue;
        const double size = exact::pow(std::fabs(determinant3(m)), 1. / 3) / std::max(length(transformPoint(m, centre)), 1e-30);
        if (size > largest) largest = size, at->second = m;
    }
    return at->second;
}

void FrameBuilder::addShared(const PrimitiveRef& p, const scene::AttributesRef& a, const Transform& place,
                             const scene::Instance& inst, int instance) {
    if (full(p->place)) return;
    const bool polygons = p->kind.find("Polygon") != std::string::npos;
    auto [at, fresh] = shared_.try_emplace({inst.object, p.get(), polygons ? nullptr : a.get()});
    Shared& shared = at->second;
    if (fresh) {
        const Matrix& home = nearest(inst, *p);
        shared.geometry = geometryOf(p, a, home, instance);
        shared.from = inverse(home);
        Diagnostics reported; // reported when the geometry was made
        const Shape* first = shared.geometry.get();
        if (const auto* deforming = dynamic_cast<const Deforming*>(first)) first = deforming->keys()[0].get();
        shared.normalsDecide = first && normalsSay(*first, reported) != NormalsSay::Nothing;
        shared.bounds = std::make_shared<SharedBounds>();
    }
    if (!shared.geometry) return;
    for (const Matrix& m : place.keys)
        if (!affine(m) || (&m == &place.keys[0] && !invertible(m))) return add(p, a, place, instance);
    ShapeSource s = shared.geometry->source();
    Transform from = place;
    for (Matrix& m : from.keys) m = shared.from * m;
    s.toCamera = place.first();
    s.instance = instance;
    s.attributes = a;
    const float handed = determinant3(from.first()) < 0 ? -1.f : 1.f;
    if (shared.normalsDecide && !scene::solidTakenAway(*a) &&
        orientationSign(*a, s.toCamera) != handed * shared.geometry->orientation())
        s.attributes = turned(a);
    out_.push_back(std::make_shared<Placed>(std::move(s), shared.geometry, from, shared.bounds));
}

std::vector<ShapeRef> FrameBuilder::run() {
    usage_.resize(frame_.objects.size());
    for (const scene::Instance& i : frame_.instances)
        if (i.object >= 0 && size_t(i.object) < usage_.size()) usage_[size_t(i.object)].by.push_back(&i);
    for (const PrimitiveRef& p : frame_.primitives)
        if (p && !scene::isProcedural(*p)) add(p, p->attributes, overShutter(p->toWorld), -1);
    for (size_t i = 0; i < frame_.instances.size(); ++i) {
        const scene::Instance& inst = frame_.instances[i];
        if (inst.object < 0 || size_t(inst.object) >= frame_.objects.size()) {
            diag_.report(Severity::Error, Rie::BadHandle, inst.place, "ObjectInstance of an object that does not exist");
            continue;
        }
        if (full(inst.place)) break;
        const Transform toCamera = overShutter(inst.toWorld);
        const scene::Primitive* last = nullptr; // of a row of primitives with the same attributes
        scene::AttributesRef attributes;
        for (const PrimitiveRef& p : frame_.objects[size_t(inst.object)].primitives) {
            if (!p) continue;
            if (!last || last->attributes != p->attributes || last->attributesBefore != p->attributesBefore)
                attributes = instanceAttributes(*p, inst);
            last = p.get();
            Transform place = scene::compose(scene::overShutter(p->toWorld, shutter_), toCamera);
            if (shares(*p, attributes.get(), usage_[size_t(inst.object)].by.size()))
                addShared(p, attributes, place, inst, int(i));
            else add(p, attributes, std::move(place), int(i));
        }
    }
    return std::move(out_);
}

} // namespace

std::vector<ShapeRef> buildShapes(const scene::Frame& f, Diagnostics& diag, const BuildOptions& options) {
    // Exporters write thousands of empty polygons: a warning that many primitives give is reported once, with their number.
    struct Repeated {
        Diagnostic first;
        size_t times = 0;
    };
    std::vector<Repeated> warnings;
    std::map<std::string, size_t> numbers; // by message, of `warnings`
    std::vector<ShapeRef> shapes;
    {
        Diagnostics here([&](const Diagnostic& d) {
            if (!d.once.empty()) return diag.reportOnce(d.once, d);
            if (d.severity != Severity::Warning) return diag.report(d);
            const auto [at, fresh] = numbers.try_emplace(d.message, warnings.size());
            if (fresh) warnings.push_back({d, 0});
            ++warnings[at->second].times;
        });
        shapes = FrameBuilder(f, here, options).run();
    }
    for (Repeated& w : warnings) {
        if (w.times > 1) w.first.message += " (this and " + std::to_string(w.times - 1) + " more)";
        diag.report(std::move(w.first));
    }
    return shapes;
}

} // namespace alpenglow::geometry
