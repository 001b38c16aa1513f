// Which files scenes and shaders may read.
#include "base/file.h"
#include "base/realpath.h"
#include <algorithm>
#include <filesystem>

namespace fs = std::filesystem;

namespace alpenglow {

std::string followedPath(const std::string& path) {
    std::error_code e;
    const fs::path plain = fs::absolute(path.empty() ? "." : path, e);
    const fs::path real = fs::weakly_canonical(plain, e);
    return (e ? plain.lexically_normal() : real).string();
}

bool sameFile(const std::string& a, const std::string& b) {
    std::error_code e;
    return fs::equivalent(a, b, e) || fileIdentity(a) == fileIdentity(b);
}

bool liesBelow(const std::string& path, const std::vector<std::string>& folders) {
    const fs::path file = followedPath(path);
    return std::any_of(folders.begin(), folders.end(), [&](const std::string& folder) {
        const fs::path root = followedPath(folder);
        const auto m = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
        return m.first == root.end() || m.first->empty(); // a trailing slash leaves an empty component
    });
}

ReadPolicy readPolicyOf(const std::string& sceneFolder, bool anywhere) {
    ReadPolicy policy{anywhere, {sceneFolder, "."}};
    std::error_code e;
    fs::path folder = fs::absolute(sceneFolder.empty() ? "." : sceneFolder, e).lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();
    if (const fs::path holder = folder.parent_path(); !e && holder != holder.root_path())
        policy.folders.push_back(holder.string());
    return policy;
}

Diagnostic outsideMessage(const std::string& what, const std::string& name, const std::string& path, const SourcePlace& place) {
    Diagnostic d;
    d.code = Rie::NoFile;
    d.place = place;
    std::error_code e;
    const fs::path real = followedPath(path), plain = fs::absolute(path, e).lexically_normal();
    d.message = what + " \"" + name + "\" is not read: it " +
                (real == plain ? "lies outside" : "leads by a link to \"" + real.string() + "\", outside") +
                " the folders that a scene may read";
    d.hint = "--searchpath " + real.parent_path().string() + " adds its folder, --allow-read permits all";
    return d;
}

} // namespace alpenglow
