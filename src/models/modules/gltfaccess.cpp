// Accessors of glTF: numbers out of buffers. glTF 2.0, 3.6.2.
#include "gltfread.h"
#include <algorithm>
#include <cstring>
#include <limits>

namespace alpenglow::models {

namespace {

constexpr size_t kElements = 200'000'000; ///< of one accessor

template <class T> double one(const unsigned char* at, bool fraction) {
    T v;
    std::memcpy(&v, at, sizeof v);
    if (!fraction || !std::numeric_limits<T>::is_integer) return double(v);
    return std::max(-1.0, double(v) / double(std::numeric_limits<T>::max()));
}

double number(const unsigned char* at, int type, bool fraction) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return one<int8_t>(at, fraction);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return one<uint8_t>(at, fraction);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return one<int16_t>(at, fraction);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return one<uint16_t>(at, fraction);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return one<uint32_t>(at, fraction);
    default:
        return one<float>(at, fraction);
    }
}

/// Bytes of a component; 0: glTF has no such type.
size_t sizeOf(int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

/// Numbers of an element; 0: none that is used for vertices, keys or joints.
size_t widthOf(int type) {
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    case TINYGLTF_TYPE_MAT4:
        return 16;
    default:
        return 0;
    }
}

} // namespace

const unsigned char* GltfReader::bytes(int view, size_t offset, size_t count, size_t size, size_t& stride) {
    if (view < 0 || size_t(view) >= in_.bufferViews.size()) {
        error("an accessor names a bufferView that is not there");
        return nullptr;
    }
    const tinygltf::BufferView& v = in_.bufferViews[size_t(view)];
    if (v.buffer < 0 || size_t(v.buffer) >= in_.buffers.size()) {
        error("a bufferView names a buffer that is not there");
        return nullptr;
    }
    const std::vector<unsigned char>& data = in_.buffers[size_t(v.buffer)].data;
    stride = v.byteStride ? v.byteStride : size;
    const size_t start = v.byteOffset, length = v.byteLength;
    if (start > data.size() || length > data.size() - start || offset > length || count == 0 || size > length - offset ||
        (count - 1) > (length - offset - size) / stride) {
        error("an accessor reaches beyond its bufferView, or that beyond its buffer; it is left out");
        return nullptr;
    }
    return data.data() + start + offset;
}

bool GltfReader::dense(const tinygltf::Accessor& a, size_t width, size_t size, std::vector<double>& out) {
    size_t stride = 0;
    const unsigned char* at = bytes(a.bufferView, a.byteOffset, a.count, width * size, stride);
    if (!at) return false;
    out.reserve(a.count * width);
    for (size_t i = 0; i < a.count; ++i)
        for (size_t k = 0; k < width; ++k) out.push_back(number(at + i * stride + k * size, a.componentType, a.normalized));
    return true;
}

bool GltfReader::sparse(const tinygltf::Accessor& a, size_t width, size_t size, std::vector<double>& out) {
    const size_t wide = sizeOf(a.sparse.indices.componentType), count = a.sparse.count < 0 ? 0 : size_t(a.sparse.count);
    size_t indexStride = 0, stride = 0;
    if (wide == 0 || a.sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT || a.sparse.indices.byteOffset < 0 ||
        a.sparse.values.byteOffset < 0) {
        error("a sparse accessor's indices are no whole numbers");
        return false;
    }
    const unsigned char* index =
        bytes(a.sparse.indices.bufferView, size_t(a.sparse.indices.byteOffset), count, wide, indexStride);
    const unsigned char* value =
        bytes(a.sparse.values.bufferView, size_t(a.sparse.values.byteOffset), count, width * size, stride);
    if (!index || !value) return false;
    for (size_t i = 0; i < count; ++i) {
        const double to = number(index + i * indexStride, a.sparse.indices.componentType, false);
        if (!(to >= 0 && to < double(a.count))) {
            error("a sparse accessor's index is out of range; it is left out");
            continue;
        }
        for (size_t k = 0; k < width; ++k)
            out[size_t(to) * width + k] = number(value + i * stride + k * size, a.componentType, a.normalized);
    }
    return true;
}

std::vector<double> GltfReader::numbers(int accessor, const char* what, size_t wanted, size_t* width) {
    if (accessor < 0) return {};
    if (size_t(accessor) >= in_.accessors.size()) {
        error(std::string("accessor ") + std::to_string(accessor) + " (" + what + ") is not there");
        return {};
    }
    const tinygltf::Accessor& a = in_.accessors[size_t(accessor)];
    const size_t w = widthOf(a.type), size = sizeOf(a.componentType);
    if (w == 0 || size == 0 || (wanted && w != wanted)) {
        error(std::string("accessor ") + std::to_string(accessor) + " has another type than " + what + " have");
        return {};
    }
    if (a.count > kElements) {
        error(std::string("accessor ") + std::to_string(accessor) + " says that it has " + std::to_string(a.count) + " elements");
        return {};
    }
    if (width) *width = w;
    std::vector<double> out;
    if (a.bufferView >= 0) {
        if (!dense(a, w, size, out)) return {};
    } else {
        if (a.count > kElements / 16) { // nothing in the file stands for them
            error(std::string("accessor ") + std::to_string(accessor) + " has too many elements without a bufferView");
            return {};
        }
        out.assign(a.count * w, 0);
    }
    if (a.sparse.isSparse && !sparse(a, w, size, out)) return {};
    return out;
}

std::vector<float> GltfReader::floats(int accessor, const char* what, size_t wanted, size_t* width) {
    const std::vector<double> all = numbers(accessor, what, wanted, width);
    return {all.begin(), all.end()};
}

double numberOf(const tinygltf::Value& v, const char* name, double byDefault) {
    if (!v.IsObject() || !v.Has(name)) return byDefault;
    const tinygltf::Value& x = v.Get(name);
    return x.IsNumber() ? x.GetNumberAsDouble() : byDefault;
}

void numbersOf(const tinygltf::Value& v, const char* name, double* to, size_t most) {
    if (!v.IsObject() || !v.Has(name)) return;
    const tinygltf::Value& list = v.Get(name);
    if (!list.IsArray()) return;
    for (size_t i = 0; i < std::min(most, list.ArrayLen()); ++i)
        if (const tinygltf::Value& x = list.Get(int(i)); x.IsNumber()) to[i] = x.GetNumberAsDouble();
}

} // namespace alpenglow::models
