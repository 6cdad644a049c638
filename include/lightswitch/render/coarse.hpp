#pragma once

#include <lightswitch/film/film_description.hpp>

#include <algorithm>

namespace lightswitch::detail {

/// How many times smaller than the film the next coarse picture is, when the last one was `last` times smaller (0:
/// there was none): the first takes about 50 ms, each further one has four times as many pixels. 1 when it is time for
/// the image itself. `seconds_per_pixel` may be 0, when it is not known.
inline int next_coarse(const FilmDescription& film, double seconds_per_pixel, int last) {
    constexpr double moment = 0.05, unknown = 2e-5;  // seconds; for a pixel
    const double seconds = double(film.width) * film.height * (seconds_per_pixel > 0 ? seconds_per_pixel : unknown);
    if (last > 0) return seconds > 3 * moment ? std::max(last / 2, 1) : 1;
    int divisor = 1;
    while (seconds > moment * divisor * divisor && 2 * divisor <= std::min(film.width, film.height)) divisor *= 2;
    return divisor;
}

}  // namespace lightswitch::detail
