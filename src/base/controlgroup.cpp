#include "base/controlgroup.h"
#include <fstream>

namespace alpenglow {

std::vector<std::string> controlGroupFolders(std::string_view controller) {
    std::vector<std::string> folders;
    std::ifstream in("/proc/self/cgroup");
    for (std::string line; std::getline(in, line);) { // "0::/path" (version 2) or "4:memory:/path" (version 1)
        const size_t first = line.find(':'), second = first == std::string::npos ? first : line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        std::string root = "/sys/fs/cgroup", group = line.substr(second + 1);
        if (controllers != ",,") {
            if (controllers.find("," + std::string(controller) + ",") == std::string::npos) continue;
            root += "/" + std::string(controller);
        }
        for (; !group.empty() && group != "/"; group.erase(group.find_last_of('/'))) folders.push_back(root + group);
        folders.push_back(root);
    }
    return folders;
}

} // namespace alpenglow
