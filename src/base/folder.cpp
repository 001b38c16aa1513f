#include "base/folder.h"
#include <dirent.h>
#include <memory>

namespace alpenglow {

std::vector<std::string> namesIn(const std::string& folder, int most) {
    std::vector<std::string> names;
    struct Closer {
        void operator()(DIR* d) const { ::closedir(d); }
    };
    const std::unique_ptr<DIR, Closer> open(::opendir(folder.empty() ? "." : folder.c_str()));
    while (open && int(names.size()) < most) {
        const dirent* entry = ::readdir(open.get());
        if (!entry) break;
        std::string name = entry->d_name;
        if (name != "." && name != "..") names.push_back(std::move(name));
    }
    return names;
}

} // namespace alpenglow
