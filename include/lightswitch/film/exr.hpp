#pragma once

// OpenEXR images, through tinyexr where the build has it (LIGHTSWITCH_HAS_EXR is 1 and tinyexr is linked).

#include <lightswitch/film/exr_layout.hpp>
#include <lightswitch/film/layer.hpp>

#include <span>
#include <string>
#include <string_view>

#if LIGHTSWITCH_HAS_EXR
#include <tinyexr.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>
#endif

namespace lightswitch::detail {

#if LIGHTSWITCH_HAS_EXR

inline constexpr bool has_exr = true;

/// Throws the error that a tinyexr call reported through its last argument, and frees it.
[[noreturn]] inline void fail_exr(const Origin& where, const char* message) {
    std::string text = message ? message : "unknown error";
    if (message) FreeEXRErrorMessage(message);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    fail(where, "tinyexr: " + text);
}

inline void put_exr_attribute(std::string& out, std::string_view name, std::string_view type, std::string_view value) {
    out.append(name).append(1, '\0').append(type).append(1, '\0');
    put_little_endian(out, static_cast<std::uint32_t>(value.size()));
    out.append(value);
}

/// The same image as a plain file of our own making: only the attributes that a decoder needs, the data window at
/// (0, 0), rows in increasing order. Whatever else a hostile header holds never reaches the decoder.
inline std::string plain_exr(const ExrLayout& layout) {
    std::string channels;
    for (std::size_t i = 0; i < layout.channels.size(); ++i) {
        channels += {'c', static_cast<char>('0' + i / 10), static_cast<char>('0' + i % 10), '\0'};
        for (const std::uint32_t word : {static_cast<std::uint32_t>(layout.channels[i].type), 0u, 1u, 1u})
            put_little_endian(channels, word);
    }
    channels += '\0';
    std::string window;
    for (const int side : {0, 0, layout.width - 1, layout.height - 1})
        put_little_endian(window, static_cast<std::uint32_t>(side));
    const std::string_view one("\0\0\x80\x3f", 4), zeros("\0\0\0\0\0\0\0\0", 8);

    std::string out(exr_magic);
    put_little_endian(out, std::uint32_t{2});
    put_exr_attribute(out, "channels", "chlist", channels);
    put_exr_attribute(out, "compression", "compression", std::string(1, static_cast<char>(layout.compression)));
    put_exr_attribute(out, "dataWindow", "box2i", window);
    put_exr_attribute(out, "displayWindow", "box2i", window);
    put_exr_attribute(out, "lineOrder", "lineOrder", zeros.substr(0, 1));
    put_exr_attribute(out, "pixelAspectRatio", "float", one);
    put_exr_attribute(out, "screenWindowCenter", "v2f", zeros);
    put_exr_attribute(out, "screenWindowWidth", "float", one);
    out += '\0';
    std::uint64_t offset = out.size() + 8 * layout.chunks.size();
    for (const std::string_view chunk : layout.chunks) {
        put_little_endian(out, offset);
        offset += 8 + chunk.size();
    }
    std::uint32_t row = 0;
    for (const std::string_view chunk : layout.chunks) {
        put_little_endian(out, row);
        put_little_endian(out, static_cast<std::uint32_t>(chunk.size()));
        out.append(chunk);
        row += static_cast<std::uint32_t>(layout.rows_per_chunk());
    }
    return out;
}

/// Reads the channels R, G and B of a scan line file, or those of a layer (`find_exr_channels`), 16 or 32 bits,
/// uncompressed or RLE, ZIP, ZIPS, PIZ. Only ZIP and ZIPS carry a checksum: damage to the values themselves can pass
/// unnoticed in the others.
inline Image decode_exr(std::string_view bytes, const std::string& file, std::string_view layer = {}) {
    const Origin where = file_origin(file);
    const ExrLayout layout = read_exr_layout(bytes, file, layer);
    std::string plain = plain_exr(layout);
    const std::size_t size = plain.size();
    plain.append(64, '\0');  // tinyexr's Huffman decoder looks past the end of damaged chunks
    const auto* data = reinterpret_cast<const unsigned char*>(plain.data());

    struct Decoded {
        EXRHeader header;
        EXRImage image;
        Decoded() {
            InitEXRHeader(&header);
            InitEXRImage(&image);
        }
        ~Decoded() {
            FreeEXRImage(&image);
            FreeEXRHeader(&header);
        }
        Decoded(const Decoded&) = delete;
        Decoded& operator=(const Decoded&) = delete;
    } exr;
    const char* message = nullptr;
    EXRVersion version;
    if (ParseEXRVersionFromMemory(&version, data, size) != TINYEXR_SUCCESS ||
        ParseEXRHeaderFromMemory(&exr.header, &version, data, size, &message) != TINYEXR_SUCCESS)
        fail_exr(where, message);
    for (int i = 0; i < exr.header.num_channels; ++i)
        if (exr.header.pixel_types[i] == TINYEXR_PIXELTYPE_HALF)
            exr.header.requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;
    exr.image.num_channels = exr.header.num_channels;  // tinyexr sets it at the end only, and leaks planes without it
    if (LoadEXRImageFromMemory(&exr.image, &exr.header, data, size, &message) != TINYEXR_SUCCESS) {
        InitEXRImage(&exr.image);  // what it held is freed already, but the pointers are left in it
        fail_exr(where, message);
    }

    Image image(layout.width, layout.height);
    for (int c = 0; c < 3; ++c) {
        const unsigned char* plane = exr.image.images[layout.rgb[static_cast<std::size_t>(c)]];
        for (Rgb& pixel : image.pixels()) {
            std::memcpy(&pixel[c], plane, sizeof(float));
            plane += sizeof(float);
        }
    }
    image.metadata = layout.metadata;
    return image;
}

/// One channel of a file that is written.
struct ExrPlane {
    std::string name;
    std::vector<float> values;

    ExrPlane(std::string plane_name, const Image& image, int component) : name(std::move(plane_name)) {
        values.reserve(image.pixels().size());
        for (const Rgb& pixel : image.pixels()) values.push_back(pixel[component]);
    }
};

/// All channels of the image and its layers, by name, as the format has them.
inline std::vector<ExrPlane> exr_planes(const Image& image, std::span<const Layer> layers, const Origin& where) {
    std::vector<ExrPlane> planes;
    for (int c = 0; c < 3; ++c) planes.emplace_back(std::string(1, "RGB"[c]), image, c);
    for (const Layer& layer : layers) {
        const auto refuse = [&](const std::string& why) {
            fail(where, "the layer '" + layer.name.substr(0, 40) + "' " + why);
        };
        if (layer.name.empty() || layer.name.size() > 200 || layer.name.find('\0') != std::string::npos)
            refuse("needs another name");
        if (layer.channels.empty() || layer.channels.size() > 3) refuse("must have one to three channels");
        if (layer.image.width() != image.width() || layer.image.height() != image.height())
            refuse("has not the size of the image");
        for (std::size_t c = 0; c < layer.channels.size(); ++c)
            planes.emplace_back(layer.name + '.' + layer.channels[c], layer.image, static_cast<int>(c));
    }
    std::sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    const auto same = [](const ExrPlane& a, const ExrPlane& b) { return a.name == b.name; };
    const auto twice = std::adjacent_find(planes.begin(), planes.end(), same);
    if (twice != planes.end()) fail(where, "would have the channel " + twice->name + " twice");
    return planes;
}

/// The image as 32-bit floats B, G, R, and its layers likewise, ZIP compressed; metadata as string attributes.
/// Bit-exact.
inline std::string encode_exr(const Image& image, const std::string& file, std::span<const Layer> layers = {}) {
    const Origin where = file_origin(file);
    std::vector<ExrPlane> planes = exr_planes(image, layers, where);
    std::vector<unsigned char*> plane_pointers;
    std::vector<EXRChannelInfo> channels(planes.size());
    std::vector<int> types(planes.size(), TINYEXR_PIXELTYPE_FLOAT);
    bool long_names = false;
    for (std::size_t c = 0; c < planes.size(); ++c) {
        plane_pointers.push_back(reinterpret_cast<unsigned char*>(planes[c].values.data()));
        planes[c].name.copy(channels[c].name, sizeof channels[c].name - 1);
        long_names = long_names || planes[c].name.size() > 31;
    }

    std::vector<EXRAttribute> attributes;
    for (const auto& [key, value] : image.metadata) {
        const std::string name = std::string(exr_prefix) + key;
        EXRAttribute attribute{};
        if (key.empty() || key.find('\0') != std::string::npos || name.size() >= sizeof attribute.name)
            fail(where, "the metadata key '" + key.substr(0, 40) + "' cannot be an OpenEXR attribute name");
        std::memcpy(attribute.name, name.data(), name.size());
        std::memcpy(attribute.type, "string", 6);
        attribute.value = reinterpret_cast<unsigned char*>(const_cast<char*>(value.data()));  // only read
        attribute.size = static_cast<int>(value.size());
        attributes.push_back(attribute);
        long_names = long_names || name.size() > 31;
    }

    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = static_cast<int>(planes.size());
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    header.num_custom_attributes = static_cast<int>(attributes.size());
    header.custom_attributes = attributes.data();
    EXRImage pixels;
    InitEXRImage(&pixels);
    pixels.num_channels = static_cast<int>(planes.size());
    pixels.images = plane_pointers.data();
    pixels.width = image.width();
    pixels.height = image.height();

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&pixels, &header, &memory, &message);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(memory, &std::free);
    if (size == 0) fail_exr(where, message);
    if (long_names) memory[5] |= 4;  // the version field's flag for names of more than 31 characters
    return {reinterpret_cast<const char*>(memory), size};
}

#else

inline constexpr bool has_exr = false;

[[noreturn]] inline Image decode_exr(std::string_view, const std::string& file, std::string_view = {}) {
    fail(file_origin(file), "this program was built without OpenEXR: build it with tinyexr, or use .pfm");
}

[[noreturn]] inline std::string encode_exr(const Image&, const std::string& file, std::span<const Layer> = {}) {
    fail(file_origin(file), "this program was built without OpenEXR: build it with tinyexr, or use .pfm");
}

#endif

}  // namespace lightswitch::detail
