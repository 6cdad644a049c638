#pragma once

// Radiance pictures (.hdr): three 8-bit mantissas with a common exponent (Ward, "Real Pixels", Graphics Gems II, 1991).

#include <lightswitch/film/bytes.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <locale>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace lightswitch::detail {

using Rgbe = std::array<std::uint8_t, 4>;

/// The nearest RGBE value: the largest channel keeps 8 bits, the others as many as remain beside it. Negative values
/// and NaN become 0; values beyond the format (255 * 2^119, about 1.7e38) and infinities become its largest.
inline Rgbe to_rgbe(const Rgb& color) {
    constexpr float largest = 0x1.fep126f;
    Rgb c;
    for (int i = 0; i < 3; ++i) c[i] = color[i] > 0 ? std::min(color[i], largest) : 0.0f;
    for (int i = 0; i < 3; ++i)
        if (is_nan(color[i])) c[i] = 0;
    int exponent = 0;
    std::frexp(max_component(c), &exponent);
    const auto mantissa = [&](float value) { return static_cast<int>(std::ldexp(value, 8 - exponent) + 0.5f); };
    if (mantissa(max_component(c)) > 255) ++exponent;
    if (exponent <= -128) return {0, 0, 0, 0};  // below the smallest exponent: black
    const auto byte = [&](float value) { return static_cast<std::uint8_t>(mantissa(value)); };
    return {byte(c.x), byte(c.y), byte(c.z), static_cast<std::uint8_t>(exponent + 128)};
}

inline Rgb from_rgbe(const Rgbe& v) {
    if (v[3] == 0) return Rgb(0);
    const float unit = std::ldexp(1.0f, v[3] - 136);
    return unit * Rgb(v[0], v[1], v[2]);
}

/// Appends one byte plane of a row: runs of at least four equal bytes as (128 + length, byte), the rest as
/// (length, bytes).
inline void put_rgbe_runs(std::string& out, std::span<const std::uint8_t> row) {
    const auto run_at = [&](std::size_t i) {
        std::size_t n = 1;
        while (i + n < row.size() && n < 127 && row[i + n] == row[i]) ++n;
        return n;
    };
    for (std::size_t i = 0; i < row.size();) {
        if (const std::size_t run = run_at(i); run >= 4) {
            out += static_cast<char>(128 + run);
            out += static_cast<char>(row[i]);
            i += run;
            continue;
        }
        std::size_t n = 1;
        while (i + n < row.size() && n < 128 && run_at(i + n) < 4) ++n;
        out += static_cast<char>(n);
        for (const std::size_t end = i + n; i < end; ++i) out += static_cast<char>(row[i]);
    }
}

/// The image as a run-length encoded RGBE picture (see `to_rgbe`). Metadata become comment lines; line breaks in them
/// become blanks.
inline std::string encode_rgbe(const Image& image) {
    std::string out = "#?RADIANCE\n";
    for (const auto& [key, value] : image.metadata) {
        std::string line = "# lightswitch:" + key + "=" + value;
        std::replace_if(
            line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        out += line + "\n";
    }
    out += "FORMAT=32-bit_rle_rgbe\n\n";
    out += "-Y " + std::to_string(image.height()) + " +X " + std::to_string(image.width()) + "\n";

    const int width = image.width();
    const bool runs = width >= 8 && width < 32768;  // outside of this the format has flat rows only
    std::array<std::vector<std::uint8_t>, 4> planes;
    for (int y = 0; y < image.height(); ++y) {
        for (auto& plane : planes) plane.clear();
        for (int x = 0; x < width; ++x) {
            const Rgbe value = to_rgbe(image(x, y));
            for (std::size_t c = 0; c < 4; ++c) {
                if (runs) planes[c].push_back(value[c]);
                else out += static_cast<char>(value[c]);
            }
        }
        if (!runs) continue;
        out += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
        for (const auto& plane : planes) put_rgbe_runs(out, plane);
    }
    return out;
}

/// Reads a row whose four planes are run-length encoded one after the other.
inline void read_rgbe_planes(ByteReader& reader, std::span<Rgbe> row) {
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t x = 0; x < row.size();) {
            const std::size_t code = reader.number<std::uint8_t>();
            const bool run = code > 128;
            const std::size_t n = run ? code - 128 : code;
            if (n == 0 || n > row.size() - x) fail(reader.where(), "has a damaged run of pixels");
            const std::string_view bytes = reader.take(run ? 1 : n);
            for (std::size_t i = 0; i < n; ++i) row[x++][c] = static_cast<std::uint8_t>(bytes[run ? 0 : i]);
        }
}

/// Reads a row of whole pixels, in which (1, 1, 1, n) repeats the pixel before; successive repeats are the digits
/// of a count to base 256, least significant first.
inline void read_rgbe_pixels(ByteReader& reader, std::span<Rgbe> row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        const std::string_view bytes = reader.take(4);
        Rgbe value{};
        std::copy(bytes.begin(), bytes.end(), value.begin());
        if (value[0] != 1 || value[1] != 1 || value[2] != 1) {
            row[x++] = value;
            shift = 0;
            continue;
        }
        const std::size_t n = std::size_t{value[3]} << shift;
        if (x == 0 || shift > 16 || n > row.size() - x) fail(reader.where(), "has a damaged run of pixels");
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), n, row[x - 1]);
        x += n;
        shift += 8;
    }
}

/// Reads RGBE pictures, flat or run-length encoded in either way, rows from the top. A header's EXPOSURE is divided
/// out, so that pixels are radiance; comments written by `encode_rgbe` become metadata again. Throws `Error` for
/// anything else (XYZE, other orientations, damage).
inline Image decode_rgbe(std::string_view bytes, const std::string& file) {
    ByteReader reader(bytes, file);
    if (bytes.substr(0, 2) != "#?") fail(reader.where(), "is not a Radiance picture: it does not begin with '#?'");
    const auto parse = [&](std::string_view text, auto&... values) {
        std::istringstream stream{std::string(text)};
        stream.imbue(std::locale::classic());
        return static_cast<bool>((stream >> ... >> values));
    };

    Image::Metadata metadata;
    double exposure = 1;
    constexpr std::string_view comment = "# lightswitch:", format = "FORMAT=", exposed = "EXPOSURE=";
    for (std::string_view line; !(line = reader.until('\n', 65536)).empty();) {
        if (line.starts_with(comment)) {
            line.remove_prefix(comment.size());
            const std::size_t equals = std::min(line.find('='), line.size());
            metadata[std::string(line.substr(0, equals))] = line.substr(std::min(equals + 1, line.size()));
        } else if (line.starts_with(format) && line != "FORMAT=32-bit_rle_rgbe") {
            fail(reader.where(), "has pixels in another format than 32-bit_rle_rgbe, which is not read");
        } else if (line.starts_with(exposed)) {
            double factor = 0;
            if (!parse(line.substr(exposed.size()), factor) || !(factor > 1e-30 && factor < 1e30))
                fail(reader.where(), "has an EXPOSURE that is no positive number");
            exposure *= factor;
        }
    }

    long long width = 0, height = 0;
    std::string y_axis, x_axis;
    if (!parse(reader.until('\n', 200), y_axis, height, x_axis, width) || y_axis != "-Y" || x_axis != "+X")
        fail(reader.where(), "must state its size as '-Y <height> +X <width>': other orientations are not read");
    check_size(reader.where(), width, height);
    // Run lengths reach 127, so far fewer bytes than this cannot be a whole picture: checked before memory is taken.
    if (static_cast<std::size_t>(width * height) / 1024 > reader.remaining()) reader.truncated();

    Image image(static_cast<int>(width), static_cast<int>(height));
    std::vector<Rgbe> row(static_cast<std::size_t>(width));
    for (int y = 0; y < image.height(); ++y) {
        const std::size_t start = reader.position();
        const std::string_view marker = reader.take(4);
        const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(marker[i]); };
        if (width >= 8 && width < 32768 && at(0) == 2 && at(1) == 2 && at(2) < 128) {
            if (at(2) * 256 + at(3) != width) fail(reader.where(), "has a damaged row: its length is not the width");
            read_rgbe_planes(reader, row);
        } else {
            reader.seek(start);
            read_rgbe_pixels(reader, row);
        }
        const float factor = static_cast<float>(1 / exposure);
        for (int x = 0; x < image.width(); ++x) image(x, y) = factor * from_rgbe(row[static_cast<std::size_t>(x)]);
    }
    image.metadata = std::move(metadata);
    return image;
}

}  // namespace lightswitch::detail
