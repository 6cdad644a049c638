#pragma once

// Bitmaps from image files.

#include <lightswitch/core/file.hpp>
#include <lightswitch/film/exr.hpp>
#include <lightswitch/film/exr_layout.hpp>
#include <lightswitch/film/pfm.hpp>
#include <lightswitch/film/rgbe.hpp>
#include <lightswitch/texture/bitmap.hpp>
#include <lightswitch/texture/stb_decode.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace lightswitch {

/// How `load_bitmap` reads a file and how the bitmap is looked up.
struct BitmapOptions {
    bool raw = false;  ///< PNG, JPEG, BMP, TGA: values are fractions of the largest, not encoded in sRGB
    TextureFilter filter = TextureFilter::bilinear;
    TextureWrap wrap = TextureWrap::repeat;
    bool half = false;  ///< EXR, HDR and PFM of 32 bits: keep 16
};

/// Reads a texture; what the file holds decides how, not its name.
///
/// | file | kept as | read as |
/// |---|---|---|
/// | PNG, JPEG, BMP, TGA of at most 8 bits | 8 bits, grey or RGB | sRGB, unless `raw` |
/// | PNG of 16 bits | 16-bit floats, decoded, as in Mitsuba 3 | sRGB, unless `raw` |
/// | EXR (see `load_image`) | 16 bits when R, G and B are stored so, otherwise 32 | linear |
/// | HDR, PFM | 32-bit floats | linear |
///
/// Alpha is ignored and does not weigh colours. Linear images that are grey everywhere are kept as one channel.
/// Values are not limited: see `Bitmap::problem`, `least` and `most`. Throws `Error` with the file's name when it is
/// missing, damaged, cut off, larger than an `Image` may be, or of another kind. JPEG, BMP, TGA and uncompressed EXR
/// carry no checksums, so damage to values can pass unnoticed there.
inline Bitmap load_bitmap(const std::filesystem::path& path, const BitmapOptions& options = {}) {
    const std::string name = path.string();
    const Origin where = detail::file_origin(path);
    constexpr std::uintmax_t max_bytes = 16 * Image::max_area + (1 << 24);
    const std::string bytes = read_file(path, max_bytes);
    if (bytes.empty()) fail(where, "is empty, no image");

    const TextureLookup lookup{options.filter, options.wrap};
    const auto from_image = [&](const Image& image, bool half) {
        const TexelPrecision precision = half ? TexelPrecision::half : TexelPrecision::float32;
        return at_place(where, [&] { return make_bitmap(image, precision, lookup); });
    };
    const std::string_view start(bytes.data(), std::min<std::size_t>(bytes.size(), 4));
    if (start == detail::exr_magic) {
        const detail::ExrLayout layout = detail::read_exr_layout(bytes, name);
        const auto stored_in_16 = [&](const char* channel) {
            return layout.channels[static_cast<std::size_t>(layout.channel(channel))].type == detail::ExrType::half;
        };
        const bool half = stored_in_16("R") && stored_in_16("G") && stored_in_16("B");
        return from_image(detail::decode_exr(bytes, name), half || options.half);
    }
    // The library's own reader rather than stb_image's: it refuses damage, and divides EXPOSURE out.
    if (start.starts_with("#?")) return from_image(detail::decode_rgbe(bytes, name), options.half);
    if (start.starts_with("PF") || start.starts_with("Pf"))
        return from_image(detail::decode_pfm(bytes, name), options.half);
    return detail::decode_stb(bytes, name, options.raw ? TexelEncoding::linear : TexelEncoding::srgb, lookup);
}

}  // namespace lightswitch
