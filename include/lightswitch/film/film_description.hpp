#pragma once

#include <lightswitch/core/error.hpp>
#include <lightswitch/film/filter.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightswitch {

/// Size of the image and how samples become pixels.
struct FilmDescription {
    int width = 256, height = 256;
    Filter filter = Filter::box();
    /// The image may be a part of a larger one, at this distance from its left and top, which has this size; a size of
    /// 0 is that of the image.
    int crop_x = 0, crop_y = 0, full_width = 0, full_height = 0;
    Origin origin;

    /// Width and height of the whole that the image is a part of.
    std::pair<int, int> full_size() const {
        return {full_width > 0 ? full_width : width, full_height > 0 ? full_height : height};
    }
    /// Gives the image another size. A part of a larger image stays about the same part.
    void resize(int new_width, int new_height) {
        const auto scale = [](int length, int from, int to) {
            return static_cast<int>(std::lround(double(length) * to / from));
        };
        if (full_width > 0) {
            crop_x = scale(crop_x, width, new_width);
            full_width = std::max(crop_x + new_width, scale(full_width, width, new_width));
        }
        if (full_height > 0) {
            crop_y = scale(crop_y, height, new_height);
            full_height = std::max(crop_y + new_height, scale(full_height, height, new_height));
        }
        width = new_width;
        height = new_height;
    }
    /// Makes the longer side at most that long, in pixels, and the other one in proportion.
    void shrink(int most) {
        const int side = std::max(width, height);
        if (side <= most) return;
        const auto scaled = [&](int length) {
            return std::max(1, static_cast<int>(std::lround(double(length) * most / side)));
        };
        resize(scaled(width), scaled(height));
    }
    double aspect() const { return static_cast<double>(full_size().first) / full_size().second; }
};

}  // namespace lightswitch
