// Blocks, motion, conditions, version, declarations, error handling (RISpec 3.2, section 4 and 7.2).
#include "ri/interpreter.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

template <BlockKind K> void beginBlock(Interpreter& in, const Call& c) { in.begin(K, c); }
template <BlockKind K> void endBlock(Interpreter& in, const Call& c) { in.end(K, c); }
void nothing(Interpreter&, const Call&) {}

void version(Interpreter& in, const Call& c) {
    constexpr double kSupported = 3.2; // files are of the byte stream's version (3.03, 3.04) or of the specification's
    if (c.number(0) > kSupported + 1e-6)
        in.reporter.warning(Rie::Version, c.place, fmt::format("version {} is newer than {}", c.number(0), kSupported));
}

void declare(Interpreter& in, const Call& c) {
    const std::string& name = c.text(0);
    auto d = parseDeclaration(c.text(1));
    if (!d || name.empty() || name.find(' ') != name.npos)
        in.reporter.error(Rie::Syntax, c.place, fmt::format("Declare \"{}\": \"{}\" is not a declaration", name, c.text(1)),
                          declarationHint(c.text(1), false, "[class] type [[n]], for example \"varying color\""));
    else in.declarations.declare(name, *d);
    if (const OtherType* o = otherTypeIn(c.text(1))) in.sayOtherType(*o, c.place);
}

void frameBegin(Interpreter& in, const Call& c) {
    if (!in.begin(BlockKind::Frame, c)) return;
    in.options.frameNumber = c.integer(0);
    in.options.inFrame = true;
    if (in.settings.frameSeen) in.settings.frameSeen(in.options.frameNumber);
}

void solidBegin(Interpreter& in, const Call& c) {
    static constexpr std::string_view kOperations[] = {"primitive", "union", "intersection",
                                                       "difference"}; // as scene::SolidOperation
    const auto op = std::find(std::begin(kOperations), std::end(kOperations), c.text(0));
    if (op == std::end(kOperations))
        in.reporter.error(Rie::BadSolid, c.place,
                          fmt::format("SolidBegin: \"{}\" is not a solid operation; a union is made", c.text(0)),
                          "primitive, union, intersection or difference");
    in.beginSolid(
        op == std::end(kOperations) ? scene::SolidOperation::Union : scene::SolidOperation(op - std::begin(kOperations)), c);
}

void edit(Interpreter& in, const Call& c) {
    if (in.begin(BlockKind::Edit, c)) in.incapable(c, "edits are read as ordinary requests");
}

void errorHandler(Interpreter& in, const Call& c) {
    const std::string& h = c.text(0);
    if (h != "ignore" && h != "print" && h != "printonce" && h != "abort")
        in.reporter.error(Rie::BadToken, c.place, fmt::format("ErrorHandler: \"{}\" is not known", h), "ignore, print or abort");
    in.setErrorStyle(h == "abort" ? ErrorStyle::Abort : h == "ignore" ? ErrorStyle::Ignore : ErrorStyle::Print);
}

} // namespace

std::vector<Request> structureRequests() {
    using B = BlockKind;
    const unsigned bf = kBase | kFrame, all = kAnywhere;
    return {
        {"version", "number version", Kind::Other, all, false, "RIB version of the file; newer than 3.04 is warned about.",
         "3.03", version},
        {"Declare", "string name; string declaration", Kind::Other, all, false,
         "Declares the class and type of a parameter name.", "\"myparam\" \"varying color\"", declare},
        {"ErrorHandler", "string style", Kind::Other, all, false,
         "What an error does, here and while the picture is drawn. \"print\": it is printed, and the rest goes on. \"ignore\": "
         "errors and warnings are printed with -v only and leave the exit status alone; their number is printed. \"abort\": the "
         "first error is printed and ends the run: no picture is finished, and the exit status is not 0. \"printonce\" is "
         "\"print\": what recurs is printed once anyway.",
         "\"print\"", errorHandler},
        {"FrameBegin", "int number", Kind::Structure, kBase, false, "Saves options and attributes and sets the frame number.",
         "1", frameBegin},
        {"FrameEnd", "", Kind::Structure, all, false, "Restores what FrameBegin saved.", "", endBlock<B::Frame>},
        {"WorldBegin", "", Kind::Structure, bf, false,
         "Freezes the options, makes the current transformation the camera, saves the attributes, starts the scene.", "",
         [](Interpreter& in, const Call& c) { in.worldBegin(c); }},
        {"WorldEnd", "", Kind::Structure, all, false, "Renders the scene and restores what WorldBegin saved.", "",
         endBlock<B::World>},
        {"AttributeBegin", "", Kind::Structure, kFrame | kWorld | kObject, false,
         "Saves all attributes, the transformation and the light list.", "", beginBlock<B::Attribute>},
        {"AttributeEnd", "", Kind::Structure, all, false, "Restores what AttributeBegin saved.", "", endBlock<B::Attribute>},
        {"TransformBegin", "", Kind::Structure, all, false, "Saves the current transformation.", "", beginBlock<B::Transform>},
        {"TransformEnd", "", Kind::Structure, all, false, "Restores what TransformBegin saved.", "", endBlock<B::Transform>},
        {"SolidBegin", "string operation", Kind::Structure, kWorld | kObject, false,
         "Starts a solid: primitive (a closed part), union, intersection or difference (the first less the others) of the solids "
         "in it.",
         "\"union\"", solidBegin},
        {"SolidEnd", "", Kind::Structure, all, false, "Ends a solid.", "", endBlock<B::Solid>},
        {"ObjectBegin", "handle object", Kind::Structure, all, false, "Stores the primitives up to ObjectEnd under a handle.",
         "1", [](Interpreter& in, const Call& c) { in.objectBegin(c); }},
        {"ObjectEnd", "", Kind::Structure, all, false, "Ends the object.", "", endBlock<B::Object>},
        {"MotionBegin", "number[] times", Kind::Structure, all, false,
         "The next calls of one request are samples of it at these times. Transforms, primitives, "
         "lights and the camera move.",
         "[0 1]", [](Interpreter& in, const Call& c) { in.beginMotion(c); }},
        {"MotionEnd", "", Kind::Structure, all, false, "Ends the motion block.", "",
         [](Interpreter& in, const Call& c) { in.endMotion(c); }},
        {"ResourceBegin", "", Kind::Structure, all, false, "Starts a scope of Resource handles.", "", beginBlock<B::Resource>},
        {"ResourceEnd", "", Kind::Structure, all, false, "Ends the scope of Resource handles.", "", endBlock<B::Resource>},
        {"Resource", "string handle; string type; ..", Kind::Attribute, all, false,
         "Type \"attributes\": saves or restores (\"string operation\") a subset of the attributes.",
         "\"a\" \"attributes\" \"string operation\" \"save\"", [](Interpreter& in, const Call& c) { in.resource(c); }},
        {"EditWorldBegin", "string name; ..", Kind::Structure, bf, false,
         "Re-rendering of the world of an archive (PRMan): it is read and drawn; edits of it, up to EditWorldEnd, are left out.",
         "\"part.rib\" \"string rerenderer\" \"raytrace\"", [](Interpreter& in, const Call& c) { in.editWorld(c); }},
        {"EditWorldEnd", "", Kind::Structure, all, false, "End of the edits of a world.", "",
         [](Interpreter& in, const Call& c) { in.endEditWorld(c); }},
        {"EditBegin", "string type?; ..", Kind::Structure, bf, false,
         "Start of a re-rendering edit; outside of EditWorldBegin its requests are read as usual.",
         "\"attribute\" \"string scopename\" \"ball\"", edit},
        {"EditEnd", "", Kind::Structure, all, false, "End of an edit.", "", endBlock<B::Edit>},
        {"EditAttributeBegin", "string name", Kind::Structure, all, false,
         "Start of the edits of the attributes of that name; outside of EditWorldBegin they are read as usual.", "\"ball\"",
         edit},
        {"EditAttributeEnd", "", Kind::Structure, all, false, "End of the edits of attributes.", "", endBlock<B::Edit>},
        {"IfBegin", "string expression; ..", Kind::Structure, all, false, "What follows is done when the expression is true.",
         "\"1 == 1\"", nothing},
        {"ElseIf", "string expression; ..", Kind::Structure, all, false, "Otherwise, when this one is.", "\"0\"", nothing},
        {"Else", "", Kind::Structure, all, false, "Otherwise.", "", nothing},
        {"IfEnd", "", Kind::Structure, all, false, "Ends the conditional block.", "", nothing},
    };
}

} // namespace alpenglow::ri
