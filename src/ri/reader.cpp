#include "ri/reader.h"
#include "ri/interpreter.h"

namespace alpenglow::ri {

struct RibReader::Inside {
    Interpreter interpreter;
    bool read(std::unique_ptr<ByteSource> source, const std::string& name) {
        int before = interpreter.reporter.errors();
        interpreter.readStream(std::move(source), name);
        return interpreter.reporter.errors() == before;
    }
};

RibReader::RibReader(ReaderOptions o, scene::FrameConsumer& c, Diagnostics& d)
    : in_(new Inside{Interpreter(std::move(o), c, d)}) {}
RibReader::~RibReader() = default;

bool RibReader::readFile(const std::string& path) {
    if (path == "-") return in_->read(standardInput(in_->interpreter.settings.stop), "standard input");
    if (const auto& reads = in_->interpreter.settings.reads) reads->add(path);
    std::string why;
    auto source = fileSource(path, &why, in_->interpreter.settings.regularFiles, in_->interpreter.settings.stop);
    if (!source) {
        in_->interpreter.reporter.error(Rie::NoFile, {path, 0, 0}, "the file cannot be read: " + why);
        return false;
    }
    return in_->read(std::move(source), path);
}

bool RibReader::readMemory(std::string_view text, const std::string& name) { return in_->read(memorySource(text), name); }
bool RibReader::readStream(std::istream& in, const std::string& name) { return in_->read(streamSource(in), name); }

void RibReader::nextScene() { in_->interpreter.nextScene(); }

void RibReader::leavePrograms() { in_->interpreter.leavePrograms(); }
void RibReader::endPrograms() { in_->interpreter.endPrograms(); }

std::shared_ptr<const scene::Frame> RibReader::make(const scene::Frame& frame, std::span<const int> which) {
    return in_->interpreter.make(frame, which);
}

} // namespace alpenglow::ri
