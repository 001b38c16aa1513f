// Geometry: rsl.md 10.3 (seed 6.4.3). Code for all lane widths above, descriptors below (host only).
#pragma once
//CODE
#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
std::vector<Shadeop> geometryShadeops() {
    std::vector<Shadeop> list;
    Shadeop base;
    base.section = "Geometry";
    base.source = "seed";
    const auto add = [&](const char* name, std::vector<Signature> signatures, const char* doc, std::vector<Example> examples) -> Shadeop& {
        Shadeop op = base;
        op.name = name;
        op.signatures = std::move(signatures);
        op.doc = doc;
        op.examples = std::move(examples);
        list.push_back(std::move(op));
        return list.back();
    };
    for (int i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        add((axis + "comp").c_str(), each(kTuples, "float " + axis + "comp($ p)", "al_" + axis + "comp"),
            ("The " + axis + " component of a tuple.").c_str(), {{axis + "comp(point(1,2,3))", std::to_string(i + 1)}});
        add(("set" + axis + "comp").c_str(), each(kTuples, "void set" + axis + "comp(output $ p; float value)", "al_set" + axis + "comp"),
            ("Sets the " + axis + " component of a tuple.").c_str(), {});
    }
    add("distance", sigs({{"float distance(point a, point b)", "al_distance"}}), "Length of b - a.",
        {{"distance(point(1,2,3), point(1,5,7))", "5"}});
    add("length", sigs({{"float length(vector v)", "al_length"}}), "Euclidean length. Its derivative at the zero vector is taken as 0.",
        {{"length(vector(0,3,4))", "5"}});
    add("normalize", each("vector point normal", "$ normalize($ v)", "al_normalize"), "v / length(v); the zero vector for the zero vector.",
        {{"normalize(vector(0,3,4))", "0 0.6 0.8"}, {"normalize(vector(0,0,0))", "0 0 0"}});
    add("ptlined", sigs({{"float ptlined(point a, point b, point q)", "al_ptlined"}}), "Distance from q to the segment from a to b.",
        {{"ptlined(point(0,0,0), point(1,0,0), point(4,4,0))", "5"}, {"ptlined(point(0,0,0), point(4,0,0), point(1,2,0))", "2"}});
    add("rotate", sigs({{"point rotate(point q; float angle; point a, point b)", "al_rotatepoint"}}),
        "Rotates q by angle (radians) about the line from a to b, counterclockwise seen with b - a toward the eye in a right-handed space. "
        "q itself when a = b.",
        {{"rotate(point(1,0,0), 0, point(0,0,0), point(0,0,1))", "1 0 0"}});
    add("faceforward", {},
        "n or -n, so that it faces against i: n if i . nref <= 0, else -n. nref defaults to the geometric normal Ng.",
        {{"faceforward(vector(0,0,1), vector(0,0,1), vector(0,0,1))", "0 0 -1"}});
    list.back().lowering = Lowering::Rsl;
    list.back().derivative = DerivativeRule::Inherent;
    list.back().signatures = each("vector normal", "$ faceforward($ n; vector i; vector nref)") + each("vector normal", "$ faceforward($ n; vector i)");
    list.back().rsl = R"(
vector faceforward(vector n; vector i; vector nref) { return (i . nref) > 0 ? -n : n; }
normal faceforward(normal n; vector i; vector nref) { return (i . nref) > 0 ? -n : n; }
vector faceforward(vector n; vector i) { extern normal Ng; return (i . Ng) > 0 ? -n : n; }
normal faceforward(normal n; vector i) { extern normal Ng; return (i . Ng) > 0 ? -n : n; }
)";
    add("reflect", sigs({{"vector reflect(vector i, vector n)", "al_reflect"}}), "i - 2 (i . n) n: i mirrored at the plane of the unit vector n.",
        {{"reflect(vector(1,-1,0), vector(0,1,0))", "1 1 0"}});
    add("refract", sigs({{"vector refract(vector i, vector n; float eta)", "al_refract"}}),
        "Direction of the refracted ray; i and n unit, n against i, eta = index of the side of i / index of the side entered. The zero vector on "
        "total reflection.",
        {{"refract(vector(0,0,1), vector(0,0,-1), 0.5)", "0 0 1"}, {"refract(vector(0.6,0,0.8), vector(0,0,-1), 2)", "0 0 0"}});
    Shadeop& depth = add("depth", sigs({{"float depth(point p)"}}),
                         "Camera depth of p, 0 at the near and 1 at the far clipping plane; p in current space.", {});
    depth.lowering = Lowering::Service;
    depth.derivative = DerivativeRule::ZeroWarn;

    Shadeop& transform = add("transform", {}, "", {});
    transform.lowering = Lowering::Special;
    transform.derivative = DerivativeRule::Inherent;
    for (const char* type : {"point", "vector", "normal"}) {
        const std::string parts[] = {std::string(type) + " transform(string tospace; " + type + " p)",
                                     std::string(type) + " transform(string fromspace, string tospace; " + type + " p)",
                                     std::string(type) + " transform(matrix m; " + type + " p)",
                                     std::string(type) + " transform(string fromspace; matrix m; " + type + " p)"};
        for (const std::string& text : parts)
            transform.signatures.push_back(parseSignature(text));
    }
    transform.doc = "From one named space (default current) to another, or by a matrix. Points with translation and homogeneous divide, vectors by "
                    "the upper 3x3, normals by its inverse transpose. Symbols al_transformpoint, al_transformvector, al_transformnormal (matrix, "
                    "tuple). Row vectors: p' = p M.";
    Shadeop& vtransform = add("vtransform", {}, "transform() by the rule of vectors, whatever the type of the argument.", {});
    vtransform.lowering = Lowering::Special;
    vtransform.derivative = DerivativeRule::Inherent;
    vtransform.signatures = sigs({{"vector vtransform(string tospace; vector v)"},
                                  {"vector vtransform(string fromspace, string tospace; vector v)"},
                                  {"vector vtransform(matrix m; vector v)"},
                                  {"vector vtransform(string fromspace; matrix m; vector v)"}});
    Shadeop& ntransform = add("ntransform", {}, "transform() by the rule of normals, whatever the type of the argument.", {});
    ntransform.lowering = Lowering::Special;
    ntransform.derivative = DerivativeRule::Inherent;
    ntransform.signatures = sigs({{"normal ntransform(string tospace; normal n)"},
                                  {"normal ntransform(string fromspace, string tospace; normal n)"},
                                  {"normal ntransform(matrix m; normal n)"},
                                  {"normal ntransform(string fromspace; matrix m; normal n)"}});
    return list;
}
} // namespace alpenglow::rsl
#endif
