// The module's side of modelfile.h.
#include "models/modelfile.h"
#include "models/stream.h"
#include <cstring>
#include <exception>
#include <unistd.h>

namespace alpenglow::models {

int sendModel(const char* path, int to, char* why, int whySize, void (*read)(const std::string& path, Model&)) {
    std::string text;
    try {
        Model m;
        read(path, m);
        const std::vector<uint8_t> bytes = toBytes(m);
        for (size_t done = 0; done < bytes.size() && text.empty();) {
            const ssize_t k = ::write(to, bytes.data() + done, std::min<size_t>(bytes.size() - done, size_t(1) << 30));
            if (k <= 0) text = "out of memory";
            else done += size_t(k);
        }
    } catch (const std::bad_alloc&) { text = "out of memory"; } catch (const std::exception& e) {
        text = e.what();
        if (text.empty()) text = "it cannot be read";
    }
    std::strncpy(why, text.c_str(), size_t(whySize) - 1);
    return text.empty() ? 0 : 1;
}

} // namespace alpenglow::models
