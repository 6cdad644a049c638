#pragma once

// How a sample came about, in words: a row for each event.

#include <lightswitch/render/path_event.hpp>

#include <string>

namespace lightswitch::program {

/// "(1, 2, 3)", to six digits.
std::string text_of(const DVec3& v);
inline std::string text_of(const Rgb& v) { return text_of(DVec3(v)); }

/// The columns of a listing. Vertices of camera paths are z0, z1, ..., those of light paths y0, y1, ...
struct ReplayRow {
    std::string vertex, what, first, second, rest;
};

/// `sum` is that of the contributions to the same sample, with this one.
ReplayRow replay_row(const PathEvent& event, const Rgb& sum);

}  // namespace lightswitch::program
