#pragma once

// Methods whose error is known: a grey image and normal noise, independent in every pixel, channel and iteration.

#include <lightswitch/sweep/contender.hpp>

#include <chrono>
#include <memory>
#include <random>
#include <thread>
#include <utility>

namespace lightswitch::test {

struct Fake {
    std::string name = "fake";
    float noise = 0.2f;  ///< standard deviation of one iteration
    float level = 1;
    Kind kind = Kind::unbiased;
    double seconds = 0, preparation = 0;  ///< of an iteration, and before the first
    /// One pixel in so many shows all the light, the others none; 0: all show it.
    float rarity = 0;
    int side = 24;
    /// Added to every pixel and divided by the number of iterations: the bias of a consistent method.
    float bias = 0;
    PathClasses missing = {};
};

namespace detail {

struct FakeSession {
    Fake fake;
    std::mt19937 random;
    Film film{fake.side, fake.side};
    RenderStatistics statistics{};
    Settings settings;

    FakeSession(const Fake& f, const Settings& s) : fake(f), random(static_cast<unsigned>(s.seed)), settings(s) {
        wait(fake.preparation);
    }

    static void wait(double seconds) {
        if (seconds > 0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    }

    void run(const Budget& budget, const std::stop_token& stop) {
        while (film.iterations() < static_cast<std::uint64_t>(budget.samples) && !stop.stop_requested()) {
            std::normal_distribution<float> normal(0, fake.noise);
            std::uniform_real_distribution<float> uniform;
            const double n = double(film.iterations());
            for (std::size_t i = 0; i < film.area(); ++i)
                for (int c = 0; c < 3; ++c) {
                    const float shown = fake.rarity > 0 ? (uniform(random) * fake.rarity < 1 ? fake.rarity : 0) : 1;
                    // Such that the mean of n iterations is off by bias / n.
                    film.slot(i)[c] = fake.level * shown + normal(random) + (n == 0 ? fake.bias : 0);
                }
            wait(fake.seconds);
            film.commit(SerialExecutor{});
            ++statistics.iterations;
            statistics.counts.rays += film.area();
            if (settings.observer) settings.observer({.iterations = film.iterations(), .film = film});
        }
    }
};

}  // namespace detail

inline Contender contender_of(const Fake& fake) {
    return {fake.name, fake.kind, fake.missing, [fake](const Settings& settings) {
                const auto session = std::make_shared<detail::FakeSession>(fake, settings);
                return lightswitch::detail::AnySession{
                    [session](const Budget& budget, const std::stop_token& stop) { session->run(budget, stop); },
                    [session]() -> const Film& { return session->film; },
                    [session]() -> const RenderStatistics& { return session->statistics; },
                    [session] { return session->film.image(); }};
            }};
}

}  // namespace lightswitch::test
