#pragma once

// Timing two pieces of work against each other: in turn, by the processor time of this thread, with the ratio taken
// pair by pair. A machine that slows down or is busy with other work then changes both alike.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace bench {

/// Processor seconds of this thread.
inline double now() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

inline double seconds_of(auto&& work) {
    const double begin = now();
    work();
    return now() - begin;
}

/// Median and the middle half of some figures.
struct Spread {
    double low, median, high;
    explicit Spread(std::vector<double> v) {
        std::sort(v.begin(), v.end());
        low = v[v.size() / 4];
        median = v[v.size() / 2];
        high = v[v.size() - 1 - v.size() / 4];
    }
};

/// Seconds of `a` and of `b`, and a / b.
struct Pairs {
    Spread a, b, ratio;
};

/// Runs a, b, a, b, ... `pairs` times after one warm-up each.
inline Pairs compare(int pairs, auto&& a, auto&& b) {
    a(), b();
    std::vector<double> seconds_a, seconds_b, ratio;
    for (int i = 0; i < pairs; ++i) {
        seconds_a.push_back(seconds_of(a));
        seconds_b.push_back(seconds_of(b));
        ratio.push_back(seconds_a.back() / seconds_b.back());
    }
    return {Spread(seconds_a), Spread(seconds_b), Spread(ratio)};
}

}  // namespace bench
