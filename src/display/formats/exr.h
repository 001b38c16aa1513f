// Shared by the codecs of flat and deep OpenEXR pictures.
#pragma once
#include "display/formats/codecs.h"
#include <Iex.h>
#include <ImathMatrix.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartInputFile.h>
#include <cstring>

namespace alpenglow::display {

/// Bytes in memory as OpenEXR reads them.
class MemoryStream : public Imf::IStream {
public:
    /// name: for messages of OpenEXR. The bytes must outlive the stream.
    MemoryStream(Bytes b, const std::string& name) : Imf::IStream(name.c_str()), bytes_(b) {}
    bool read(char c[], int n) override {
        if (n < 0 || at_ > bytes_.size() || bytes_.size() - at_ < size_t(n)) throw Iex::InputExc("it is truncated");
        std::memcpy(c, bytes_.data() + at_, size_t(n));
        at_ += uint64_t(n);
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t pos) override { at_ = pos; }
    void clear() override {}

private:
    Bytes bytes_;
    uint64_t at_ = 0;
};

/// An OutputFile as OpenEXR writes it. Errors show in OutputFile::ok().
class FileStream : public Imf::OStream {
public:
    /// Writes from the current position; the file must outlive the stream.
    explicit FileStream(OutputFile& f) : Imf::OStream(f.path().c_str()), file_(f) {}
    void write(const char c[], int n) override {
        if (!file_.write(c, size_t(n))) throw Iex::IoExc("write failed");
    }
    uint64_t tellp() override { return file_.tell(); }
    void seekp(uint64_t pos) override { file_.seek(pos); }

private:
    OutputFile& file_;
};

/// The same rows: OpenEXR has row vectors, too.
inline Matrix toMatrix(const Imath::M44f& m) {
    Matrix r;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) r.m[i][j] = m[i][j];
    return r;
}
inline Imath::M44f fromMatrix(const Matrix& m) {
    Imath::M44f r;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) r[i][j] = float(m.m[i][j]);
    return r;
}

/// Text, numbers and the matrices of a header, into the picture's.
void readAttributes(const Imf::Header&, Image&);
/// The reverse of readAttributes().
void writeAttributes(const Image&, Imf::Header&);
/// Decodes a file whose first part has deep scan lines, after its headers were checked.
std::optional<Image> decodeDeep(Imf::MultiPartInputFile&, const DecodeContext&);
/// Writes image.deep. Returns false after an error, which is in `why` (or in the file).
bool encodeDeep(OutputFile&, const Image&, std::string& why);

} // namespace alpenglow::display
