#include "rsl/front/print.h"
#include <cstdio>

namespace alpenglow::rsl {

namespace {

std::string number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", v);
    return text;
}

std::string quoted(const std::string& s) {
    std::string q = "\"";
    for (char c : s) {
        if (c == '"' || c == '\\') q += '\\';
        if (c == '\n') q += "\\n";
        else q += c;
    }
    return q + "\"";
}

const char* word(ExprOp op) {
    static constexpr const char* kWords[] = {"",         "add",  "sub",       "mul",     "div",          "dot",
                                             "cross",    "less", "lessequal", "greater", "greaterequal", "equal",
                                             "notequal", "and",  "or",        "negate",  "not",          "assign"};
    return kWords[int(op)];
}

std::string list(const Expr& e, const std::string& head) {
    std::string s = "(" + head;
    if (e.space) s += " " + print(*e.space);
    for (const auto& a : e.args) s += " " + print(*a);
    if (e.kind == ExprKind::ArrayList && e.text == "...") s += " ...";
    if (e.channel) s += " [" + print(*e.channel) + "]";
    for (const auto& p : e.pairs) s += " " + quoted(p.name) + (p.output ? "=>" : "=") + print(*p.value);
    return s + ")";
}

std::string declaration(const Symbol& s) {
    std::string t;
    if (s.output) t += "output ";
    if (s.storage != Storage::Unspecified) t += s.storage == Storage::Uniform ? "uniform " : "varying ";
    return t + toString(s.type) + " " + s.name;
}

} // namespace

std::string print(const Expr& e) {
    const std::string type = ":" + toString(e.type);
    switch (e.kind) {
    case ExprKind::Number:
        return number(e.number);
    case ExprKind::String:
        return quoted(e.text);
    case ExprKind::Variable:
        return e.symbol ? e.symbol->name : "?" + e.text;
    case ExprKind::Index:
        return list(e, "index");
    case ExprKind::Unary:
    case ExprKind::Binary:
        return list(e, word(e.op) + type);
    case ExprKind::Assign: {
        static constexpr const char* kForms[] = {"", "+=", "-=", "*=", "/="};
        return list(e, e.op == ExprOp::Assign ? "=" : kForms[int(e.op)]);
    }
    case ExprKind::Conditional:
        return list(e, "?" + type);
    case ExprKind::Tuple:
    case ExprKind::MatrixTuple:
        return list(e, toString(e.type));
    case ExprKind::ArrayList:
        return list(e, "list" + type);
    case ExprKind::Cast:
        return list(e, "cast" + type);
    case ExprKind::ShadeopCall:
        return list(e, e.text + type);
    case ExprKind::Sequence:
        return list(e, "then" + type);
    case ExprKind::Member:
        return list(e, "->" + e.text + type);
    case ExprKind::Part:
        return list(e, "part " + e.text + type);
    case ExprKind::Construct:
        return list(e, "make" + type);
    case ExprKind::Method:
        return list(e, "->" + e.text + "()" + type);
    case ExprKind::FunctionCall:
        return list(e, (e.shadeop ? "rsl " : "call ") + e.text + type);
    }
    return "?";
}

std::string print(const Stmt& s) {
    std::string t;
    const auto part = [&](const ExprPtr& e) { t += e ? " " + print(*e) : " -"; };
    const auto bodies = [&] {
        for (const auto& b : s.body) t += " " + print(*b);
        if (s.elseBody) t += " else " + print(*s.elseBody);
        t += ")";
    };
    switch (s.kind) {
    case StmtKind::Block:
        t = "(block";
        break;
    case StmtKind::Declare:
        t = "(declare";
        for (const auto& d : s.declarators) t += " (" + declaration(*d.symbol) + (d.init ? " = " + print(*d.init) : "") + ")";
        return t + ")";
    case StmtKind::Expression:
        return print(*s.value);
    case StmtKind::If:
        t = "(if";
        part(s.condition);
        break;
    case StmtKind::While:
        t = "(while";
        part(s.condition);
        break;
    case StmtKind::For:
        t = "(for";
        part(s.init);
        part(s.condition);
        part(s.step);
        break;
    case StmtKind::Break:
        return "(break " + std::to_string(s.levels) + ")";
    case StmtKind::Continue:
        return "(continue " + std::to_string(s.levels) + ")";
    case StmtKind::Return:
        return s.value ? "(return " + print(*s.value) + ")" : "(return)";
    case StmtKind::Illuminance:
    case StmtKind::Illuminate:
    case StmtKind::Solar:
    case StmtKind::Gather:
        t = s.kind == StmtKind::Illuminance  ? "(illuminance"
            : s.kind == StmtKind::Illuminate ? "(illuminate"
            : s.kind == StmtKind::Solar      ? "(solar"
                                             : "(gather";
        if (s.category) t += " [" + print(*s.category) + "]";
        for (const auto& e : s.exprs) part(e);
        for (const auto& p : s.pairs) t += " " + quoted(p.name) + (p.output ? "=>" : "=") + print(*p.value);
        break;
    }
    bodies();
    return t;
}

std::string print(const Function& f) {
    std::string t = toString(f.result) + " " + f.name + "(";
    for (const Symbol* p : f.parameters) t += (p == f.parameters[0] ? "" : "; ") + declaration(*p);
    return t + ") " + print(*f.body);
}

std::string print(const Shader& s) {
    std::string t = std::string(toString(s.kind)) + " " + s.name + "(";
    for (size_t i = 0; i < s.parameters.size(); ++i) {
        t += (i ? "; " : "") + declaration(*s.parameters[i].symbol);
        if (s.parameters[i].defaultValue) t += " = " + print(*s.parameters[i].defaultValue);
    }
    return t + ") " + print(*s.body);
}

} // namespace alpenglow::rsl
