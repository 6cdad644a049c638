#pragma once

// Arrays of numbers in glTF files.

#include <lightswitch/load/gltf_file.hpp>

#if LIGHTSWITCH_HAS_GLTF

#include <cstring>
#include <unordered_map>

namespace lightswitch::detail {

/// One accessor, whose numbers are converted when they are asked for. All bounds are checked when it is made.
class GltfAccessor {
public:
    /// The accessor of that number, which must have `components` numbers per element and is named by `user`.
    GltfAccessor(GltfFile& file, int number, int components, const Origin& user)
        : GltfAccessor(file, file.element(file.model().accessors, number, "accessors", user),
                       file.origin("accessors", static_cast<std::size_t>(std::max(number, 0))), components) {}

    std::size_t count() const { return count_; }
    const Origin& origin() const { return origin_; }
    /// Whether the numbers are whole and not negative, as they are stored.
    bool is_unsigned() const {
        return type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
               type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    }

    /// A number of an element, as a fraction where the accessor is normalized.
    double number(std::size_t element, int component) const {
        const char* const bytes = place(element);
        if (bytes == nullptr) return 0;
        const char* const at = bytes + static_cast<std::size_t>(component) * component_size(type_);
        switch (type_) {
            case TINYGLTF_COMPONENT_TYPE_BYTE: return fraction(read<std::int8_t>(at));
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return fraction(read<std::uint8_t>(at));
            case TINYGLTF_COMPONENT_TYPE_SHORT: return fraction(read<std::int16_t>(at));
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return fraction(read<std::uint16_t>(at));
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read<std::uint32_t>(at);
            default: return double(read<float>(at));
        }
    }
    /// A scalar of an accessor that is unsigned.
    std::uint32_t index(std::size_t element) const { return static_cast<std::uint32_t>(number(element, 0)); }

    /// Two or three numbers; throws for one that is not finite.
    Vec2 vec2(std::size_t element) const {
        const Vec2 result(static_cast<float>(number(element, 0)), static_cast<float>(number(element, 1)));
        if (!is_finite(result.x) || !is_finite(result.y)) not_finite(element);
        return result;
    }
    DVec3 vec3(std::size_t element) const {
        const DVec3 result(number(element, 0), number(element, 1), number(element, 2));
        if (!is_finite(result)) not_finite(element);
        return result;
    }

private:
    GltfAccessor(GltfFile& file, const tinygltf::Accessor& accessor, Origin where, int components)
        : origin_(std::move(where)),
          type_(accessor.componentType),
          count_(accessor.count),
          normalized_(accessor.normalized) {
        const int stored = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
        if (stored != components)
            fail(origin_, "has elements of " + std::to_string(stored) + " numbers where " + std::to_string(components) +
                              " are needed");
        const std::size_t size = component_size(type_) * static_cast<std::size_t>(components);
        if (size == 0) fail(origin_, "has numbers of the type " + std::to_string(type_) + ", which glTF does not have");
        if (accessor.bufferView != -1) {
            const std::string_view bytes = file.view(accessor.bufferView, origin_);
            const std::size_t given =
                file.model().bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
            stride_ = given == 0 ? size : given;
            if (stride_ < size)
                fail(origin_, "has elements of " + std::to_string(size) + " bytes every " + std::to_string(stride_));
            data_ = range(bytes, accessor.byteOffset, stride_, size, count_);
        } else if (count_ > file.used_bytes()) {
            // Zeros need no bytes.
            fail(origin_, "has " + std::to_string(count_) + " elements without data, more than the file has bytes");
        }
        if (accessor.sparse.isSparse) read_sparse(file, accessor, size);
    }

    void read_sparse(GltfFile& file, const tinygltf::Accessor& accessor, std::size_t size) {
        const auto& sparse = accessor.sparse;
        const int index_type = sparse.indices.componentType;
        if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > count_)
            fail(origin_, "replaces " + std::to_string(sparse.count) + " of " + std::to_string(count_) + " elements");
        if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
            index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT && index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            fail(origin_, "has sparse indices of the type " + std::to_string(index_type));
        const auto count = static_cast<std::size_t>(sparse.count), index_size = component_size(index_type);
        if (count == 0) return;
        const auto offset = [&](int bytes) {
            if (bytes < 0) fail(origin_, "has a negative offset");
            return static_cast<std::size_t>(bytes);
        };
        const char* const indices = range(file.view(sparse.indices.bufferView, origin_),
                                          offset(sparse.indices.byteOffset), index_size, index_size, count);
        const char* const values =
            range(file.view(sparse.values.bufferView, origin_), offset(sparse.values.byteOffset), size, size, count);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t index = 0;
            for (std::size_t b = 0; b < index_size; ++b)
                index |= static_cast<std::uint32_t>(static_cast<unsigned char>(indices[i * index_size + b])) << (8 * b);
            if (index >= count_)
                fail(origin_, "replaces element " + std::to_string(index) + ", but there are " +
                                  std::to_string(count_) + " (counted from 0)");
            replaced_[index] = values + i * size;
        }
    }

    /// Where elements begin, which are known to lie within `bytes`.
    const char* range(std::string_view bytes, std::size_t offset, std::size_t stride, std::size_t size,
                      std::size_t count) const {
        if (count == 0) return bytes.data();
        // Dividing, not multiplying, which could overflow.
        if (offset > bytes.size() || size > bytes.size() - offset ||
            (count - 1) > (bytes.size() - offset - size) / stride)
            fail(origin_, "has " + std::to_string(count) + " elements of " + std::to_string(size) +
                              " bytes, more than are in its buffer view");
        return bytes.data() + offset;
    }

    const char* place(std::size_t element) const {
        if (!replaced_.empty())
            if (const auto found = replaced_.find(element); found != replaced_.end()) return found->second;
        return data_ == nullptr ? nullptr : data_ + element * stride_;
    }

    static std::size_t component_size(int type) {
        switch (type) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
            case TINYGLTF_COMPONENT_TYPE_SHORT:
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
            default: return 0;
        }
    }

    template <class T>
    static T read(const char* bytes) {
        if constexpr (sizeof(T) == 1) return static_cast<T>(*bytes);
        else if constexpr (sizeof(T) == 2) return std::bit_cast<T>(get_little_endian<std::uint16_t>(bytes));
        else return std::bit_cast<T>(get_little_endian<std::uint32_t>(bytes));
    }
    template <class T>
    double fraction(T value) const {
        return normalized_ ? std::max(double(value) / std::numeric_limits<T>::max(), -1.0) : double(value);
    }

    [[noreturn]] void not_finite(std::size_t element) const {
        fail(origin_, "has a number that is not finite in element " + std::to_string(element));
    }

    Origin origin_;
    int type_;
    std::size_t count_, stride_ = 0;
    bool normalized_;
    const char* data_ = nullptr;  ///< null where all numbers are 0
    std::unordered_map<std::size_t, const char*> replaced_;
};

}  // namespace lightswitch::detail

#endif
