#pragma once

// Several images side by side on one sheet, each with its caption.

#include <lightswitch/compare/label.hpp>
#include <lightswitch/film/image.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace lightswitch {

/// An image on a sheet. False-colour pictures stand beside renderings with exposure 0 of their own.
struct Tile {
    std::string label{};  ///< ASCII, drawn below; cut with "..." when wider than the cell
    Image image{};        ///< linear
    float exposure = 0;   ///< in stops, see `expose`
};

/// How `montage` lays out its sheet. Lengths are in pixels.
struct MontageOptions {
    int columns = 0;      ///< 0 makes the sheet about as wide as it is high
    int gap = 8;          ///< between tiles and around them
    int letter_size = 0;  ///< pixels per dot of the captions; 0 chooses by the width of a tile
};

/// A sheet with the tiles in reading order, on white; every cell is as large as the largest tile.
///
/// Each tile is exposed and clamped to [0,1] but stays linear, so saving the sheet as PNG at exposure 0 shows every
/// tile as saving it alone at its own exposure would. Throws `Error` when there is no tile, a tile is empty, an option
/// is out of range, or the sheet would be too large for an image.
inline Image montage(std::span<const Tile> tiles, const MontageOptions& options = {}) {
    if (tiles.empty()) throw Error("a montage needs at least one image");
    if (options.columns < 0 || options.gap < 0 || options.gap > 4096 || options.letter_size < 0 ||
        options.letter_size > 64)
        throw Error("montage: columns, gap and letter_size must not be negative or huge");
    int cell_width = 0, cell_height = 0;
    for (const Tile& tile : tiles) {
        if (tile.image.empty()) throw Error("montage: the image '" + tile.label + "' has no pixels");
        cell_width = std::max(cell_width, tile.image.width());
        cell_height = std::max(cell_height, tile.image.height());
    }
    const int count = static_cast<int>(std::min<std::size_t>(tiles.size(), 1 << 20));
    const double square = std::ceil(std::sqrt(static_cast<double>(count) * cell_height / cell_width));
    const int columns = std::min(count, options.columns > 0 ? options.columns : std::max(1, static_cast<int>(square)));
    const int rows = (count + columns - 1) / columns;
    const int dot = options.letter_size > 0 ? options.letter_size : std::max(1, cell_width / 200);
    const int caption = (glyph_height + 4) * dot;

    const long long width = options.gap + static_cast<long long>(columns) * (cell_width + options.gap);
    const long long height = options.gap + static_cast<long long>(rows) * (cell_height + caption + options.gap);
    Image::check_size(width, height);
    Image sheet(static_cast<int>(width), static_cast<int>(height));
    fill_rectangle(sheet, 0, 0, sheet.width(), sheet.height(), srgb(255, 255, 255));
    for (int i = 0; i < count; ++i) {
        const Tile& tile = tiles[static_cast<std::size_t>(i)];
        const int left = options.gap + i % columns * (cell_width + options.gap);
        const int top = options.gap + i / columns * (cell_height + caption + options.gap);
        Image exposed = tile.image;
        for (Rgb& pixel : exposed.pixels()) pixel = expose(pixel, tile.exposure);
        paste(sheet, left + (cell_width - exposed.width()) / 2, top, exposed);

        std::string label = tile.label;
        const auto room = static_cast<std::size_t>((cell_width / dot + 1) / glyph_advance);
        if (label.size() > room) label = room > 3 ? label.substr(0, room - 3) + "..." : label.substr(0, room);
        draw_text(sheet, left + (cell_width - text_width(label, dot)) / 2, top + exposed.height() + 3 * dot, label,
                  srgb(20, 20, 20), dot);
    }
    return sheet;
}

}  // namespace lightswitch
