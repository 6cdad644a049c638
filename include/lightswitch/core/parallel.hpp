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

#include <concepts>
#include <cstddef>
#include <memory>

namespace lightswitch {

/// Calls `unit(i)` once for every i in [0, n), in any order and on any threads, and returns when all are done. An exception
/// from a unit is rethrown to the caller.
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

/// oneTBB with a given number of threads (0: as many as the machine has). May be more than the machine has.
class TbbExecutor {
public:
    explicit TbbExecutor(int threads = 0)
        : arena_(std::make_unique<tbb::task_arena>(threads > 0 ? threads : int{tbb::task_arena::automatic})),
          // oneTBB starts no more threads than the machine has unless it is told to.
          oversubscribe_(threads > tbb::info::default_concurrency()
                             ? std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                     static_cast<std::size_t>(threads))
                             : nullptr) {}

    void for_each(std::size_t n, const auto& unit) const {
        arena_->execute([&] {
            tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) { unit(i); }, tbb::simple_partitioner{});
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
