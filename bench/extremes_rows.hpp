#pragma once

// The rows of `extremes`: what is varied, how far, and what the mean of the image must be. Here those about size,
// detail and light.

#include <lightswitch/scene/stock.hpp>

#include "support/renders.hpp"

#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace extremes {

namespace ls = lightswitch;
using ls::DVec3, ls::LibraryDescription, ls::Rgb;
using MakeScene = std::function<LibraryDescription()>;

inline std::string short_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// A scene, and the mean that its image must have.
struct Row {
    std::string what, at;
    MakeScene scene;
    double low = 0, high = 0;   ///< where the mean lies
    double rounding = 1e-4;     ///< how far it may be off besides, as a fraction
    MakeScene same_as{};        ///< must have the same mean
    std::string starved{};      ///< methods that find the light too rarely here to be measured by
    std::string refused{};      ///< what the message holds where there must be one
    std::string known_bound{};  ///< why `high` is not what it should be

    Row& between(double from, double to) { return low = from, high = to, *this; }
    Row& within(double fraction) { return rounding = fraction, *this; }
    Row& like(MakeScene other) { return same_as = std::move(other), between(1, 1); }
    Row& without(std::string methods) { return starved = std::move(methods), *this; }
    Row& with_error(std::string message) { return refused = std::move(message), *this; }
    Row& bounded_by(double most, std::string why) { return known_bound = std::move(why), between(low, most); }
};

class Rows {
public:
    Row& add(std::string what, std::string at, MakeScene scene, double mean) {
        return rows_.emplace_back(Row{std::move(what), std::move(at), std::move(scene), mean, mean});
    }
    Row& add(std::string what, double at, MakeScene scene, double mean) {
        return add(std::move(what), short_text(at), std::move(scene), mean);
    }
    const std::vector<Row>& all() const { return rows_; }

private:
    std::vector<Row> rows_;
};

inline LibraryDescription small_film(LibraryDescription scene, int side = 8) {
    scene.film.width = scene.film.height = side;
    return scene;
}

/// A white sky around nothing yet, seen from `eye`, which looks at the origin.
inline LibraryDescription under_sky(const DVec3& eye, double fov) {
    LibraryDescription scene;
    scene.add(ls::Source(ls::EnvironmentSource{}));
    scene.camera.to_world = ls::CameraDescription::look_at(eye, DVec3(0), {0, 1, 0.3});
    scene.camera.fov = fov;
    return small_film(scene);
}

inline ls::Mesh floor_of(double half, double height = 0) {
    return ls::quad({-half, height, half}, {half, height, half}, {half, height, -half}, {-half, height, -half});
}
inline std::size_t add_grey(LibraryDescription& scene) { return scene.add(ls::Lambert{Rgb(0.5f)}); }
inline std::size_t add_black(LibraryDescription& scene) { return scene.add(ls::TwoSided<ls::Lambert>{{Rgb(0)}}); }

/// A grey floor at height 0, two units wide, seen from above, and no light.
inline LibraryDescription floor_alone() {
    LibraryDescription scene = under_sky({0, 2, 1}, 20);
    scene.sources.clear();
    scene.add(floor_of(1), add_grey(scene));
    return scene;
}

/// The mean over the image of `floor_alone` of what is reflected of `irradiance`, a function of the point.
template <class F>
double mean_on_floor(const F& irradiance) {
    const LibraryDescription scene = floor_alone();
    const auto& m = scene.camera.to_world;
    const double tangent = std::tan(glm::radians(scene.camera.fov / 2));
    constexpr int side = 64;
    double sum = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const DVec3 way = DVec3(m[0]) * (tangent * (2 * (x + 0.5) / side - 1)) +
                              DVec3(m[1]) * (tangent * (2 * (y + 0.5) / side - 1)) + DVec3(m[2]);
            sum += irradiance(DVec3(m[3]) - way * (m[3].y / way.y));
        }
    return 0.5 * std::numbers::inv_pi * sum / (side * side);
}

/// A ball of that radius and radiance over the floor, no part of which is below it.
struct LampBall {
    DVec3 center;
    double radius, radiance = 1;

    double mean() const {
        return mean_on_floor([this](const DVec3& p) {
            const DVec3 way = center - p;
            const double d2 = glm::dot(way, way);
            return std::numbers::pi * radiance * radius * radius / d2 * way.y / std::sqrt(d2);
        });
    }
    MakeScene over_floor() const {
        return [ball = *this] {
            LibraryDescription scene = floor_alone();
            scene.add(ls::Sphere{ball.center, ball.radius}, add_black(scene), Rgb(float(ball.radiance)));
            return scene;
        };
    }
};

/// A closed box of half side 1, black, in a bright sky: all that is seen from within is a leak.
inline LibraryDescription closed_box(const DVec3& eye, const DVec3& target, double fov) {
    LibraryDescription scene = under_sky({0, 0, 0.5}, fov);
    scene.camera.to_world = ls::CameraDescription::look_at(eye, target, {0.1, 1, 0.2});
    scene.add(ls::cube(), add_black(scene));
    return small_film(scene, 64);
}

inline LibraryDescription room() { return small_film(ls::stock::describe_cornell_spheres()); }

/// The room with all positions p as `factor` * p + `shift`.
inline MakeScene changed_room(double factor, const DVec3& shift) {
    return [=] {
        return ls::test::mapped(
            room(), [=](const DVec3& p) { return factor * p + shift; }, factor);
    };
}

inline void add_sizes(Rows& rows) {
    for (const double factor : {1e-12, 1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9, 1e12})
        rows.add("scale of a room with mirror and glass", factor, changed_room(factor, DVec3(0)), 1)
            .like(room)
            .within(1e-3)
            .without("path light");
    for (const double far : {1e3, 1e6, 1e9, 1e12})
        rows.add("distance of the room from the origin", far, changed_room(1, DVec3(far, -far, far / 3)), 1)
            .like(room)
            .within(1e-3)
            .without("path light");
    rows.add("distance of the room from the origin", 1e18, changed_room(1, DVec3(1e18)), 0).with_error("no area");
}

/// A box of 1 mm on a plain, seen from above.
inline LibraryDescription box_on_plain(double half) {
    LibraryDescription scene = under_sky({0.002, 0.002, 0.004}, 20);
    const std::size_t grey = add_grey(scene);
    scene.add(floor_of(half), grey);
    scene.add(ls::stock::detail::block({-0.0005, 0, -0.0005}, {0.0005, 0.001, 0.0005}), grey);
    return scene;
}

inline void add_details(Rows& rows) {
    for (const double half : {50., 500.})
        rows.add(
                "a box of 1 mm on a plain, its half side in m", half, [=] { return box_on_plain(half); }, 1)
            .like([] { return box_on_plain(1); })
            .within(5e-3)
            .without("light photon");
    rows.add(
            "a box of 1 mm on a plain, its half side in m", 5000, [] { return box_on_plain(5000); }, 1)
        .like([] { return box_on_plain(1); })
        .bounded_by(1.1, "rays leave the plain above the box")
        .without("light photon");
    for (const double gap : {4e-5, 4e-6})
        rows.add(
                "two white balls in a white sky, gap in radii", gap,
                [=] {
                    LibraryDescription scene = under_sky({0, 0.3, 2}, 5);
                    const std::size_t white = scene.add(ls::Lambert{Rgb(1)});
                    for (const double side : {-1., 1.})
                        scene.add(ls::Sphere{DVec3(side * (1 + gap / 2), 0, 0), 1}, white);
                    return scene;
                },
                1)
            .within(1e-3)
            .without("light photon");
    for (const double gap : {1e-3, 1e-5, 1e-6})
        rows.add(
                "ten sheets, the upper one grey, others black, gap", gap,
                [=] {
                    LibraryDescription scene = under_sky({0, 2, 1}, 20);
                    const std::size_t grey = add_grey(scene), black = add_black(scene);
                    for (int i = 0; i < 10; ++i) scene.add(floor_of(1, -i * gap), i == 0 ? grey : black);
                    return scene;
                },
                0.5)
            .without("light");
    for (const double small : {1e-6, 1e-9, 1e-12})
        rows.add(
                "a grey ball in a scene of size 1, its radius", small,
                [=] {
                    LibraryDescription scene = under_sky({0, 0, 4 * small}, 14);
                    scene.add(ls::Sphere{DVec3(0), small}, add_grey(scene));
                    for (const double side : {-1., 1.})
                        scene.add(ls::Sphere{DVec3(side, 0, 0), 1e-7}, add_black(scene));
                    return scene;
                },
                0.5)
            .within(1e-3)
            .without("light photon");
    for (const double near : {1e-2, 1e-4, 1e-5, 1e-6})
        rows.add(
            "what leaks at an edge of a closed box, camera from it", near,
            [=] {
                return closed_box({1 - near, 1 - near, 0}, {1, 1, 0.3 * near}, 90);
            },
            0);
    rows.add(
        "what leaks out of a closed box, field of view", 170,
        [] {
            return closed_box({0.1, 0.05, 0.02}, {1, 1, 1}, 170);
        },
        0);
}

inline void add_lights(Rows& rows) {
    for (const double radiance : {1e-30, 1e-20, 1e20, 1e30}) {
        const LampBall ball{{0.2, 1.5, 0}, 0.5, radiance};
        rows.add("radiance of a lamp over a floor", radiance, ball.over_floor(), ball.mean());
    }
    for (const double radiance : {1e-37, 1e37})
        rows.add("radiance of a lamp over a floor", radiance, LampBall{{0.2, 1.5, 0}, 0.5, radiance}.over_floor(), 0)
            .with_error("1e");
    for (const double radius : {1e-6, 1e-4, 1e-2, 0.1, 0.19}) {
        const LampBall ball{{0, 1, 0}, radius};
        rows.add("radius of a lamp at height 1", radius, ball.over_floor(), ball.mean())
            .without(radius < 0.05 ? "path" : "");
    }
    for (const double far : {1e2, 1e4, 1e6}) {
        const LampBall ball{{0, far, far}, far / 4};
        rows.add("distance of a lamp that looks large", far, ball.over_floor(), ball.mean())
            .within(1e-3)
            .without("light photon");
    }
    const LampBall sun{{0, 1e8, 3e7}, 4.65e5, 46000};
    rows.add("a sun of half a degree, its distance", 1e8, sun.over_floor(), sun.mean())
        .within(1e-3)
        .without("path light photon");
    for (const double radius : {0.3, 0.01}) {
        const LampBall ball{{0.95, radius, -0.95}, radius};
        rows.add("a lamp that lies on the floor, its radius", radius, ball.over_floor(), ball.mean())
            .within(1e-3)
            .without("path");
    }
    struct Ring {
        int count;
        std::function<double(int)> power;
    };
    const auto add_ring = [&](const char* what, const Ring& ring) {
        const auto place = [](int i) { return DVec3(0.9 * std::cos(i * 2.4), 1, 0.9 * std::sin(i * 2.4)); };
        // Of many equal ones the first 2000 are as even.
        const int some = ring.count > 10000 ? 2000 : ring.count;
        double mean = 0;
        for (int i = 0; i < some; ++i)
            if (const double power = ring.power(i); power > 1e-6)
                mean += power * ring.count / some * mean_on_floor([&](const DVec3& p) {
                            const DVec3 way = place(i) - p;
                            return way.y / std::pow(glm::dot(way, way), 1.5);
                        });
        const auto scene = [=] {
            LibraryDescription lit = floor_alone();
            for (int i = 0; i < ring.count; ++i)
                lit.add(ls::Source(ls::PointSource{place(i), Rgb(float(ring.power(i)))}));
            return lit;
        };
        rows.add(what, ring.count, scene, mean).within(1e-3).without("path");
    };
    for (const int count : {1, 100, 100000}) add_ring("points on a ring", {count, [=](int) { return 1.0 / count; }});
    add_ring("half of them black, one 1e12 times the others", {1000, [](int i) {
                                                                   return i == 77 ? 1e3 : i % 2 ? 0 : 1e-9;
                                                               }});
}

}  // namespace extremes
