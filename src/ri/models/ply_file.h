// What stands in a .ply file: the elements that its header declares, and their rows of numbers.
#pragma once
#include "base/diagnostics.h"
#include "ri/models/model.h"
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::ri {

/// How a number is stored.
enum class PlyNumber { I8, U8, I16, U16, I32, U32, I64, U64, F32, F64 };

/// A number of each row of an element, or a list of numbers.
struct PlyProperty {
    std::string name;                ///< of the header
    PlyNumber type = PlyNumber::F32; ///< of the number, or of the list's numbers
    std::optional<PlyNumber> count;  ///< of a list
};
/// So many rows of the same properties.
struct PlyElement {
    std::string name; ///< of the header
    double count = 0; ///< of rows; not checked against the size of the file
    std::vector<PlyProperty> properties;
    /// The index of a property; -1: there is none of this name.
    int find(std::string_view n) const {
        for (size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == n) return int(i);
        return -1;
    }
};
/// The numbers of one row.
struct PlyRow {
    std::vector<double> values;             ///< by property; of a list its length
    std::vector<std::vector<double>> lists; ///< by property
};

/// Reads the header, then row by row, in the order of the file. The log reports what is wrong.
class PlyFile {
public:
    /// path: for messages. The bytes must outlive this.
    PlyFile(const std::string& path, std::string_view bytes, ModelLog& log) : path_(path), bytes_(bytes), log_(log) {}
    /// Reads the header. False after an error.
    bool header();
    /// What the header declares, in the order of the file.
    const std::vector<PlyElement>& elements() const { return elements_; }
    /// Reads the next row, which is one of this element. False after an error.
    bool row(const PlyElement&, PlyRow&);
    /// Where the reader is: the line of a text.
    SourcePlace here() const { return {path_, counted() ? line_ : 0, 0}; }
    /// The same in words, where there are no lines.
    std::string where() const;

private:
    enum class Format { Ascii, Little, Big };
    bool counted() const { return format_ == Format::Ascii || inHeader_; }
    bool fail(Rie code, const std::string& what);
    std::string_view line();
    bool headerLine(const std::vector<std::string_view>& words);
    bool formatLine(const std::vector<std::string_view>& words);
    bool elementLine(const std::vector<std::string_view>& words);
    bool propertyLine(const std::vector<std::string_view>& words);
    bool number(PlyNumber, double&);
    bool word(double&);

    const std::string& path_;
    std::string_view bytes_;
    ModelLog& log_;
    size_t at_ = 0;
    int line_ = 1;
    bool inHeader_ = true;
    Format format_ = Format::Ascii;
    std::vector<PlyElement> elements_;
};

} // namespace alpenglow::ri
