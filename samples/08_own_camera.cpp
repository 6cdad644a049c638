// A camera of one's own: a struct that meets the concept `Camera`, and the scene seen by it. What a camera has besides
// its rays decides which methods can use it.

#include <lightswitch/lightswitch.hpp>

#include <cstdio>

namespace ls = lightswitch;

/// A camera that sees all around: the columns of the image are the angle around the y axis, its rows that from the top.
/// In render space, such as every camera of a built scene.
struct Panorama {
    ls::Vec3 eye;
    int columns = 512;

    int width() const { return columns; }
    int height() const { return columns / 2; }
    bool has_lens() const { return false; }

    ls::Ray ray(const ls::Vec2& pixel, const ls::Vec2&) const {
        const float around = 2 * ls::pi * pixel.x / float(width()), down = ls::pi * pixel.y / float(height());
        return {.origin = eye,
                .direction = {std::sin(down) * std::sin(around), std::cos(down), -std::sin(down) * std::cos(around)}};
    }

    // For methods that start paths at lights and look for the camera.

    ls::Maybe<ls::CameraView> view(const ls::SurfacePoint& point, const ls::Vec2&) const {
        const ls::Vec3 away = point.position - eye;
        const float distance = std::sqrt(ls::length_squared(away));
        if (!(distance > 0)) return {};
        const ls::Vec3 direction = away / distance;
        const float around = std::atan2(direction.x, -direction.z) / (2 * ls::pi);
        return ls::CameraView{.pixel = {(around < 0 ? around + 1 : around) * float(width()),
                                        std::acos(std::clamp(direction.y, -1.0f, 1.0f)) / ls::pi * float(height())},
                              .wi = -direction,
                              .density = density(point.position, direction),
                              .visibility = point.segment_to(eye)};
    }
    /// Pixels per area: those of a solid angle, over the square of the distance.
    double density(const ls::Vec3& position, const ls::Vec3& direction) const {
        const double sine = std::sqrt(std::max(1 - double(direction.y) * double(direction.y), 1e-12));
        const double per_solid_angle = width() * height() / (2 * double(ls::pi) * double(ls::pi) * sine);
        return per_solid_angle / double(ls::length_squared(position - eye));
    }
};
static_assert(ls::ConnectableCamera<Panorama>);

int main() try {
    const auto room = ls::stock::cornell_box();
    const ls::Vec3 eye(room.space().point({0, 0, 0.4}));
    const auto scene = room.with_camera(Panorama{eye});  // shares everything but the camera
    ls::save("panorama.png", ls::render(scene, ls::PathTracerNee{}, {.samples = 64}));
    ls::save("panorama-light.png", ls::render(scene, ls::LightTracer{}, {.samples = 64}));
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
