#include <lightswitch/compare/tiles.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using test::relative;

TEST_CASE("the tiles of every level cover the image once, and fine tiles lie in coarse ones") {
    for (const auto& [width, height] : {std::pair(128, 128), {1, 1}, {7, 3}, {40, 9}, {1000, 3}, {65, 130}}) {
        const TileLayout layout(width, height);
        CHECK(layout.tiles(0) == 1);
        const std::size_t finest = layout.levels() - 1;
        CHECK(layout.tiles(finest) <= 256);
        for (std::size_t level = 0; level <= finest; ++level) {
            std::vector<int> seen(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
            for (std::size_t t = 0; t < layout.tiles(level); ++t) {
                const PixelRectangle r = layout.tile(level, t);
                if (level > 0) CHECK((r.x1 - r.x0 >= 4 || layout.columns(level) == 1));
                for (int y = r.y0; y < r.y1; ++y)
                    for (int x = r.x0; x < r.x1; ++x) ++seen[static_cast<std::size_t>(y * width + x)];
            }
            CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
            for (std::size_t t = 0; t < layout.tiles(finest); ++t) {
                const PixelRectangle fine = layout.tile(finest, t),
                                     coarse = layout.tile(level, layout.ancestor(level, t));
                CHECK(fine.x0 >= coarse.x0);
                CHECK(fine.y0 >= coarse.y0);
                CHECK(fine.x1 <= coarse.x1);
                CHECK(fine.y1 <= coarse.y1);
            }
        }
    }
    CHECK(TileLayout(128, 128).levels() == 5);
    CHECK(TileLayout(128, 128).tiles(4) == 256);
}

TEST_CASE("the moments of tiles are those of their pixels' means") {
    const TileLayout layout(9, 10);
    TileMoments moments(layout);
    for (int n = 0; n < 5; ++n) {
        Image image(9, 10), less(9, 10);
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 9; ++x) {
                image(x, y) = Rgb(float(x * n * n), float(y), 1.5f);
                less(x, y) = Rgb(0, 1, 0);
            }
        moments.add(image, &less);
    }
    CHECK(moments.count() == 5);
    CHECK(layout.levels() == 2);
    const auto whole = moments.estimates(0)[0];
    CHECK(whole[0].mean == relative(4 * 6, 1e-5));  // mean of x times mean of 0, 1, 4, 9, 16
    CHECK(whole[1].mean == relative(3.5, 1e-5));
    CHECK(whole[1].variance == 0);
    CHECK(whole[2].mean == 1.5);
    const auto fine = moments.estimates(1);
    REQUIRE(fine.size() == 4);
    CHECK(fine[0][0].mean == relative(1.5 * 6, 1e-5));  // columns 0 to 3
    CHECK(fine[1][0].mean == relative(6 * 6, 1e-5));    // columns 4 to 8
    CHECK(fine[2][1].mean == relative(6, 1e-5));        // rows 5 to 9, less 1
    // Its own variance of the mean, and a share of the average tile's for what it may have missed: n x n has the
    // variance 43.5, as an estimate of the variance from five.
    const auto variance = [](double x) { return x * x * 43.5 / 5; };
    const double pooled = (2 * variance(1.5) + 2 * variance(6)) / 4;
    CHECK(fine[0][0].variance == relative(variance(1.5) + 0.8 * pooled, 1e-5));  // 4 / n images
    CHECK(fine[1][0].variance == relative(variance(6) + 0.8 * pooled, 1e-5));
}
