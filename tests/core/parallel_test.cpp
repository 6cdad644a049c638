#include <lightswitch/core/parallel.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace lightswitch;

static_assert(Executor<SerialExecutor> && Executor<TbbExecutor>);

TEST_CASE("parallel: every unit runs exactly once, for any number of threads") {
    const auto check = [](const auto& executor) {
        for (const std::size_t n :
             {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{1000}, std::size_t{100000}}) {
            std::vector<std::atomic<int>> runs(n);
            executor.for_each(n, [&](std::size_t i) { ++runs[i]; });
            std::size_t wrong = 0;
            for (const auto& count : runs) wrong += count != 1;
            CHECK(wrong == 0);
        }
    };
    check(SerialExecutor{});
    for (const int threads : {1, 2, 8}) {
        const TbbExecutor executor(threads);
        CHECK(executor.threads() == threads);
        check(executor);
    }
    check(TbbExecutor{});
    CHECK(TbbExecutor{}.threads() >= 1);
    CHECK(SerialExecutor{}.threads() == 1);
}

TEST_CASE("parallel: no more units at a time than threads, and more threads than processors when asked") {
    for (const int threads : {1, 2, 8}) {
        const TbbExecutor executor(threads);
        const int wanted = std::min(threads, tbb::info::default_concurrency() + 1);
        // A busy machine may start its threads late: units stay until enough of them have met, for ten seconds at most.
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        std::atomic<int> now = 0, most = 0;
        executor.for_each(64, [&](std::size_t) {
            const int running = ++now;
            for (int seen = most; seen < running && !most.compare_exchange_weak(seen, running);) {
            }
            do std::this_thread::sleep_for(std::chrono::milliseconds(1));
            while (most < wanted && std::chrono::steady_clock::now() < deadline);
            --now;
        });
        CHECK(most <= threads);
        CHECK(most >= wanted);
    }
}

TEST_CASE("parallel: an exception of a unit reaches the caller, and the executor works on") {
    const auto check = [](const auto& executor) {
        const auto one_fails = [](std::size_t i) {
            if (i == 37) throw std::runtime_error("unit 37");
        };
        CHECK_THROWS_WITH_AS(executor.for_each(100, one_fails), "unit 37", std::runtime_error);
        std::atomic<int> runs = 0;
        executor.for_each(100, [&](std::size_t) { ++runs; });
        CHECK(runs == 100);
    };
    check(SerialExecutor{});
    for (const int threads : {1, 2, 8}) check(TbbExecutor(threads));
}

TEST_CASE("parallel: units may start parallel work of their own") {
    const TbbExecutor executor(2);
    std::atomic<int> runs = 0;
    executor.for_each(10, [&](std::size_t) { executor.for_each(10, [&](std::size_t) { ++runs; }); });
    CHECK(runs == 100);
}

TEST_CASE("parallel: threads are counted by starting them, and none is left") {
    const int before = detail::own_threads();
    for (const int wanted : {0, 1, 5}) CHECK(detail::startable_threads(wanted) == wanted);
    CHECK(detail::own_threads() <= before);
    CHECK(detail::allow_threads(3) == 3);
    CHECK(detail::allow_threads(1) == 1);
}

#if defined(__SSE2__)
TEST_CASE("parallel: denormal numbers are zero while the guard lives, and what was set before comes back") {
    volatile float small = std::numeric_limits<float>::min();
    volatile float half = 0.5f;
    // Without the lowest six bits: they record what happened, and are no settings.
    const auto settings = [] { return _mm_getcsr() & ~0x3fu; };
    const unsigned before = settings();
    REQUIRE(small * half > 0);
    {
        const FlushDenormals guard;
        CHECK(settings() == (before | 0x8040u));
        CHECK(small * half == 0);
        { const FlushDenormals inner; }
        CHECK(small * half == 0);
    }
    CHECK(settings() == before);
    CHECK(small * half > 0);
    try {
        const FlushDenormals guard;
        throw 1;
    } catch (int) {
    }
    CHECK(settings() == before);
}
#endif
