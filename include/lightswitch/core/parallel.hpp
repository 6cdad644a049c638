#pragma once

// Running independent work units on several threads.

#include <lightswitch/core/floating_point.hpp>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <atomic>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace lightswitch {

/// Calls `unit(i)` once for every i in [0, n), in any order and on any threads, and returns when all are done. An
/// exception from a unit is rethrown to the caller.
template <class E>
concept Executor = requires(const E& executor, std::size_t n, void (*unit)(std::size_t)) {
    executor.for_each(n, unit);
    { executor.threads() } -> std::convertible_to<int>;
};

/// Everything on the calling thread, in order.
struct SerialExecutor {
    void for_each(std::size_t n, const auto& unit) const {
        for (std::size_t i = 0; i < n; ++i) unit(i);
    }
    int threads() const { return 1; }
};

namespace detail {

/// How many threads this process has, where the system tells (Linux); 0 elsewhere.
inline int own_threads() {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/status", "r"), &std::fclose);
    int count = 0;
    for (char line[256]; file && count == 0 && std::fgets(line, sizeof line, file.get());)
        if (std::sscanf(line, "Threads: %d", &count) != 1) count = 0;
    return count;
}

/// How many threads, of at most `wanted`, the system lets this process start now: by starting them. They have ended
/// when it returns.
inline int startable_threads(int wanted) {
    const int before = own_threads();
    std::atomic<bool> counted = false;
    std::vector<std::thread> threads;
    try {
        threads.reserve(static_cast<std::size_t>(std::max(wanted, 0)));
        while (static_cast<int>(threads.size()) < wanted) threads.emplace_back([&] { counted.wait(false); });
    } catch (const std::exception&) {  // a limit is reached, of processes or of memory
    }
    counted = true;
    counted.notify_all();
    for (std::thread& thread : threads) thread.join();
    // For a moment the system still counts what has been joined.
    for (int wait = 0; wait < 100 && own_threads() > before; ++wait)
        std::this_thread::sleep_for(std::chrono::microseconds(10 << std::min(wait, 7)));
    return static_cast<int>(threads.size());
}

/// How many threads, the caller's among them and of at most `wanted`, oneTBB may run. It starts its threads out of one
/// another and ends the process when one cannot be started, so they are counted first; where there are too few, oneTBB
/// asks for no more from then on. One more is left for the program's own use.
inline int allow_threads(int wanted) {
    struct Supply {
        std::mutex mutex;
        int assured = 1;
        std::unique_ptr<tbb::global_control> limit;
    };
    static Supply& supply =
        *new Supply;  // never destroyed: without the limit oneTBB would start threads at the very end
    constexpr int spare = 1;
    const std::lock_guard lock(supply.mutex);
    if (wanted > supply.assured && !supply.limit) {
        supply.assured = std::max(supply.assured, 1 + startable_threads(wanted - 1 + spare) - spare);
        if (supply.assured < wanted)
            supply.limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                 static_cast<std::size_t>(supply.assured));
    }
    return std::min(wanted, supply.assured);
}

}  // namespace detail

/// oneTBB with a given number of threads (0: as many as the machine has). May be more than the machine has; fewer are
/// used where the system does not let the process start so many.
class TbbExecutor {
public:
    explicit TbbExecutor(int threads = 0) {
        const int machine = tbb::info::default_concurrency();
        const int allowed = detail::allow_threads(threads > 0 ? threads : machine);
        arena_ = std::make_unique<tbb::task_arena>(allowed);
        // oneTBB starts no more threads than the machine has unless it is told to.
        if (allowed > machine)
            oversubscribe_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                   static_cast<std::size_t>(allowed));
    }

    void for_each(std::size_t n, const auto& unit) const {
        arena_->execute([&] {
            tbb::parallel_for(
                std::size_t{0}, n, [&](std::size_t i) { unit(i); }, tbb::simple_partitioner{});
        });
    }
    int threads() const { return arena_->max_concurrency(); }

private:
    std::unique_ptr<tbb::task_arena> arena_;
    std::unique_ptr<tbb::global_control> oversubscribe_;
};

/// While it lives, the calling thread treats denormal numbers as zero: they are slow and Embree asks for it.
class FlushDenormals {
public:
#if defined(__SSE2__)
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned saved_;
#endif
};

}  // namespace lightswitch
