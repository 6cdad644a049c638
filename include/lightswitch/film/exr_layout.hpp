#pragma once

// What an OpenEXR file says about itself, checked before any of it is trusted ("OpenEXR File Layout", openexr.com).

#include <lightswitch/film/bytes.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::detail {

inline constexpr std::string_view exr_magic = "v/1\x01";
/// Metadata are string attributes whose names begin so.
inline constexpr std::string_view exr_prefix = "lightswitch:";

enum class ExrType { uint32 = 0, half = 1, float32 = 2 };

struct ExrChannel {
    std::string name;
    ExrType type = ExrType::half;
};

/// A single-part scan line file, all sizes checked.
struct ExrLayout {
    std::vector<ExrChannel> channels;      ///< in the order in which they are stored
    int compression = -1;                  ///< 0 none, 1 RLE, 2 ZIPS, 3 ZIP, 4 PIZ
    int width = 0, height = 0;             ///< of the data window
    std::vector<std::string_view> chunks;  ///< by row from the top, each `rows_per_chunk()` high but the last
    std::array<int, 3> rgb{};              ///< positions of the channels that were asked for
    Image::Metadata metadata;

    int rows_per_chunk() const { return compression == 3 ? 16 : compression == 4 ? 32 : 1; }
    std::size_t pixel_bytes() const {
        std::size_t sum = 0;
        for (const ExrChannel& c : channels) sum += c.type == ExrType::half ? 2 : 4;
        return sum;
    }
    /// Position of a channel, or -1.
    int channel(std::string_view name) const {
        const auto it = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
        return it == channels.end() ? -1 : static_cast<int>(it - channels.begin());
    }
};

inline void read_exr_channels(ByteReader reader, ExrLayout& layout) {
    while (true) {
        ExrChannel channel;
        channel.name = reader.until('\0', 255);
        if (channel.name.empty()) return;
        const int type = reader.int32();
        reader.take(4);
        const int x_sampling = reader.int32(), y_sampling = reader.int32();
        if (type < 0 || type > 2) fail(reader.where(), "has a channel of unknown type");
        if (x_sampling != 1 || y_sampling != 1) fail(reader.where(), "has subsampled channels, which are not read");
        if (layout.channels.size() == 64) fail(reader.where(), "has more than 64 channels");
        channel.type = static_cast<ExrType>(type);
        layout.channels.push_back(std::move(channel));
    }
}

/// The positions of R, G and B, or of a layer's R, G and B, or X, Y and Z, or its only channel three times. Throws
/// `Error` when there are none, or when they hold integers.
inline std::array<int, 3> find_exr_channels(const Origin& where, const ExrLayout& layout, std::string_view layer) {
    const std::string prefix = layer.empty() ? std::string() : std::string(layer) + ".";
    const auto all_of = [&](const std::array<const char*, 3>& names) {
        return std::array{layout.channel(prefix + names[0]), layout.channel(prefix + names[1]),
                          layout.channel(prefix + names[2])};
    };
    const auto complete = [](const std::array<int, 3>& found) {
        return *std::min_element(begin(found), end(found)) >= 0;
    };
    std::array<int, 3> found = all_of({"R", "G", "B"});
    if (!layer.empty() && !complete(found)) {
        found = all_of({"X", "Y", "Z"});
        const auto belongs = [&](const ExrChannel& c) { return c.name.starts_with(prefix); };
        if (!complete(found) && std::count_if(layout.channels.begin(), layout.channels.end(), belongs) == 1) {
            const auto only = std::find_if(layout.channels.begin(), layout.channels.end(), belongs);
            found.fill(static_cast<int>(only - layout.channels.begin()));
        }
    }
    if (!complete(found)) {
        std::string names;
        for (const ExrChannel& c : layout.channels) names += (names.empty() ? "" : ", ") + c.name;
        fail(where, (layer.empty() ? "has no channels R, G and B" : "has no layer '" + std::string(layer) + "'") +
                        " (it has: " + names.substr(0, 200) + ")");
    }
    for (const int i : found)
        if (layout.channels[static_cast<std::size_t>(i)].type == ExrType::uint32)
            fail(where, "has integer colour channels; 16 or 32-bit floating point is needed");
    return found;
}

/// The fields in a PIZ chunk by which a decoder finds its way: a bitmap of the values in use, then Huffman data.
inline void check_piz_chunk(const Origin& where, std::string_view chunk) {
    ByteReader reader(chunk, where.file);
    const int lowest = reader.number<std::uint16_t>(), highest = reader.number<std::uint16_t>();
    if (highest >= 8192) fail(where, "has a damaged PIZ chunk");
    if (lowest <= highest) reader.take(static_cast<std::size_t>(highest - lowest + 1));
    const auto length = reader.number<std::uint32_t>();
    if (length < 20 || length > reader.remaining()) fail(where, "has a damaged PIZ chunk");
    const auto first = reader.number<std::uint32_t>(), last = reader.number<std::uint32_t>();
    reader.take(4);
    const auto bits = reader.number<std::uint32_t>();
    if (first > last || last > 65536 || bits > 8ull * (length - 20)) fail(where, "has a damaged PIZ chunk");
}

/// Finds every chunk and makes sure that they cover the image exactly once and that none promises more than
/// compression can hold, so that decoding takes memory in proportion to the file.
inline void read_exr_chunks(ByteReader& reader, ExrLayout& layout, long long top) {
    const int rows = layout.rows_per_chunk();
    const auto count = static_cast<std::size_t>((layout.height + rows - 1) / rows);
    layout.chunks.resize(std::min(count, reader.remaining() / 8));
    if (layout.chunks.size() < count) reader.truncated();
    for (std::size_t i = 0; i < count; ++i) {
        const auto offset = reader.number<std::uint64_t>();
        const std::size_t next = reader.position();
        if (offset == 0) fail(reader.where(), "is incomplete: it was not written to its end");
        reader.seek(offset);
        const long long row = reader.int32() - top;
        const std::string_view chunk = reader.take(reader.number<std::uint32_t>());
        if (row < 0 || row >= layout.height || row % rows != 0 || chunk.empty() ||
            !layout.chunks[static_cast<std::size_t>(row / rows)].empty())
            fail(reader.where(), "is damaged: its pieces do not make up the image");
        const auto height = static_cast<std::size_t>(std::min<long long>(rows, layout.height - row));
        const std::size_t size = layout.pixel_bytes() * static_cast<std::size_t>(layout.width) * height;
        // Deflate reaches 1 : 1032, PIZ and RLE less.
        if (chunk.size() > size || chunk.size() < size / 2048 || (layout.compression == 0 && chunk.size() != size))
            fail(reader.where(), "is damaged: a piece of the image has an impossible size");
        if (layout.compression == 4 && chunk.size() != size) check_piz_chunk(reader.where(), chunk);
        layout.chunks[static_cast<std::size_t>(row / rows)] = chunk;
        reader.seek(next);
    }
}

/// Takes an OpenEXR file apart; the views point into `bytes`. The image is the data window; the display window is not
/// looked at. Throws `Error` for damage and for whatever is not a plain RGB image: deep, tiled, multi-part,
/// subsampled, without R, G and B (or without that layer), or compressed with loss.
inline ExrLayout read_exr_layout(std::string_view bytes, const std::string& file, std::string_view layer = {}) {
    ByteReader reader(bytes, file);
    const Origin& where = reader.where();
    if (bytes.substr(0, 4) != exr_magic) fail(where, "is not an OpenEXR file");
    reader.take(4);
    const auto version = reader.number<std::uint32_t>();
    if ((version & 0xff) != 2) fail(where, "is an OpenEXR file of an unknown version");
    if ((version & 0x1800) != 0) fail(where, "is a deep or multi-part OpenEXR file, which is not read");
    if ((version & 0x200) != 0) fail(where, "is a tiled OpenEXR file, which is not read; store it as scan lines");

    ExrLayout layout;
    std::array<long long, 4> window{0, 0, -1, -1};
    while (true) {
        const std::string name(reader.until('\0', 255));
        if (name.empty()) break;
        const std::string_view type = reader.until('\0', 255);
        const std::string_view value = reader.take(reader.number<std::uint32_t>());
        ByteReader attribute(value, file);
        if (name == "channels") {
            read_exr_channels(attribute, layout);
        } else if (name == "compression") {
            layout.compression = attribute.number<std::uint8_t>();
        } else if (name == "dataWindow") {
            for (long long& side : window) side = attribute.int32();
        } else if (type == "string" && name.starts_with(exr_prefix)) {
            layout.metadata[name.substr(exr_prefix.size())] = value;
        }
    }
    const long long width = window[2] - window[0] + 1, height = window[3] - window[1] + 1;
    check_size(where, width, height);
    layout.width = static_cast<int>(width);
    layout.height = static_cast<int>(height);
    layout.rgb = find_exr_channels(where, layout, layer);
    if (width * height * static_cast<long long>(layout.channels.size()) > 4 * Image::max_area)
        fail(where, "has too many channels for its size");
    constexpr std::array lossy{"PXR24", "B44", "B44A", "DWAA", "DWAB"};
    if (layout.compression < 0 || layout.compression > 4)
        fail(where, "is compressed with " +
                        (layout.compression >= 5 && layout.compression <= 9
                             ? std::string(lossy[static_cast<std::size_t>(layout.compression - 5)])
                             : "an unknown method") +
                        ", which is not read; store it with ZIP or PIZ");
    read_exr_chunks(reader, layout, window[1]);
    return layout;
}

}  // namespace lightswitch::detail
