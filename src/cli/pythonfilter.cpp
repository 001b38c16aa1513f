// A filter of requests in Python. The function runs in a process of its own: what it does wrong ends that process at most. A
// request goes there as a line of JSON, the answer comes back as JSON.
#include "cli/ribfilters.h"
#include "ri/parser.h"
#include "ri/program.h"
#include "ri/requestfilter.h"
#include "ri/requests/request.h"
#include <cstdlib>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace alpenglow::cli {

namespace {

using Json = nlohmann::json;

constexpr double kSeconds = 60; // for one request

/// What the process runs: its arguments are the filter's name and what stands behind it. What the function prints goes to
/// standard error. The first line asks for the function.
constexpr const char* kServer = R"PYTHON(import importlib, importlib.util, json, os, sys, traceback
out = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
def answer(a):
    out.write(json.dumps(a).encode() + b"\xff")
    out.flush()
def load(name):
    if name.startswith("python:"):
        module, _, function = name[7:].rpartition(".")
        sys.path.insert(0, os.getcwd())
        return getattr(importlib.import_module(module), function)
    path, _, function = name.rpartition(".py")
    spec = importlib.util.spec_from_file_location(os.path.basename(path), path + ".py")
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, os.path.dirname(os.path.abspath(path)))
    spec.loader.exec_module(module)
    return getattr(module, function.lstrip(":") or "filter")
def plain(v):
    if hasattr(v, "tolist"):
        v = v.tolist()
    return [plain(x) for x in v] if isinstance(v, (list, tuple)) else v
def one(r):
    if isinstance(r, str):
        return r
    r = list(r) + [[], {}][len(r) - 1:]
    return [r[0], plain(r[1]), {k: plain(v) for k, v in r[2].items()}]
function = None
sys.argv = sys.argv[1:]
for line in sys.stdin.buffer:
    try:
        q = json.loads(line)
        if function is None:
            function = load(sys.argv[0])
            answer({"keep": True})
            continue
        a = function(q["request"], q["args"], q["params"])
        if a is None or a is True:
            answer({"keep": True})
        else:
            answer({"by": [] if a is False else [one(r) for r in a]})
    except BaseException as e:
        where = [f for f in traceback.extract_tb(e.__traceback__) if f.filename != "<string>"]
        at = " (%s:%d)" % (where[-1].filename, where[-1].lineno) if where else ""
        answer({"error": "%s: %s%s" % (type(e).__name__, e, at)})
)PYTHON";

std::string pythonFile() {
    const char* path = std::getenv("PATH");
    std::string all = path ? path : "/usr/bin:/bin";
    for (size_t at = 0; at <= all.size();) {
        const size_t end = std::min(all.find(':', at), all.size());
        const std::string file = all.substr(at, end - at) + "/python3";
        if (access(file.c_str(), X_OK) == 0) return file;
        at = end + 1;
    }
    return "";
}

Json jsonOf(const ri::Value& v) {
    Json list = Json::array();
    for (double d : v.numbers) list.push_back(d);
    for (const std::string& s : v.strings) list.push_back(s);
    return list;
}

/// A request as the function gets it: numbers and texts one by one, arrays as lists.
std::string lineOf(const ri::Call& c) {
    Json args = Json::array(), params = Json::object();
    for (size_t i = 0; i < c.arguments.size(); ++i) {
        if (!c.arguments[i].given) continue;
        ri::Value v;
        v.numbers = c.arguments[i].numbers;
        v.strings = c.arguments[i].strings;
        const Json list = jsonOf(v);
        const ri::ArgSpec& spec = c.request->args[i];
        if (spec.array) args.push_back(list);
        else
            for (const Json& x : list) args.push_back(x);
    }
    for (const ri::RawParam& p : c.params) params[p.token] = jsonOf(p.value);
    return Json{{"request", c.request->name}, {"args", std::move(args)}, {"params", std::move(params)}}.dump(
        -1, ' ', false, Json::error_handler_t::replace);
}

/// False: it is neither a number, nor a text, nor a list of either.
bool valueOf(const Json& j, ri::Value& v) {
    v.array = j.is_array();
    for (const Json& x : v.array ? j : Json::array({j})) {
        if (x.is_number()) v.numbers.push_back(x.get<double>());
        else if (x.is_boolean()) v.numbers.push_back(x.get<bool>() ? 1 : 0);
        else if (x.is_string()) v.strings.push_back(x.get<std::string>());
        else return false;
    }
    v.kind = !v.numbers.empty()   ? ri::Value::Kind::Numbers
             : !v.strings.empty() ? ri::Value::Kind::Strings
                                  : ri::Value::Kind::Empty;
    return v.numbers.empty() || v.strings.empty();
}

class PythonFilter final : public ri::RequestReceiver {
public:
    PythonFilter(std::string name, std::unique_ptr<ri::Program> program, ri::RequestReceiver& to, Diagnostics& reported,
                 const StopFlag* stop)
        : name_(std::move(name)), program_(std::move(program)), to_(to), reported_(reported), reporter_(reported), stop_(stop) {}

    void request(const ri::Call& c) override {
        if (!program_) return to_.request(c);
        std::string text, why;
        if (!program_->ask(lineOf(c) + "\n", kSeconds, stop_, text, why)) {
            program_.reset();
            error(c.place, why, "the requests from here on pass unchanged");
            return to_.request(c);
        }
        const Json a = Json::parse(text, nullptr, false);
        if (a.is_discarded() || !a.is_object()) return error(c.place, "its answer cannot be read", "");
        if (a.contains("error")) return error(c.place, "it raised " + a["error"].get<std::string>(), "the request is left out");
        if (!a.contains("by")) return to_.request(c);
        for (const Json& r : a["by"]) replace(r, c.place);
    }
    void unknown(const std::string& name, const std::vector<ri::Value>& values) override { to_.unknown(name, values); }
    void comment(const std::string& kind, const std::string& text) override { to_.comment(kind, text); }
    bool over() const override { return to_.over(); }

private:
    void error(const SourcePlace& at, const std::string& what, const std::string& hint) {
        reported_.report(Severity::Error, Rie::System, at, fmt::format("filter \"{}\": {}", name_, what), hint);
    }
    /// Passes on a request that the function gave: [name, args, params], or RIB.
    void replace(const Json& r, const SourcePlace& at) {
        if (r.is_string()) {
            for (const ri::Call& c : ri::requestsOf(r.get<std::string>(), name_, reported_)) to_.request(c);
            return;
        }
        ri::Call c;
        c.place = at;
        const std::string name = r[0].is_string() ? r[0].get<std::string>() : "";
        c.request = ri::findRequest(name);
        if (!c.request || !r[1].is_array())
            return error(at, c.request ? "the arguments of " + name + " are no list" : "\"" + name + "\" is no request",
                         "a list of (name, [arguments], {parameters})");
        std::vector<ri::Value> values;
        bool good = true;
        for (const Json& x : r[1]) good &= valueOf(x, values.emplace_back());
        for (const auto& [token, x] : r[2].items()) {
            good &= valueOf(token, values.emplace_back());
            good &= valueOf(x, values.emplace_back());
            values.back().array = true;
        }
        if (!good) return error(at, name + " has an argument that is neither a number, nor a text, nor a list of either", "");
        if (ri::matchArguments(values, c, reporter_)) to_.request(c);
    }

    std::string name_;
    std::unique_ptr<ri::Program> program_;
    ri::RequestReceiver& to_;
    Diagnostics& reported_;
    ri::Reporter reporter_;
    const StopFlag* stop_;
};

} // namespace

std::unique_ptr<ri::RequestReceiver> pythonFilter(const std::string& spec, const std::vector<std::string>& arguments,
                                                  ri::RequestReceiver& to, Diagnostics& reported, const StopFlag* stop,
                                                  std::string& why) {
    const std::string python = pythonFile();
    if (python.empty()) {
        why = "there is no python3 in PATH";
        return nullptr;
    }
    std::vector<std::string> command = {python, "-c", kServer, spec};
    command.insert(command.end(), arguments.begin(), arguments.end());
    auto program = ri::Program::start(command, why);
    std::string text;
    if (!program || !program->ask("{}\n", kSeconds, stop, text, why)) return nullptr;
    const Json a = Json::parse(text, nullptr, false);
    if (a.is_object() && a.contains("keep")) return std::make_unique<PythonFilter>(spec, std::move(program), to, reported, stop);
    why = a.is_object() && a.contains("error") ? a["error"].get<std::string>() : "its answer cannot be read";
    return nullptr;
}

} // namespace alpenglow::cli
