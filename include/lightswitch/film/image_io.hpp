#pragma once

// Images as files: .exr, .hdr, .pfm (linear) and .png (tone mapped).

#include <lightswitch/core/file.hpp>
#include <lightswitch/film/exr.hpp>
#include <lightswitch/film/pfm.hpp>
#include <lightswitch/film/png.hpp>
#include <lightswitch/film/rgbe.hpp>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>

namespace lightswitch {

/// How an image is written.
struct SaveOptions {
    float exposure = 0;  ///< PNG only, in stops: radiance is multiplied by 2^exposure before the sRGB curve
};

namespace detail {

enum class ImageFormat { exr, hdr, pfm, png };

/// The format that the extension names, in upper or lower case. Throws `Error` for any other.
inline ImageFormat image_format(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension == ".exr") return ImageFormat::exr;
    if (extension == ".hdr") return ImageFormat::hdr;
    if (extension == ".pfm") return ImageFormat::pfm;
    if (extension == ".png") return ImageFormat::png;
    const std::string found = extension.empty() ? "has no extension" : "has the extension '" + extension + "'";
    fail(file_origin(path), found + "; an image is one of .exr, .hdr, .pfm, .png");
}

inline constexpr std::uintmax_t max_image_bytes = 16 * Image::max_area + (1 << 24);  // four floats per pixel, a header

}  // namespace detail

/// Throws `Error` unless `save(path, ...)` can be expected to work: the extension is known, the directory exists and
/// may be written, the path is not a directory. Leaves nothing behind; call it before a long render.
inline void check_writable(const std::filesystem::path& path) {
    if (detail::image_format(path) == detail::ImageFormat::exr && !detail::has_exr)
        detail::encode_exr(Image(), path.string());
    check_file_writable(path);
}

/// Writes the image in the format that the extension names, atomically (see `write_file_atomically`).
///
/// | extension | pixels | metadata | values that are not finite |
/// |---|---|---|---|
/// | .exr | linear, 32-bit float, ZIP, bit-exact | `lightswitch:` attributes | kept |
/// | .pfm | linear, 32-bit float, bit-exact | none | kept |
/// | .hdr | linear, RGBE: 8 bits of the largest channel; negative values: 0 | comments | NaN: 0; infinity: 1.7e38 |
/// | .png | exposure, clamped to [0,1], sRGB curve, 8 bits | none | NaN: the pixel is magenta; infinity: clamped |
///
/// Throws `Error` for an unknown extension, an empty image, .exr in a build without tinyexr, and failures to write.
/// Different paths may be written in parallel.
inline void save(const std::filesystem::path& path, const Image& image, const SaveOptions& options = {}) {
    const detail::ImageFormat format = detail::image_format(path);
    if (image.empty()) fail(detail::file_origin(path), "an image without pixels cannot be written");
    if (!is_finite(options.exposure)) fail(detail::file_origin(path), "the exposure must be a finite number of stops");
    detail::check_output_name(detail::resolve_output(path));  // before the encoding, which may take seconds
    switch (format) {
        case detail::ImageFormat::exr: return write_file_atomically(path, detail::encode_exr(image, path.string()));
        case detail::ImageFormat::hdr: return write_file_atomically(path, detail::encode_rgbe(image));
        case detail::ImageFormat::pfm: return write_file_atomically(path, detail::encode_pfm(image));
        case detail::ImageFormat::png: return write_file_atomically(path, detail::encode_png(image, options.exposure));
    }
}

/// Whether a file of that name holds what a screen shows, at an exposure: .png does.
inline bool is_picture(const std::filesystem::path& path) {
    return detail::image_format(path) == detail::ImageFormat::png;
}

/// Whether a file of that name can hold layers: those of .exr can.
inline bool can_hold_layers(const std::filesystem::path& path) {
    return detail::image_format(path) == detail::ImageFormat::exr;
}

/// Writes the image and its layers, all of one size, as an .exr file: image and metadata as `save` does, so that
/// `load_image` reads them (up to 2^28 values in all), and the channels "name.C" for every letter C of a layer, as
/// other programs know them. Throws `Error` like `save`, for another extension, and for layers that do not fit.
inline void save_layers(const std::filesystem::path& path, const Image& image, std::span<const Layer> layers) {
    if (!can_hold_layers(path)) fail(detail::file_origin(path), "only .exr files hold layers");
    if (image.empty()) fail(detail::file_origin(path), "an image without pixels cannot be written");
    detail::check_output_name(detail::resolve_output(path));
    write_file_atomically(path, detail::encode_exr(image, path.string(), layers));
}

/// Reads a linear image: .exr (scan lines; R, G, B of 16 or 32 bits; uncompressed, RLE, ZIP, ZIPS or PIZ), .hdr, .pfm.
///
/// Other channels are ignored; metadata written by `save` come back. Takes memory in proportion to the file. Throws
/// `Error` when the file is missing, damaged, or of a kind that is not read (.png is not: it is no longer linear).
inline Image load_image(const std::filesystem::path& path) {
    const detail::ImageFormat format = detail::image_format(path);
    if (format == detail::ImageFormat::png)
        fail(detail::file_origin(path), "PNG is not read: it holds tone mapped values; use .exr, .hdr or .pfm");
    const std::string bytes = read_file(path, detail::max_image_bytes);
    switch (format) {
        case detail::ImageFormat::exr: return detail::decode_exr(bytes, path.string());
        case detail::ImageFormat::hdr: return detail::decode_rgbe(bytes, path.string());
        default: return detail::decode_pfm(bytes, path.string());
    }
}

/// Reads a layer of an .exr file: its channels R, G and B, or X, Y and Z, or, as grey, its only one. Throws `Error` as
/// `load_image` does, and when there is no such layer.
inline Image load_layer(const std::filesystem::path& path, const std::string& name) {
    if (!can_hold_layers(path)) fail(detail::file_origin(path), "only .exr files hold layers");
    if (name.empty()) fail(detail::file_origin(path), "the layer to read has no name");
    return detail::decode_exr(read_file(path, detail::max_image_bytes), path.string(), name);
}

}  // namespace lightswitch
