#include <lightswitch/core/sampler.hpp>
#include <lightswitch/method/hash_grid.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace lightswitch;

namespace {

struct Item {
    Vec3 position;
    std::uint32_t id;
};

using Grid = HashGrid<Item>;

std::vector<Item> items_at(const std::vector<Vec3>& positions) {
    std::vector<Item> items;
    for (const Vec3& p : positions) items.push_back({p, static_cast<std::uint32_t>(items.size())});
    return items;
}

/// `n` points that `place` makes of uniform points in the unit cube around 0.
std::vector<Vec3> points(std::size_t n, std::uint64_t seed, const auto& place) {
    const IterationPoints numbers(Sampling::independent, seed, 0);
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < n; ++i) {
        Sampler sampler(numbers, 0, i);
        const Vec2 u = sampler.next_2d();
        result.push_back(place(Vec3(u, sampler.next_1d()) - 0.5f));
    }
    return result;
}
std::vector<Vec3> in_cube(std::size_t n, std::uint64_t seed) {
    return points(n, seed, [](const Vec3& p) { return p; });
}

std::vector<std::uint32_t> found(const Grid& grid, const Vec3& at) {
    std::vector<std::uint32_t> ids;
    grid.for_each_near(at, [&](const Item& item) { ids.push_back(item.id); });
    return ids;
}

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> ids) {
    std::sort(ids.begin(), ids.end());
    return ids;
}

/// What `found` is to be, sorted.
std::vector<std::uint32_t> expected(const std::vector<Vec3>& positions, float radius, const Vec3& at) {
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < positions.size(); ++i)
        if (length_squared(positions[i] - at) <= square(radius)) ids.push_back(i);
    return ids;
}

/// Builds, compares each query with a search of all positions, and returns how many items were found in all.
std::size_t check(const std::vector<Vec3>& positions, float radius, const std::vector<Vec3>& queries) {
    CAPTURE(radius);
    Grid grid;
    std::vector<Item> items = items_at(positions);
    grid.build(items, radius, SerialExecutor{});
    CHECK(grid.size() == positions.size());
    std::size_t wrong = 0, total = 0;
    for (const Vec3& at : queries) {
        const auto ids = sorted(found(grid, at));
        wrong += ids != expected(positions, radius, at);
        total += ids.size();
    }
    CHECK(wrong == 0);
    return total;
}

constexpr float radii[] = {1e-6f, 1e-3f, 0.01f, 0.03f, 0.1f, 0.25f, 1, 3, 1e6f};

}  // namespace

TEST_CASE("hash grid: finds what a search of all items finds, in a volume, on planes and in clusters") {
    const auto on_plane = [](int axis) {
        return [axis](Vec3 p) {
            p[axis] = 0.25f;
            return p;
        };
    };
    // Many within a few cells, few far apart.
    const auto cluster = [](const Vec3& p) { return p * std::pow(2 * max_component(glm::abs(p)), 6.0f); };
    const auto oblique = [](const Vec3& p) { return Vec3(p.x, p.y, 0.3f * p.x - 0.7f * p.y); };
    const std::vector<std::vector<Vec3>> sets = {in_cube(3000, 1),
                                                 points(3000, 2, on_plane(0)),
                                                 points(3000, 3, on_plane(1)),
                                                 points(3000, 4, on_plane(2)),
                                                 points(3000, 5, cluster),
                                                 points(3000, 6, oblique)};
    for (const auto& set : sets) {
        std::vector<Vec3> queries = in_cube(50, 7);
        queries.insert(queries.end(), set.begin(), set.begin() + 50);
        for (const float radius : radii) CHECK(check(set, radius, queries) >= 50);
    }
}

TEST_CASE("hash grid: few items and therefore few buckets, any number of each") {
    for (std::size_t n = 0; n <= 70; ++n) {
        const auto set = in_cube(n, n);
        for (const float radius : {0.02f, 0.1f, 0.5f}) check(set, radius, in_cube(100, 100 + n));
    }
}

TEST_CASE("hash grid: items are met once although the rows of a query are many buckets long and wrap around") {
    // All numbers of cells occur modulo a small table: all ways in which runs of a query can lie.
    const auto far = points(1000, 1, [](const Vec3& p) { return p * 100.0f; });
    for (const std::size_t n : {1u, 31u, 33u, 200u, 1000u}) {
        const std::vector<Vec3> set(far.begin(), far.begin() + std::ptrdiff_t(n));
        for (const float radius : {0.5f, 2.0f, 10.0f, 40.0f}) check(set, radius, far);
    }
}

TEST_CASE("hash grid: all items at one point") {
    const std::vector<Vec3> set(20000, Vec3(0.1f, -0.2f, 0.3f));
    for (const float radius : {0.0f, 1e-6f, 0.1f, 10.0f}) {
        CHECK(check(set, radius, {set[0]}) == set.size());
        CHECK(check(set, radius, {set[0] + 8 * radius + 1e-5f}) == 0);
    }
}

TEST_CASE("hash grid: items on the borders of cells, at the very radius, and of either sign") {
    // Cells are one diameter wide (half as wide in x) but for 2e-5: one lattice falls on both sides of their borders.
    for (const float radius : {0.125f, 0.125f / (1 + 0x1p-16f), 0.25f}) {
        std::vector<Vec3> set;
        for (int x = -6; x <= 6; ++x)
            for (int y = -6; y <= 6; ++y)
                for (int z = -6; z <= 6; ++z) set.push_back(Vec3(x, y, z) * radius);
        std::vector<Vec3> queries = set;
        for (const Vec3& p : set)
            for (const float towards : {-infinity, infinity})
                queries.emplace_back(std::nextafter(p.x, towards), std::nextafter(p.y, towards),
                                     std::nextafter(p.z, towards));
        check(set, radius, queries);
    }
    CHECK(check({{0.5f, 0, 0}, {-0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, -0.5f}}, 0.5f, {Vec3(0)}) == 4);
}

TEST_CASE("hash grid: far from the origin, where floats are farther apart than the radius, and next to each other") {
    for (const float center : {1.0f, -64.0f, 1e4f, -1e9f, 1e20f, 3e38f}) {
        const float step = std::nextafter(center, infinity) - center;
        const auto near = points(500, 1, [&](const Vec3& p) { return Vec3(center) + glm::floor(p * 12.0f) * step; });
        for (const float steps : {0.1f, 0.5f, 0.7f, 1.0f, 1.5f, 2.5f, 8.0f}) {
            if (square(3 * steps * step) > std::numeric_limits<float>::max()) continue;
            CHECK(check(near, steps * step, {near.begin(), near.begin() + 100}) >= 100);
        }
    }
    auto set = in_cube(2000, 2);
    for (int axis = 0; axis < 3; ++axis)
        for (const float far : {1e5f, -1e12f, 1e25f, -std::numeric_limits<float>::max()}) {
            Vec3 p(0);
            p[axis] = far;
            set.push_back(p);
        }
    std::vector<Vec3> queries(set.end() - 100, set.end());
    for (const float radius : radii) CHECK(check(set, radius, queries) >= queries.size());
}

TEST_CASE("hash grid: radius 0, one below what float can square, and one above") {
    auto set = in_cube(100, 1);
    set.insert(set.end(), set.begin(), set.begin() + 50);
    CHECK(check(set, 0, set) == 50 * 4 + 50);
    CHECK(check(set, 1e-30f, set) == 50 * 4 + 50);

    std::vector<Item> items = items_at({Vec3(0), Vec3(1e18f, 0, 0), Vec3(0, 3e38f, 0)});
    Grid grid;
    grid.build(items, 3e38f, SerialExecutor{});
    CHECK(sorted(found(grid, Vec3(0))) == std::vector<std::uint32_t>{0, 1});
    for (const float radius : {0.0f, 1e-30f}) {
        items = items_at({Vec3(0), Vec3(1e-27f, 0, 0), Vec3(0, 1e-15f, 0)});
        grid.build(items, radius, SerialExecutor{});
        CHECK(sorted(found(grid, Vec3(0))) == std::vector<std::uint32_t>{0, 1});
    }
}

TEST_CASE("hash grid: what is not finite is dropped, and finds nothing") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto positions = in_cube(40000, 1);
    const auto finite = positions;
    std::vector<Item> items = items_at(positions);
    std::vector<bool> dropped(items.size());
    for (std::size_t i = 0; i < items.size(); i += 7) {
        const float bad = i % 3 == 0 ? nan : i % 3 == 1 ? infinity : -infinity;
        items[i].position[static_cast<Vec3::length_type>(i / 7 % 3)] = bad;
        dropped[i] = true;
    }
    Grid grid;
    grid.build(items, 0.1f, TbbExecutor(2));
    CHECK(grid.size() == std::size_t(std::count(dropped.begin(), dropped.end(), false)));
    for (std::size_t i = 0; i < 30; ++i) {
        auto ids = expected(finite, 0.1f, finite[i]);
        std::erase_if(ids, [&](std::uint32_t id) { return dropped[id]; });
        CHECK(sorted(found(grid, finite[i])) == ids);
    }
    for (const float bad : {nan, infinity, -infinity})
        for (const Vec3& at : {Vec3(bad, 0, 0), Vec3(0, bad, 0), Vec3(0, 0, bad)}) CHECK(found(grid, at).empty());

    items = items_at({Vec3(nan), Vec3(infinity)});
    grid.build(items, 1, SerialExecutor{});
    CHECK(grid.size() == 0);
    CHECK(found(grid, Vec3(0)).empty());
}

TEST_CASE("hash grid: the same order, whatever the executor") {
    // Half of them in one place: more than one block of the build, and one partition with far more than its share.
    auto positions = in_cube(100000, 1);
    for (std::size_t i = 0; i < positions.size(); i += 2) positions[i] *= 0.01f;
    const auto visits = [&](const auto& executor) {
        Grid grid;
        std::vector<Item> items = items_at(positions);
        grid.build(items, 0.02f, executor);
        std::vector<std::uint32_t> ids;
        for (std::size_t i = 0; i < 100; ++i) {
            const auto some = found(grid, positions[i]);
            ids.insert(ids.end(), some.begin(), some.end());
        }
        return ids;
    };
    const auto serial = visits(SerialExecutor{});
    CHECK(serial.size() > 100000);
    CHECK(serial == visits(TbbExecutor(2)));
    CHECK(serial == visits(TbbExecutor(8)));

    // Items of one cell keep the order in which they came.
    std::vector<Item> items = items_at(std::vector<Vec3>(100000, Vec3(0.5f)));
    Grid grid;
    grid.build(items, 0.1f, TbbExecutor(8));
    const auto ids = found(grid, Vec3(0.5f));
    CHECK(ids.size() == 100000);
    CHECK(std::is_sorted(ids.begin(), ids.end()));
}

TEST_CASE("hash grid: rebuilt with more and with fewer items and other radii; memory is reused and bounded") {
    Grid grid;
    CHECK(grid.size() == 0);
    CHECK(found(grid, Vec3(0)).empty());
    std::vector<Item> items;
    grid.build(items, 1, SerialExecutor{});
    CHECK(found(grid, Vec3(0)).empty());

    float radius = 0.2f;
    for (const std::size_t n : {1000u, 20000u, 500u, 0u, 1u, 5000u}) {
        const auto positions = in_cube(n, n);
        items = items_at(positions);
        grid.build(items, radius, SerialExecutor{});
        CHECK(items.empty());
        CHECK(grid.size() == n);
        CHECK(grid.radius() == radius);
        for (const Vec3& at : in_cube(20, n + 1)) CHECK(sorted(found(grid, at)) == expected(positions, radius, at));
        radius *= 0.8f;
    }

    for (const std::size_t n : {1000u, 4096u, 4097u, 60000u}) {
        Grid fresh;
        std::vector<Item> batch(n, Item{Vec3(0), 0});
        fresh.build(batch, 1, SerialExecutor{});
        CHECK(fresh.bytes() <= n * (sizeof(Item) + 8));  // of the vector that came in; and of the grid's own:
        batch.resize(n);
        const Item* const memory = batch.data();
        fresh.build(batch, 1, SerialExecutor{});
        fresh.build(batch, 1, SerialExecutor{});
        CHECK(fresh.bytes() <= n * (sizeof(Item) + 8));
        batch.resize(n);
        CHECK(batch.data() == memory);  // the two took turns, and no other memory came in
    }
}

TEST_CASE("hash grid: a radius that is none is an error, and leaves an empty grid") {
    Grid grid;
    for (const float radius : {-1.0f, infinity, std::numeric_limits<float>::quiet_NaN()}) {
        std::vector<Item> items = items_at({Vec3(0)});
        grid.build(items, 1, SerialExecutor{});
        CHECK(found(grid, Vec3(0)).size() == 1);
        items = items_at({Vec3(0)});
        CHECK_THROWS_WITH_AS(grid.build(items, radius, SerialExecutor{}),
                             "the radius of a photon map must be finite and not negative", Error);
        CHECK(grid.size() == 0);
        CHECK(found(grid, Vec3(0)).empty());
    }
}
