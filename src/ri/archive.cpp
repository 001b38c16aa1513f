// ReadArchive and inline archives (RISpec 3.2, 7.3).
#include "base/file.h"
#include "base/folder.h"
#include "base/limits.h"
#include "base/ownstack.h"
#include "base/realpath.h"
#include "ri/interpreter.h"
#include "ri/limits.h"
#include "ri/parser.h"
#include "ri/zip.h"
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <utility>

namespace alpenglow::ri {
namespace {

namespace fs = std::filesystem;

constexpr size_t kUnkeptReading = 100; // requests that count as executed when an archive that is not kept is read again

/// Files that are open at once; those that nest deeper are read first and closed, up to a size. A process has about 1000.
constexpr size_t kOpenFiles = 64, kKeptBytes = size_t(16) << 20;

bool regular(const fs::path& p) {
    std::error_code ec;
    return fs::is_regular_file(p, ec); // no devices or pipes: an archive ends
}

bool sameButCase(const std::string& a, const std::string& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](unsigned char x, unsigned char y) {
               return std::tolower(x) == std::tolower(y);
           });
}

std::string along(const std::string& name, const std::vector<std::string>& folders, const MayRead& may) {
    if (fs::path(name).is_absolute()) return regular(name) && may(name) ? name : std::string();
    for (const std::string& f : folders) {
        fs::path p = fs::path(f) / name;
        if (regular(p) && may(p.string())) return p.string();
    }
    return {};
}

/// Whether a name says that its file is RIB. Others a scene reads only from its own folder and those that the user named: words
/// of what is no RIB would stand in the messages about it.
bool namedAsRib(const std::string& path) {
    std::string e = fs::path(path).extension().string();
    for (char& c : e) c = char(std::tolower(static_cast<unsigned char>(c)));
    constexpr std::string_view kKnown[] = {".rib", ".ribz", ".gz", ".rz", ".rlf", ".arc", ".archive"};
    return std::find(std::begin(kKnown), std::end(kKnown), e) != std::end(kKnown);
}

bool namedAsZip(const std::string& path) { return zipName(path + "!").has_value(); }

/// What an archive in a zip archive calls `name`: a file in its folder, or at the top; "" if there is neither.
std::string besideInZip(const ZipName& of, const std::string& name) {
    const std::vector<std::string> all = zipMembers(of.zip, limits::kZipEntries, nullptr);
    for (const fs::path& folder : {fs::path(of.member).parent_path(), fs::path()}) {
        std::string member = (folder / name).lexically_normal().string();
        if (std::find(all.begin(), all.end(), member) != all.end()) return member;
    }
    return {};
}

} // namespace

std::string folderOf(const std::string& file) {
    const auto inside = zipName(file);
    return fs::path(inside ? inside->zip : file).parent_path().string();
}

std::vector<std::string> splitSearchPath(const std::string& text) {
    std::vector<std::string> out;
    std::string item;
    for (size_t i = 0; i <= text.size(); ++i) {
        bool drive = i < text.size() && text[i] == ':' && item.size() == 1 && std::isalpha(static_cast<unsigned char>(item[0])) &&
                     i + 1 < text.size() && (text[i + 1] == '/' || text[i + 1] == '\\');
        if (i < text.size() && (drive || (text[i] != ':' && text[i] != ';'))) {
            item += text[i];
            continue;
        }
        if (!item.empty()) out.push_back(std::move(item));
        item.clear();
    }
    return out;
}

std::string findFile(const std::string& name, const std::vector<std::string>& folders, std::string* fallback,
                     const MayRead& may) {
    fallback->clear();
    if (name.empty() || name.find('\0') != std::string::npos) return {};
    if (std::string p = along(name, folders, may); !p.empty()) return p;
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    if (slashes != name) {
        *fallback = "with / for \\";
        if (std::string p = along(slashes, folders, may); !p.empty()) return p;
    }
    std::string base = fs::path(slashes).filename().string();
    if (base.empty()) return {};
    if (base != slashes) {
        *fallback = "by its base name";
        if (std::string p = along(base, folders, may); !p.empty()) return p;
    }
    *fallback = "with other upper and lower case";
    for (const std::string& f : folders) {
        std::string best; // the first in order of name: folders list their files in any order
        for (const std::string& n : namesIn(f)) {
            const std::string path = (fs::path(f) / n).string();
            if (sameButCase(n, base) && regular(path) && may(path) && (best.empty() || path < best)) best = path;
        }
        if (!best.empty()) return best;
    }
    return {};
}

void Interpreter::beginRecording(const Call& call) {
    recording_ = Recording{call.text(0), std::make_shared<std::vector<Call>>(), 0, call.place};
}

/// True when the call was taken into an archive instead of being executed.
bool Interpreter::record(const Call& call) {
    if (!recording_) return false;
    if (call.request->name == "ArchiveBegin") ++recording_->depth;
    if (call.request->name == "ArchiveEnd" && recording_->depth-- == 0) {
        inlineArchives_[recording_->name] = std::move(recording_->calls);
        recording_.reset();
        return true;
    }
    recording_->calls->push_back(call);
    return true;
}

/// The world that is edited is that of the archive; it is drawn as it stands.
void Interpreter::editWorld(const Call& call) {
    if (editsWorld_) return reporter.error(Rie::Nesting, call.place, "EditWorldBegin inside an EditWorldBegin");
    incapable(call, "edits of a world are not done by this version: the world of the archive is drawn as it stands");
    readArchive(call.text(0), call.place);
    editsWorld_ = true;
}

void Interpreter::endEditWorld(const Call& call) {
    if (!editsWorld_) reporter.error(Rie::Nesting, call.place, "EditWorldEnd without EditWorldBegin");
    editsWorld_ = false;
}

bool Interpreter::leftOutEdit(const Call& call) {
    if (!editsWorld_) return false;
    const std::string_view name = call.request->name;
    const bool begins = name == "EditBegin" || name == "EditAttributeBegin",
               ends = name == "EditEnd" || name == "EditAttributeEnd";
    if (begins) {
        ++leftOutEdits_;
    } else if (ends && leftOutEdits_ > 0) {
        --leftOutEdits_;
        return true;
    } else if (name == "EditWorldEnd") {
        if (leftOutEdits_ > 0) reporter.error(Rie::Nesting, call.place, "EditWorldEnd inside an EditBegin");
        leftOutEdits_ = 0;
    }
    return leftOutEdits_ > 0;
}

/// Archives that read archives can repeat a few lines without end; what is read once is bounded by its own length.
bool Interpreter::mayReplay(const Call& call) {
    if (!replaying_ || ++replayedCalls_ <= limits::kReplayedCalls) return true;
    reporter.once("ri:replayed", Severity::Error, Rie::Limit, call.place,
                  fmt::format("archives that are read again execute more than {} requests", limits::kReplayedCalls));
    return false;
}

std::string Interpreter::depthMap(const std::string& name, const SourcePlace& place) {
    std::vector<std::string> folders{""};
    if (!sceneFolder_.empty()) folders.push_back(sceneFolder_);
    folders.insert(folders.end(), settings.searchPaths.begin(), settings.searchPaths.end());
    std::string outside;
    consumer.beforeRead(name);
    const auto found = alpenglow::findFile(name, folders, readPolicyOf(sceneFolder_, settings.allowRead), &outside);
    if (settings.reads && found) settings.reads->add(found->path);
    if (found || outside.empty()) return found ? found->path : name;
    const Diagnostic d = outsideMessage("depth map", name, outside, place);
    reporter.error(d.code, d.place, d.message, d.hint);
    return {};
}

std::string Interpreter::locate(const char* what, const std::string& name, const SourcePlace& place,
                                bool (*named)(const std::string&), const char* along) {
    std::vector<std::string> folders;
    if (auto o = options.values.find(std::string("searchpath:") + along); o != options.values.end() && !o->second.strings.empty())
        for (const std::string& f : splitSearchPath(o->second.strings[0])) {
            if (f == "@") continue; // the standard places are looked through below
            folders.push_back(f);
            // Old scenes name folders from where they lie, whatever the folder the renderer is started in.
            if (fs::path(f).is_relative() && !sceneFolder_.empty() && sceneFolder_ != ".")
                folders.push_back((fs::path(sceneFolder_) / f).string());
        }
    folders.insert(folders.end(), settings.searchPaths.begin(), settings.searchPaths.end());
    std::string folder = folderOf(place.file);
    folders.push_back(folder.empty() ? "." : folder);
    folders.push_back(".");
    folders.insert(folders.end(), settings.lastArchivePaths.begin(), settings.lastArchivePaths.end());
    std::string fallback, outside;
    std::vector<std::string> own = settings.searchPaths; // below them everything is read
    own.insert(own.end(), {sceneFolder_.empty() ? "." : sceneFolder_, "."});
    const ReadPolicy policy = readPolicyOf(sceneFolder_, settings.allowRead);
    std::string file = findFile(name, folders, &fallback, [&](const std::string& path) {
        if (policy.anywhere || liesBelow(path, own)) return true;
        if (named(followedPath(path)) && (liesBelow(path, folders) || liesBelow(path, policy.folders))) return true;
        if (outside.empty()) outside = path;
        return false;
    });
    if (settings.reads) file.empty() ? settings.reads->addMissing(name, folders) : settings.reads->add(file);
    if (file.empty() && !outside.empty()) {
        const Diagnostic d = outsideMessage(what, name, outside, place);
        reporter.error(d.code, place, d.message, d.hint);
        return {};
    }
    if (file.empty()) {
        std::string looked;
        for (size_t i = 0; i < folders.size(); ++i)
            if (std::find(folders.begin(), folders.begin() + long(i), folders[i]) == folders.begin() + long(i))
                looked += (looked.empty() ? "" : ", ") + folders[i];
        reporter.error(Rie::NoFile, place, fmt::format("{} \"{}\" was not found", what, name), "looked in " + looked);
        return {};
    }
    if (!fallback.empty())
        reporter.once("ri:found:" + name, Severity::Warning, Rie::NoFile, place,
                      fmt::format("{} \"{}\" was found {}: {}", what, name, fallback, file));
    return file;
}

std::optional<ArchiveShelf::Found> Interpreter::locateArchive(const std::string& name, const SourcePlace& place) {
    const auto searched = options.values.find("searchpath:archive");
    const bool path = searched != options.values.end() && !searched->second.strings.empty();
    const std::string question = name + '\0' + fs::path(place.file).parent_path().string() + '\0' + sceneFolder_ + '\0' +
                                 (path ? searched->second.strings[0] : "");
    if (const ArchiveShelf::Found* known = shelf_.found(question)) return *known;
    ArchiveShelf::Found found;
    const auto inside = zipName(name), around = zipName(place.file);
    if (const std::string member = around && !inside ? besideInZip(*around, name) : ""; !member.empty()) {
        found = {around->zip + "!" + member, followedPath(around->zip) + "!" + member};
    } else {
        const std::string file =
            inside ? locate("zip archive", inside->zip, place, namedAsZip) : locate("archive", name, place, namedAsRib);
        if (file.empty()) return {};
        const std::string behind = inside ? "!" + inside->member : "";
        found = {file + behind, followedPath(file) + behind};
    }
    shelf_.note(question, found);
    return found;
}

void Interpreter::readArchive(const std::string& name, const SourcePlace& place) {
    if (openArchives_.size() >= size_t(limits::kArchiveDepth)) {
        reporter.once(
            "ri:archivedepth", Severity::Error, Rie::Limit, place,
            fmt::format("archives and procedurals are nested deeper than {}: deeper ones are left out", limits::kArchiveDepth));
        return;
    }
    if (++archiveReads_ > limits::kArchiveReads) {
        reporter.once("ri:archivereads", Severity::Error, Rie::Limit, place,
                      fmt::format("more than {} archives are read", limits::kArchiveReads));
        return;
    }
    std::shared_ptr<std::vector<Call>> calls;
    std::shared_ptr<const ParsedArchive> parsed;
    std::string key, file;
    if (auto i = inlineArchives_.find(name); i != inlineArchives_.end()) {
        calls = i->second;
        key = "inline:" + name;
        file = place.file;
    } else {
        const auto found = locateArchive(name, place);
        if (!found) return;
        file = found->file;
        key = found->key;
    }
    if (openArchives_.contains(key)) {
        reporter.error(Rie::Nesting, place, fmt::format("archive \"{}\" reads itself", name));
        return;
    }
    if (!calls && openArchives_.empty() && !settings.comments && !making_) {
        if (!unscanned_.empty() && settings.threads) ahead_.scan(std::exchange(unscanned_, {}));
        parsed = ahead_.take(name, file);
    }
    if (!calls && !parsed && !settings.comments && archivesRead_.count(key)) {
        parsed = shelf_.take(file);
        if (!parsed) replayedCalls_ += kUnkeptReading;
    }
    if (parsed) return executeParsed(*parsed, key, file);
    std::string why;
    auto source = calls ? nullptr : fileSource(file, &why, true);
    if (calls || source) return readOpened(key, file, calls, std::move(source), place);
    reporter.error(Rie::NoFile, place, fmt::format("archive \"{}\" cannot be read: {}", file, why));
}

void Interpreter::executeParsed(const ParsedArchive& archive, const std::string& key, const std::string& file) {
    inPart(key, [&] {
        auto outer = std::move(reporter.lineText);
        reporter.lineText = [&](const SourcePlace& p) { return p.file == file ? lineOfFile(file, p.line) : std::string(); };
        for (const Call& c : archive.calls) {
            if (stopped() || !mayReplay(c)) break;
            execute(c);
        }
        reporter.lineText = std::move(outer);
        return archive.end;
    });
}

void Interpreter::readOpened(const std::string& key, const std::string& file, const std::shared_ptr<std::vector<Call>>& calls,
                             std::unique_ptr<ByteSource> source, const SourcePlace& place) {
    inPart(key, [&] {
        if (calls) {
            for (const Call& c : *calls) {
                if (stopped() || !mayReplay(c)) break;
                take(c);
            }
            return place;
        }
        if (openArchives_.size() > kOpenFiles) source = inMemory(std::move(source), kKeptBytes);
        Parser parser(inflating(std::move(source)), file, reporter, settings.comments);
        run(parser);
        return parser.here();
    });
}

void Interpreter::deeper(const std::function<void()>& body) {
    // A level takes some 10 kB. The thread may have a small stack; the others have 8 MiB, on which frames are drawn, too.
    constexpr int kLevelsOfAStack = 128, kFirstLevels = 32;
    struct Level {
        int& nested;
        ~Level() { --nested; }
    } const level{nested_};
    if (++nested_ % kLevelsOfAStack == kFirstLevels) onOwnStack(body);
    else body();
}

void Interpreter::inPart(const std::string& key, const std::function<SourcePlace()>& body) {
    bool wasReplaying = replaying_;
    if (!archivesRead_.insert(key).second) replaying_ = true;
    openArchives_.push(key);
    barriers_.push_back(blocks_.size());
    size_t conditions = conditions_.size();
    const int deepConditions = deepConditions_;
    bool wasMoving = motion_.has_value();
    SourcePlace end;
    deeper([&] { end = body(); });
    if (motion_.has_value() && !wasMoving) closeOpenEnds(std::max(conditions, conditions_.size()), end);
    deepConditions_ = deepConditions;
    while (conditions_.size() > conditions) {
        if (!stopped()) reporter.error(Rie::Nesting, conditions_.back().place, "IfBegin without IfEnd in an archive");
        conditions_.pop_back();
    }
    unwind(barriers_.back(), end, true);
    barriers_.pop_back();
    endInnerOptions();
    announceHeld();
    openArchives_.pop();
    replaying_ = wasReplaying;
}

} // namespace alpenglow::ri
