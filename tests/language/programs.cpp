#include "programs.h"
#include <algorithm>
#include <map>

namespace alpenglow::rsl {

size_t Term::size() const {
    size_t n = 1;
    for (const Term& p : parts) n += p.size();
    return n;
}

std::string Term::write(int number) const {
    std::string s;
    size_t next = 0;
    if (list) {
        for (const Term& p : parts) s += p.write(number) + "\n";
        return s;
    }
    for (char c : text) {
        if (c == '$') s += parts[next++].write(number);
        else if (c == '@') s += std::to_string(number);
        else s += c;
    }
    return s;
}

namespace {

/// What every body and every function has of structures (shaderOf).
const char* const kStructures = "Pack one, three[2]; Deep two; Pack four[]; ";

/// The names that a piece of a program can read and write, by sort.
struct Scope {
    std::map<char, std::vector<std::string>> read, write;
    char result = 0; ///< of the function around, 0 in the body, 'v' for void
    int loops = 0;   ///< around this place
    int turns = 1;   ///< that they make at most
};

class Writer {
public:
    Writer(const rc::Random& r, bool large) : random_(r), large_(large) {}

    Term program() {
        Term functions{'g', "", {}, true}, body{'l', "", {}, true};
        for (int n = pick(large_ ? 4 : 3); n > 0; n--) functions.parts.push_back(function());
        Scope s;
        for (const auto& [sort, names] : kBody) { s.read[sort] = s.write[sort] = names; }
        for (const char* n : {"u", "v", "k", "ua"}) s.read['F'].push_back(n);
        s.read['C'].push_back("kc");
        s.read['P'].push_back("kp");
        s.read['M'].push_back("km");
        s.read['S'].push_back("ks");
        s.read['C'].push_back("Cs");
        s.read['P'].push_back("P");
        s.read['V'].push_back("I");
        s.read['N'].push_back("N");
        s.read['U'] = {"k"};
        body.parts.push_back({'d', "uniform float ua = $;", {value('U', s, 2)}});
        s.read['U'].push_back("ua");
        if (pick(large_ ? 2 : 3) == 0) body.parts.push_back(nested());
        for (int n = large_ ? 3 + pick(6) : 2 + pick(2); n > 0; n--) body.parts.push_back(statement(s, 0));
        return {'d', "", {functions, body}};
    }

private:
    struct Callable {
        std::string name;
        char result;
        std::vector<std::pair<char, bool>> parameters; ///< sort ('a': float[4]), output
    };
    inline static const std::map<char, std::vector<std::string>> kBody = {
        {'F', {"x", "y", "z"}}, {'C', {"c", "d"}}, {'P', {"p", "w"}}, {'V', {"r"}}, {'N', {"n"}}, {'M', {"m"}}, {'S', {"st"}}};
    rc::Random random_;
    bool large_;
    std::vector<Callable> callables_;
    int names_ = 0;

    int pick(int n) { return static_cast<int>(random_.next() % static_cast<uint64_t>(n)); }
    template <class T> const T& any(const std::vector<T>& v) { return v[size_t(pick(int(v.size())))]; }

    /// The holes of a pattern "min($F, $B)" filled.
    Term fill(char sort, const std::string& pattern, Scope& s, int depth) {
        Term t{sort, "", {}};
        for (size_t i = 0; i < pattern.size(); i++) {
            t.text += pattern[i];
            if (pattern[i] == '$') t.parts.push_back(value(pattern[++i], s, depth + 1));
        }
        return t;
    }

    Term leaf(char sort, Scope& s) {
        const auto& names = s.read[sort];
        if (!names.empty() && pick(3)) return {sort, any(names), {}};
        return {sort, any(constants().at(sort)), {}};
    }

    Term value(char sort, Scope& s, int depth) {
        if (depth > 4 || pick(8) < depth) return leaf(sort, s);
        if (pick(12) == 0)
            for (const Callable& c : callables_)
                if (c.result == sort && pick(2)) return call(c, sort, s, depth);
        const auto& choices = grammar().at(sort);
        int total = 0;
        for (const Choice& c : choices) total += c.weight;
        int at = pick(total);
        for (const Choice& c : choices)
            if ((at -= c.weight) < 0) return fill(sort, c.text, s, depth);
        return leaf(sort, s);
    }

    Term call(const Callable& c, char sort, Scope& s, int depth) {
        Term t{sort, c.name + "(", {}};
        for (size_t i = 0; i < c.parameters.size(); i++) {
            const auto& [wanted, output] = c.parameters[i];
            t.text += i ? ", $" : "$";
            if (wanted == 'a') t.parts.push_back({'d', "a", {}});
            else if (output) t.parts.push_back({'d', wanted == 'F' && pick(4) == 0 ? "a[2]" : any(s.write[wanted]), {}});
            else t.parts.push_back(value(wanted, s, depth + 1));
        }
        t.text += ")";
        return t;
    }

    static const char* typeName(char sort) {
        switch (sort) {
        case 'C':
            return "color";
        case 'P':
            return "point";
        case 'V':
            return "vector";
        case 'N':
            return "normal";
        case 'M':
            return "matrix";
        case 'S':
            return "string";
        case 'v':
            return "void";
        default:
            return "float";
        }
    }

    /// Functions have all that a body has under the same names, some of it as parameters: pieces of text fit into both.
    Term function() {
        Callable c{"f" + std::to_string(names_++) + "_@",
                   std::vector<char>{'F', 'F', 'C', 'P', 'V', 'N', 'M', 'S', 'v'}[size_t(pick(9))],
                   {}};
        std::map<char, std::vector<std::string>> left = kBody;
        std::string parameters, locals = "float i0, i1, i2; ";
        const auto parameter = [&](char sort, const std::string& name, const std::string& suffix, bool output) {
            parameters +=
                (parameters.empty() ? "" : "; ") + std::string(output ? "output " : "") + typeName(sort) + " " + name + suffix;
            c.parameters.push_back({suffix.empty() ? sort : 'a', output});
        };
        for (int n = 1 + pick(4); n > 0; n--) {
            const char sort = std::vector<char>{'F', 'F', 'F', 'C', 'P', 'V', 'N', 'M', 'S'}[size_t(pick(9))];
            auto& names = left[sort];
            if (names.empty()) continue;
            parameter(sort, names.back(), "", pick(3) == 0 || (c.result == 'v' && n == 1));
            names.pop_back();
        }
        const bool array = pick(4) == 0;
        if (array) parameter('F', "a", "[4]", pick(2));
        else locals += "float a[4] = {0.5, 1}; ";
        locals += "color b[3] = 0.25; float h[] = {1, 2}; ";
        locals += kStructures;
        static const std::map<char, const char*> kStart = {{'F', "0.75"}, {'C', "0.5"}, {'P', "1"},    {'V', "2"},
                                                           {'N', "0.5"},  {'M', "2"},   {'S', "\"a\""}};
        for (const auto& [sort, names] : left)
            for (const std::string& n : names) locals += std::string(typeName(sort)) + " " + n + " = " + kStart.at(sort) + "; ";
        Scope s;
        s.read = s.write = kBody;
        s.result = c.result;
        s.turns = 4; // it may be called in loops
        Term body{'l', "", {}, true};
        for (int n = 1 + pick(3); n > 0; n--) body.parts.push_back(statement(s, 1));
        Term t{
            'd', std::string(typeName(c.result)) + " " + c.name + "(" + parameters + ") {\n" + locals + "/*member*/\n$", {body}};
        if (c.result != 'v') {
            t.text += "return $;\n";
            t.parts.push_back(value(c.result, s, 1));
        }
        t.text += "}";
        callables_.push_back(c);
        return t;
    }

    /// A function inside the shader, which changes what stands around it.
    Term nested() {
        Scope s;
        s.read = {{'F', {"q", "y", "t", "u"}}, {'C', {"c", "e"}}, {'P', {"P"}}, {'S', {"st"}}};
        s.write = {{'F', {"q", "y", "t"}}, {'C', {"c", "e"}}};
        Term t{'d',
               "float g_@(float q; output color e) {\nextern float y; extern color c; extern string st; float t = $;\n"
               "y += t * 0.5; if ($) { c[1] = q; return $; }\ne = $;\nst = $;\nreturn $;\n}",
               {}};
        // Only what it has declared: the grammar's patterns know the names of bodies.
        const auto both = [&](char sort, const char* pattern) { return Term{sort, pattern, {leaf('F', s), leaf('F', s)}}; };
        t.parts = {both('F', "($ * $)"), both('B', "$ < $"), both('F', "max($, $)"),
                   leaf('C', s),         leaf('S', s),       both('F', "($ - $)")};
        callables_.push_back({"g_@", 'F', {{'F', false}, {'C', true}}});
        return t;
    }

    Term block(Scope& s, int depth) {
        Term list{'l', "", {}, true};
        for (int n = 1 + pick(3); n > 0; n--) list.parts.push_back(statement(s, depth + 1));
        return {'s', "{ $}", {list}};
    }

    Term loop(Scope& s, int depth) {
        const std::string i = "i" + std::to_string(s.loops);
        const int most = s.turns > 8 ? 2 : 1 + pick(s.turns > 1 ? 3 : 6);
        Scope inner = s;
        inner.loops++;
        inner.turns *= most + 1;
        inner.read['F'].push_back(i);
        if (pick(3) == 0) { // counted before the body: continue does not skip it
            Term t{'s', i + " = $; while (" + i + " > 0 && " + i + " < " + std::to_string(most) + ") { " + i + " += 1; $}", {}};
            t.parts = {value('F', s, 2), block(inner, depth)};
            return {'s', "{ $ }", {t}};
        }
        if (s.result == 0 && pick(4) == 0) { // a counter that is the same for all points
            const std::string j = "j" + std::to_string(s.loops);
            inner.read['F'].back() = j;
            return {
                's', "for (" + j + " = 0; " + j + " < " + std::to_string(most) + "; " + j + " += 1) $", {block(inner, depth)}};
        }
        const char bound = pick(2) ? 'U' : 'F';
        Term t{'s', "for (" + i + " = 0; " + i + " < " + std::to_string(most) + " && " + i + " < $; " + i + " += 1) $", {}};
        if (pick(2)) t = {'s', "for (" + i + " = 0; " + i + " < " + std::to_string(most) + "; " + i + " += 1) $", {}};
        else t.parts.push_back(value(s.read['U'].empty() ? 'F' : bound, s, 2));
        t.parts.push_back(block(inner, depth));
        return t;
    }

    /// A loop over the lights of the test, of which there are two.
    Term lights(Scope& s, int depth) {
        Scope inner = s;
        inner.loops++;
        inner.turns *= 2;
        for (const char* n : {"Cl", "Ol"}) inner.read['C'].push_back(n);
        inner.read['V'].push_back("L");
        if (pick(3) == 0) return {'s', "illuminance(P) $", {block(inner, depth)}};
        Term t{'s', "illuminance(P, $, $) $", {value(pick(2) ? 'N' : 'V', s, 3)}};
        t.parts.push_back(value('F', s, 3));
        t.parts.push_back(block(inner, depth));
        return t;
    }

    Term statement(Scope& s, int depth) {
        static const std::vector<char> kSorts = {'F', 'F', 'F', 'F', 'C', 'C', 'P', 'P', 'V', 'N', 'M', 'S'};
        const int kind = pick(depth > 2 ? 14 : 21);
        if (kind < 6) {
            const char sort = any(kSorts);
            std::string op = "=";
            if (sort == 'F' || sort == 'C') op = any(std::vector<std::string>{"=", "+=", "*=", "-=", "/="});
            if (sort == 'M') op = any(std::vector<std::string>{"=", "*="});
            if (sort == 'P' || sort == 'V' || sort == 'N') op = any(std::vector<std::string>{"=", "+=", "*="});
            return {'s', any(s.write[sort]) + " " + op + " $;", {value(op == "*=" && sort != 'M' ? 'F' : sort, s, 0)}};
        }
        switch (kind) {
        case 6:
            return fill('s',
                        any(std::vector<std::string>{"a[$I] = $F;", "a[2] += $F;", "b[$I] = $C;", "b[1] *= $C;", "a[$I] -= $F;",
                                                     "h[$I] = $F;", "a = {$F, 2, $F, 0};"}),
                        s, 1);
        case 7:
            return fill(
                's',
                any(std::vector<std::string>{"c[$I] = $F;", "p[1] = $F;", "setcomp(c, $F, $F);", "setxcomp(p, $F);",
                                             "setzcomp(r, $F);", "setcomp(m, $F, 2, $F);", "n[0] += $F;", "d[$I] *= $F;"}),
                s, 1);
        case 8:
            return fill(
                's',
                any(std::vector<std::string>{"if (arraylength(h) < 6) push(h, $F);", "if (arraylength(h) > 1) x = pop(h);",
                                             "if (arraylength(h) > 2 && ($B)) z += pop(h);", "z = capacity(h) > 3 ? $F : 1;"}),
                s, 1);
        case 9:
            return fill('s',
                        any(std::vector<std::string>{
                            "{ float x = $F; y += x * $F; x += 1; z -= x; }", "{ color c = $C; d = c * $F; }",
                            "{ float g[3] = {$F, $F, $F}; x = g[$I] + g[0]; }", "{ string g[2] = {$T, $T}; st = g[$I]; }",
                            "one->f = $F;", "one->c *= $C;", "three[$I]->f += $F;", "one = three[$I];", "three[$I] = one;",
                            "one = two;", "two->twist(x, $F);", "two->g[$I] = $F;", "two->twist(y, z);",
                            "{ Deep other = two; other->f = $F; x = other->add(y); }", "spread(two, $F);",
                            "if (arraylength(four) < 4) push(four, one);", "if (arraylength(four) > 0) one = pop(four);"}),
                        s, 1);
        case 10:
        case 11:
            for (const Callable& c : callables_)
                if (c.result == 'v') {
                    Term t = call(c, 's', s, 1);
                    t.text += ";";
                    return t;
                }
            break;
        case 12:
            if (s.result == 'v') return {'s', "if ($) return;", {value('B', s, 1)}};
            if (s.result) return {'s', "if ($) return $;", {value('B', s, 1), value(s.result, s, 1)}};
            break;
        case 13:
            break;
        case 14:
        case 15:
        case 16: {
            Term t{'s', "if ($) $", {value('B', s, 0), block(s, depth)}};
            if (pick(2)) {
                t.text += " else $";
                t.parts.push_back(block(s, depth));
            }
            return t;
        }
        case 17:
            if (s.loops < 3 && s.turns <= 12 && s.result == 0) return lights(s, depth);
            break;
        default:
            if (s.loops < 3 && s.turns <= 24) return loop(s, depth);
        }
        if (!s.loops) return {'s', any(s.write['F']) + " = $;", {value('F', s, 0)}};
        std::string jump = pick(2) ? "break" : "continue";
        if (s.loops > 1 && pick(2)) jump += " " + std::to_string(1 + pick(s.loops));
        return {'s', "if ($) " + jump + ";", {value('B', s, 1)}};
    }
};

Term least(char sort) {
    switch (sort) {
    case 'F':
    case 'U':
        return {sort, "1", {}};
    case 's':
        return {sort, ";", {}};
    default: {
        const auto it = constants().find(sort);
        return it == constants().end() ? Term{} : Term{sort, it->second.back(), {}};
    }
    }
}

void within(const Term& t, char sort, std::vector<Term>& found) {
    for (const Term& p : t.parts) {
        if (p.sort == sort) found.push_back(p);
        else within(p, sort, found);
    }
}

} // namespace

std::vector<Term> smaller(const Term& t) {
    std::vector<Term> out;
    if (t.list) {
        for (size_t n = t.parts.size(); n >= 1; n /= 2)
            for (size_t from = 0; from + n <= t.parts.size(); from += n) {
                Term s = t;
                s.parts.erase(s.parts.begin() + long(from), s.parts.begin() + long(from + n));
                out.push_back(std::move(s));
            }
    } else if (t.sort != 'd') {
        if (Term l = least(t.sort); !l.text.empty() && l.text != t.text) out.push_back(std::move(l));
        within(t, t.sort, out);
    }
    for (size_t p = 0; p < t.parts.size(); p++)
        for (Term& part : smaller(t.parts[p])) {
            Term s = t;
            s.parts[p] = std::move(part);
            out.push_back(std::move(s));
        }
    return out;
}

rc::Gen<Term> programs() {
    return rc::Gen<Term>([](const rc::Random& r, int size) {
        return rc::shrinkable::shrinkRecur(Writer(r, size >= 100).program(),
                                           [](const Term& t) { return rc::seq::fromContainer(smaller(t)); });
    });
}

std::vector<std::pair<std::string, std::string>> outputs(int number) {
    const std::string tail = "_" + std::to_string(number);
    std::vector<std::pair<std::string, std::string>> list;
    const char* types[] = {"color", "color", "color", "point", "point", "vector", "normal", "color", "color", "matrix", "string"};
    for (const char* t : types) list.push_back({"q" + std::to_string(list.size()) + tail, t});
    return list;
}

/// Structures with methods, one that extends another, and functions that take them.
const char* const kTypes = R"(
struct Pack
{
    varying float f = 0.5;
    varying color c = color(0.25, 1, 0);
    float add(float x) { f += x * 0.5; return f * 2; }
    color mixed(color x; float k) { return mix(c, x, k); }
    void twist(output float y; float k) { if (k > f) return; y += f; f = y * k; c[1] = y; }
};
struct Deep : Pack
{
    varying float g[3] = {1, 2, 3};
    float add(float x) {
        g[x] += 1;
        float i;
        for (i = 0; i < 3; i += 1) { if (g[i] > x) break; f -= 0.25; }
        return Pack::add(x) + g[1];
    }
    float plain(float x) { if (x > 1) return f; return this->add(x); }
};
float weighed(Pack p; float k) { return p->f * k + comp(p->c, 1); }
void spread(output Pack p; float k) { p->f = k; p->c += k; }
)";

std::string shaderOf(const std::vector<Term>& all, bool object) {
    std::string functions, body, members;
    std::string parameters = "float k = 1.5; color kc = color(0.25, 1, 0.5); point kp = point(1, -2, 0.5); string ks = \"bb\";\n"
                             "matrix km = matrix(1, 0, 0.5, 0, 0, 2, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1);\n";
    for (int n = 0; n < int(all.size()); n++) {
        std::string text = all[size_t(n)].parts[0].write(n);
        const std::string mark = "/*member*/";
        for (size_t at; (at = text.find(mark)) != std::string::npos;) // methods change a member
            text.replace(at, mark.size(), object ? "mf_" + std::to_string(n) + " += x * 0.5; " : "");
        functions += text;
        for (const auto& [name, type] : outputs(n))
            parameters += "output varying " + type + " " + name + " = " + (type == "string" ? "\"\"" : "0") + ";\n";
        body += "{ uniform float j0, j1, j2; float x = 0.1, y = u, z = -v, i0, i1, i2; color c = 0.5, d = color(u, v, 0.25); "
                "point p = P, w = point(1, u, -1);\n"
                "vector r = vector(v, 1, u); normal n = normal(0, u, 1); matrix m = 1; string st = \"a\";\n"
                "float a[4] = {1, 2, -3, 0.5}; color b[3] = {color(1), color(u, 0, 1)}; float h[] = {4, 5, 6};\n";
        body += kStructures;
        body += all[size_t(n)].parts[1].write(n);
        const std::string member = "mf_" + std::to_string(n);
        members += "varying float " + member + " = 0.5;\n";
        const std::string first = object ? "color(x + " + member + ", y, z)" : "color(x, y, z)";
        const char* values[] = {first.c_str(),
                                "c",
                                "d + one->c * two->f + three[1]->c",
                                "p",
                                "w",
                                "r",
                                "n",
                                "color(a[0], a[1], a[2] - a[3])",
                                "b[0] + b[1] * b[2]",
                                "m",
                                "st"};
        const auto names = outputs(n);
        for (size_t q = 0; q < names.size(); q++) body += names[q].first + " = " + values[q] + ";\n";
        body += "}\n";
    }
    if (object)
        return kTypes + ("class random(" + parameters) + ") {\n" + members + functions +
               "public void surface(output color Ci, Oi) {\n" + body + "}\n}\n";
    return kTypes + functions + "surface random(" + parameters + ") {\n" + body + "}\n";
}

} // namespace alpenglow::rsl
