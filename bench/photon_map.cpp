// The photon map, HashGrid, against the k-d tree of nanoflann (where its header was found): building, and finding all
// photons within a radius.
//
//   photon_map [PHOTONS ...]     without arguments: 1e4 1e5 1e6 1e7
//
// Photons of 40 bytes and query points are spread at random over the walls of a box: the queries come in no order,
// which is the worst for caches. One thread; the two alternate; ratio: how many times as fast as the tree, in brackets
// the middle half of the pairs. growth: the exponent of time, in total for building and for one query, from the row
// for fewer photons. bytes: per photon; the tree's are without the photons. The last line is by wall-clock time.

#include <lightswitch/core/sampler.hpp>
#include <lightswitch/method/hash_grid.hpp>

#include <chrono>
#include <cstdlib>

#include "paired.hpp"

#ifdef LIGHTSWITCH_HAS_NANOFLANN
#include <nanoflann.hpp>
#endif

namespace {

namespace ls = lightswitch;

struct Photon {
    ls::Vec3 position, direction;
    ls::Rgb power;
    std::uint32_t depth;
};

std::vector<Photon> photons_on_walls(std::size_t n, std::uint64_t seed) {
    const ls::IterationPoints points(ls::Sampling::independent, seed, 0);
    std::vector<Photon> photons(n);
    for (std::size_t i = 0; i < n; ++i) {
        ls::Sampler sampler(points, 0, i);
        const ls::Vec2 u = sampler.next_2d() - 0.5f;
        const int wall = static_cast<int>(6 * sampler.next_1d());
        const float side = wall < 3 ? -0.5f : 0.5f;
        ls::Vec3& p = photons[i].position;
        p = wall % 3 == 0 ? ls::Vec3(side, u) : wall % 3 == 1 ? ls::Vec3(u.x, side, u.y) : ls::Vec3(u, side);
        photons[i].power = ls::Rgb(1);
    }
    return photons;
}

#ifdef LIGHTSWITCH_HAS_NANOFLANN

class Tree {
public:
    explicit Tree(const std::vector<Photon>& photons) : cloud_{photons}, index_(3, cloud_, leaf_size) {}
    void build() { index_.buildIndex(); }
    double bytes() { return double(index_.usedMemory(index_)); }

    void for_each_near(const ls::Vec3& at, float radius, auto&& fn) const {
        Visitor<std::remove_reference_t<decltype(fn)>> visitor{cloud_.photons, fn, radius * radius};
        index_.radiusSearchCustomCallback(&at.x, visitor);
    }

private:
    static constexpr std::size_t leaf_size = 32;  // the best for it of 10, 16 and 32

    // The names are nanoflann's.
    struct Cloud {
        const std::vector<Photon>& photons;
        std::size_t kdtree_get_point_count() const { return photons.size(); }
        float kdtree_get_pt(std::size_t i, std::size_t axis) const {
            return photons[i].position[static_cast<ls::Vec3::length_type>(axis)];
        }
        bool kdtree_get_bbox(auto&) const { return false; }
    };
    template <class Fn>
    struct Visitor {
        const std::vector<Photon>& photons;
        Fn& fn;
        float radius_squared;
        std::size_t count = 0;
        std::size_t size() const { return count; }
        bool full() const { return true; }
        bool addPoint(float distance_squared, std::size_t i) {
            if (distance_squared <= radius_squared) ++count, fn(photons[i]);
            return true;
        }
        float worstDist() const { return radius_squared; }
        void sort() const {}
    };

    Cloud cloud_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3> index_;
};

#else

/// In place of the tree: nothing to compare with.
struct Tree {
    explicit Tree(const std::vector<Photon>&) {}
    void build() {}
    double bytes() { return 0; }
    void for_each_near(const ls::Vec3&, float, auto&&) const {}
};

#endif

using Grid = ls::HashGrid<Photon>;
constexpr double targets[] = {10, 50};  // photons that a query is to find

float radius_for(std::size_t photons, double found) {
    return static_cast<float>(std::sqrt(6 * found / (double(photons) * double{ls::pi})));
}

bench::Pairs time_build(const std::vector<Photon>& photons, int pairs, Grid& grid, Tree& tree) {
    std::vector<double> seconds_tree, seconds_grid, ratio;
    std::vector<Photon> items;
    for (int i = -1; i < pairs; ++i) {
        const double of_tree = bench::seconds_of([&] { tree.build(); });
        items = photons;
        const double of_grid =
            bench::seconds_of([&] { grid.build(items, radius_for(photons.size(), targets[0]), ls::SerialExecutor{}); });
        if (i < 0) continue;  // the warm-up
        seconds_tree.push_back(of_tree);
        seconds_grid.push_back(of_grid);
        ratio.push_back(of_tree / of_grid);
    }
    return {bench::Spread(seconds_tree), bench::Spread(seconds_grid), bench::Spread(ratio)};
}

void print_row(const char* what, double found, double count, const bench::Pairs& pairs, double growth, double bytes,
               double tree_bytes) {
    char spread[32];
    std::snprintf(spread, sizeof spread, "(%.2f to %.2f)", pairs.ratio.low, pairs.ratio.high);
    std::printf("%9s %6.2f %9.3f %9.3f", what, found, count * 1e-6 / pairs.b.median, count * 1e-6 / pairs.a.median);
    std::printf(" %7.2f  %-16s %6.2f", pairs.ratio.median, spread, growth);
    if (bytes > 0) std::printf(" %7.2f %6.2f", bytes, tree_bytes);
    std::printf("\n");
}

/// What the row for fewer photons said.
struct Row {
    double photons = 0, build = 0, query[std::size(targets)] = {};
};

void measure(std::size_t n, Row& last) {
    const std::vector<Photon> photons = photons_on_walls(n, 1);
    const std::vector<Photon> queries = photons_on_walls(std::min<std::size_t>(n, 100000), 2);
    const int pairs = n >= 5000000 ? 1 : n >= 500000 ? 3 : 15;
    const auto growth = [&](double now, double before) {
        return before > 0 ? std::log(now / before) / std::log(double(n) / last.photons) : 0;
    };
    Grid grid;
    Tree tree(photons);
    Row row{.photons = double(n)};

    const bench::Pairs build = time_build(photons, pairs, grid, tree);
    row.build = build.b.median;
    std::printf("%zu photons\n", n);
    print_row("build", 0, double(n), build, growth(row.build, last.build), double(grid.bytes()) / double(n),
              tree.bytes() / double(n));
    for (std::size_t k = 0; k < std::size(targets); ++k) {
        const float radius = radius_for(n, targets[k]);
        std::vector<Photon> items = photons;
        grid.build(items, radius, ls::SerialExecutor{});
        double power[2] = {};
        const bench::Pairs query = bench::compare(
            pairs,
            [&] {
                for (const Photon& q : queries)
                    tree.for_each_near(q.position, radius, [&](const Photon& p) { power[0] += double(p.power.x); });
            },
            [&] {
                for (const Photon& q : queries)
                    grid.for_each_near(q.position, [&](const Photon& p) { power[1] += double(p.power.x); });
            });
        const double looked = double(queries.size());
        row.query[k] = query.b.median / looked;
        print_row("query", power[1] / (looked * (pairs + 1)), looked, query, growth(row.query[k], last.query[k]), 0, 0);
        // Squared distances are rounded: a few of those at the very radius may be told apart differently.
        const bool same = std::abs(power[0] - power[1]) <= 1e-5 * power[1];
        if (power[0] > 0 && !same) std::printf("the two do not find the same\n");
    }
    last = row;
}

void time_threads(std::size_t n) {
    const std::vector<Photon> photons = photons_on_walls(n, 1);
    const auto best_seconds = [&](const auto& executor) {
        Grid grid;
        std::vector<Photon> items;
        double best = 1e30;
        for (int i = 0; i < 4; ++i) {
            items = photons;
            const auto begin = std::chrono::steady_clock::now();
            grid.build(items, radius_for(n, targets[0]), executor);
            best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        }
        return best;
    };
    const ls::TbbExecutor all;
    const double serial = best_seconds(ls::SerialExecutor{}), parallel = best_seconds(all);
    std::printf("building with %d threads: %.2f times as fast as with one\n", all.threads(), serial / parallel);
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::size_t> counts;
    for (int i = 1; i < argc; ++i) {
        const double n = std::strtod(argv[i], nullptr);
        if (!(n >= 1 && n <= 1e9)) {
            std::fprintf(stderr, "photon_map: %s is not a number of photons (1 to 1e9)\n", argv[i]);
            return 2;
        }
        counts.push_back(static_cast<std::size_t>(n));
    }
    if (argc == 1) counts = {10000, 100000, 1000000, 10000000};

    std::printf("%9s %6s %9s %9s %7s  %-16s %6s %7s %6s\n", "", "found", "M/s", "tree M/s", "ratio", "", "growth",
                "bytes", "tree");
    Row last;
    for (const std::size_t n : counts) measure(n, last);
    time_threads(counts.back());
}
