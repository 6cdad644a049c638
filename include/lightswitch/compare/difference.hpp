#pragma once

// Images subtracted, after making sure that they show the same thing.

#include <lightswitch/film/image.hpp>

#include <string>

namespace lightswitch {

/// Throws `Error` unless both images are of one size, and unless their metadata agree on `scene`, `camera` and `size`
/// where both state them. The message names what differs, with both values.
inline void refuse_unless_comparable(const Image& a, const Image& b) {
    const auto size = [](const Image& image) {
        return std::to_string(image.width()) + " x " + std::to_string(image.height());
    };
    if (a.width() != b.width() || a.height() != b.height())
        throw Error("images of different size cannot be compared: " + size(a) + " and " + size(b) + " pixels");
    if (a.empty()) throw Error("images without pixels cannot be compared");
    for (const char* key : {"scene", "camera", "size"}) {
        const auto in_a = a.metadata.find(key), in_b = b.metadata.find(key);
        if (in_a == a.metadata.end() || in_b == b.metadata.end() || in_a->second == in_b->second) continue;
        throw Error(std::string("images with a different ") + key + " cannot be compared: '" + in_a->second +
                    "' and '" + in_b->second + "'");
    }
}

namespace detail {

template <class Operation>
Image combine(const Image& a, const Image& b, Operation operation) {
    refuse_unless_comparable(a, b);
    Image result(a.width(), a.height());
    for (std::size_t i = 0; i < a.pixels().size(); ++i) result.pixels()[i] = operation(a.pixels()[i], b.pixels()[i]);
    for (const auto& entry : a.metadata) {  // what both have in common still describes the result
        const auto other = b.metadata.find(entry.first);
        if (other != b.metadata.end() && other->second == entry.second) result.metadata.insert(entry);
    }
    return result;
}

}  // namespace detail

/// a - b in each channel, with the metadata that both share. Throws as `refuse_unless_comparable`.
inline Image difference(const Image& a, const Image& b) {
    return detail::combine(a, b, [](const Rgb& p, const Rgb& q) { return p - q; });
}

/// |a - b| in each channel, with the metadata that both share. Throws as `refuse_unless_comparable`.
inline Image absolute_difference(const Image& a, const Image& b) {
    return detail::combine(a, b, [](const Rgb& p, const Rgb& q) { return glm::abs(p - q); });
}

}  // namespace lightswitch
