#pragma once

// Smoothing at scales that double, and with it the undecimated wavelet transform that is called starlet.

#include <lightswitch/core/math.hpp>
#include <lightswitch/reconstruct/reconstructor.hpp>

#include <algorithm>
#include <vector>

namespace lightswitch::detail {

/// Values of type T, row by row.
template <class T>
struct Plane {
    int width = 0, height = 0;
    std::vector<T> values;

    Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h), T(0)) {}
    T* row(int y) { return values.data() + std::size_t(y) * std::size_t(width); }
    const T* row(int y) const { return values.data() + std::size_t(y) * std::size_t(width); }
};

/// The plane smoothed with the cubic B-spline's weights (1 4 6 4 1) / 16, `step` pixels apart, along both axes; beyond
/// an edge its pixels go on. Differences of images smoothed at steps 1, 2, 4, ... are the starlet transform (Starck,
/// Fadili and Murtagh 2007, "The Undecimated Wavelet Decomposition and its Reconstruction"). All weights are positive:
/// nothing cancels, whatever an outlier's size.
template <class T>
void smooth(const Plane<T>& in, int step, Plane<T>& between, Plane<T>& out, const Executor auto& executor) {
    const int width = in.width, height = in.height;
    const auto weigh = [](const T& far, const T& near, const T& centre) {
        return far * 0.0625f + near * 0.25f + centre * 0.375f;
    };
    const auto clamped = [](int i, int size) { return std::clamp(i, 0, size - 1); };
    for_each_row(height, executor, [&](int y) {
        const T* row[5];
        for (int i = 0; i < 5; ++i) row[i] = in.row(clamped(y + (i - 2) * step, height));
        T* to = between.row(y);
        for (int x = 0; x < width; ++x) to[x] = weigh(row[0][x] + row[4][x], row[1][x] + row[3][x], row[2][x]);
    });
    for_each_row(height, executor, [&](int y) {
        const T* row = between.row(y);
        T* to = out.row(y);
        const int left = std::min(2 * step, width), right = std::max(left, width - 2 * step);
        const auto at_edge = [&](int x) {
            to[x] = weigh(row[clamped(x - 2 * step, width)] + row[clamped(x + 2 * step, width)],
                          row[clamped(x - step, width)] + row[clamped(x + step, width)], row[x]);
        };
        for (int x = 0; x < left; ++x) at_edge(x);
        for (int x = left; x < right; ++x)
            to[x] = weigh(row[x - 2 * step] + row[x + 2 * step], row[x - step] + row[x + step], row[x]);
        for (int x = right; x < width; ++x) at_edge(x);
    });
}

/// The same, in place.
template <class T>
void smooth(Plane<T>& plane, int step, const Executor auto& executor) {
    Plane<T> between(plane.width, plane.height);
    smooth(plane, step, between, plane, executor);
}

}  // namespace lightswitch::detail
