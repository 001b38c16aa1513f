// Matrices: rsl.md 10.3 (seed 6.4.3). Row vectors, p' = p M, translation in the last row, as base/matrix.h.
#pragma once
//CODE
#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
std::vector<Shadeop> matrixShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, const char* doc, std::vector<Example> examples) -> Shadeop& {
        Shadeop op;
        op.section = "Matrices";
        op.source = "seed";
        op.name = name;
        op.signatures = std::move(signatures);
        op.doc = doc;
        op.examples = std::move(examples);
        list.push_back(std::move(op));
        return list.back();
    };
    const std::string order = " The new transformation applies first, as in RiTranslate: result = new * m (order (k), as RISpec).";
    add("translate", sigs({{"matrix translate(matrix m; point t)", "al_translate"}}), ("Concatenates a translation by t onto m." + order).c_str(),
        {{"translate(matrix(1), point(1,2,3))", "1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1"}});
    add("scale", sigs({{"matrix scale(matrix m; point s)", "al_scale"}}), ("Concatenates a scaling by s onto m." + order).c_str(),
        {{"scale(matrix(1), point(2,3,4))", "2 0 0 0 0 3 0 0 0 0 4 0 0 0 0 1"}});
    add("rotate", sigs({{"matrix rotate(matrix m; float angle; vector axis)", "al_rotatematrix"}}),
        ("Concatenates a rotation by angle (radians) about axis onto m; m itself for the zero axis." + order).c_str(),
        {{"rotate(matrix(1), 0, vector(0,0,1))", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"}});
    add("determinant", sigs({{"float determinant(matrix m)", "al_determinant"}}), "Determinant of the 4x4 matrix.", {{"determinant(matrix(2))", "16"}});
    add("inverse", sigs({{"matrix inverse(matrix m)", "al_inverse"}}), "Inverse; the identity for a singular matrix.",
        {{"inverse(matrix(2))", "0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 0 0 0 0.5"}});
    add("comp", sigs({{"float comp(matrix m; float row, float column)", "al_compm"}}),
        "Element of a matrix; indices are truncated and clamped to 0..3.", {{"comp(matrix(2), 1, 1)", "2"}});
    add("setcomp", sigs({{"void setcomp(output matrix m; float row, float column, float value)", "al_setcompm"}}),
        "Sets an element of a matrix; indices are truncated and clamped to 0..3.", {});
    Shadeop& mtransform = add("mtransform", sigs({{"matrix mtransform(string tospace; matrix m)"},
                                                  {"matrix mtransform(string fromspace, string tospace; matrix m)"}}),
                              "A matrix expressed in another space.", {});
    mtransform.lowering = Lowering::Unavailable;
    mtransform.source = "RISpec";
    return list;
}
} // namespace alpenglow::rsl
#endif
