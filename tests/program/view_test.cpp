// What the window does without a window: its camera, and its pictures.

#include <view/camera_control.hpp>
#include <view/pictures.hpp>

#include <lightswitch/compare/false_color.hpp>
#include <lightswitch/film/tonemap.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace lightswitch;
using namespace lightswitch::program;

namespace {

CameraDescription some_camera() {
    CameraDescription camera;
    camera.to_world = CameraDescription::look_at({3, 2, 5}, {0.5, 0.25, -1}, {0, 1, 0});
    camera.fov = 47;
    return camera;
}

DVec3 column(const CameraDescription& camera, int i) { return DVec3(camera.to_world[i]); }

bool rigid(const CameraDescription& camera, double hand) {
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            worst = std::max(worst, std::abs(glm::dot(column(camera, i), column(camera, j)) - (i == j ? 1 : 0)));
    const double volume = glm::dot(glm::cross(column(camera, 0), column(camera, 1)), column(camera, 2));
    return worst < 1e-12 && std::abs(volume - hand) < 1e-12;
}

}  // namespace

TEST_CASE("Orbiting keeps the pivot in the middle, at its distance, and stops at the poles") {
    for (const double hand : {1.0, -1.0}) {
        CameraDescription start = some_camera();
        start.to_world[0] *= hand;
        CameraControl control(start, 4);
        const DVec3 pivot = column(start, 3) + 4.0 * column(start, 2);
        for (int i = 0; i < 500; ++i) {
            control.orbit(0.3 * std::sin(i), 0.4 * std::cos(1.7 * i) + (i > 250 ? 0.2 : -0.2));
            const CameraDescription& now = control.description();
            CHECK(rigid(now, hand));
            CHECK(glm::length(column(now, 3) + 4.0 * column(now, 2) - pivot) < 1e-9);
            CHECK(std::abs(column(now, 0).y) < 1e-12);  // the horizon stays level
            CHECK(column(now, 1).y > 0.01);
        }
        CHECK(control.changes() == 500);
        control.reset();
        CHECK(control.description().to_world == start.to_world);
    }
}

TEST_CASE("The camera goes where the hand says") {
    const CameraDescription start = some_camera();
    CameraControl control(start, 4);
    control.orbit(0.1, 0);
    CHECK(glm::dot(column(control.description(), 3) - column(start, 3), column(start, 0)) > 0);  // to the left
    control.reset();
    control.orbit(0, 0.1);
    CHECK(column(control.description(), 3).y > column(start, 3).y);
    control.reset();
    // What is at the pivot moves by half the image's width, to its edge.
    control.pan(0.5, 0);
    const DVec3 pivot = column(start, 3) + 4.0 * column(start, 2);
    const DVec3 seen = pivot - column(control.description(), 3);
    const double across = -glm::dot(seen, column(start, 0)) / glm::dot(seen, column(start, 2));  // to the right
    CHECK(std::abs(across - std::tan(glm::radians(47.0) / 2)) < 1e-12);
    control.reset();
    control.dolly(0.5);
    CHECK(glm::length(column(control.description(), 3) + 2.0 * column(start, 2) - pivot) < 1e-12);
    control.reset();
    control.fly(0, 0, 1);
    CHECK(glm::length(column(control.description(), 3) - pivot) < 1e-12);
    control.reset();
    for (int i = 0; i < 100; ++i) control.widen(1.5);
    CHECK(control.description().fov == 170);
    for (int i = 0; i < 100; ++i) control.widen(0.5);
    CHECK(control.description().fov == 1);
}

TEST_CASE("A picture has the bytes of a .png, whatever the radiance") {
    Image image(64, 32);
    const float specials[] = {0,
                              -1,
                              1e-9f,
                              0.0031308f,
                              0.5f,
                              1,
                              2,
                              1e30f,
                              std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()};
    for (std::size_t i = 0; i < image.pixels().size(); ++i) {
        const auto at = static_cast<float>(i) / static_cast<float>(image.pixels().size());
        image.pixels()[i] = {at, at * at * at, i < std::size(specials) ? specials[i] : 1.2f * std::sqrt(at)};
    }
    for (const float stops : {0.0f, -2.3f, 4.0f}) {
        const std::string bytes = tone_map(image, stops);
        const Picture picture = picture_of(image, {.stops = stops});
        std::size_t different = 0;
        for (std::size_t i = 0; i < image.pixels().size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                different += picture.rgba[4 * i + c] != static_cast<std::uint8_t>(bytes[3 * i + c]);
            different += picture.rgba[4 * i + 3] != 255;
        }
        CHECK(different == 0);
    }
    const Picture red = picture_of(image, {.channel = Channel::red});
    CHECK(red.rgba[4 * 1000] == red.rgba[4 * 1000 + 2]);
    const Picture filmic = picture_of(image, {.stops = 3, .curve = ToneCurve::filmic});
    CHECK(filmic.rgba[4 * 300] < picture_of(image, {.stops = 3}).rgba[4 * 300]);
}

TEST_CASE("Differences are signed, relative, or in standard errors, and false colours are the library's") {
    Snapshot a, b;
    a.image = b.image = a.variance = b.variance = Image(2, 1);
    a.image(0, 0) = Rgb(3, 1, 1);
    b.image(0, 0) = Rgb(2, 1, 1);
    a.image(1, 0) = Rgb(1, 1, 1);
    b.image(1, 0) = Rgb(1, 1, 1.5f);
    a.variance(0, 0) = b.variance(0, 0) = Rgb(0.02f, 0.02f, 0.02f);
    a.variance(1, 0) = b.variance(1, 0) = Rgb(0.02f, 0.02f, 0.02f);
    const Image absolute = difference_of(Difference::absolute, a, b);
    CHECK(absolute(0, 0) == Rgb(1, 0, 0));
    CHECK(absolute(1, 0) == Rgb(0, 0, -0.5f));
    const Image relative = difference_of(Difference::relative, a, b);
    CHECK(std::abs(relative(0, 0).x - 1 / (2 + 0.0125f)) < 1e-6f);
    const Image significance = difference_of(Difference::significance, a, b);
    CHECK(std::abs(significance(0, 0).x - 5) < 1e-5f);
    CHECK(significance(1, 0) == Rgb(0));  // 2.5 standard errors are noise
    const float scale = scale_of(Difference::absolute, absolute);
    CHECK(scale == 1);
    const Picture picture = picture_of_numbers(absolute, scale);
    const Image colors = false_color(absolute, {.scale = scale, .legend = false});
    const auto wanted = to_srgb8(colors(0, 0));
    CHECK(picture.rgba[0] == wanted[0]);
    CHECK(picture.rgba[1] == wanted[1]);
    CHECK(picture.rgba[2] == wanted[2]);
    CHECK(picture.rgba[0] > picture.rgba[2]);          // red is above
    CHECK(picture.rgba[4 + 0] < picture.rgba[4 + 2]);  // blue below
}

TEST_CASE("The camera's text has what differs from the usual") {
    CameraDescription camera = some_camera();
    FilmDescription film{.width = 30, .height = 20, .filter = Filter::tent(1.5f), .origin = {}};
    std::string xml = camera_xml(camera, film);
    CHECK(xml.find("type=\"perspective\"") != std::string::npos);
    CHECK(xml.find("name=\"radius\" value=\"1.5\"") != std::string::npos);
    CHECK(xml.find("far_clip") == std::string::npos);
    camera.aperture_radius = 0.125;
    camera.far_clip = 10;
    film.crop_x = 3;
    film.full_width = 100;
    film.full_height = 50;
    xml = camera_xml(camera, film);
    CHECK(xml.find("type=\"thinlens\"") != std::string::npos);
    CHECK(xml.find("name=\"aperture_radius\" value=\"0.125\"") != std::string::npos);
    CHECK(xml.find("name=\"crop_offset_x\" value=\"3\"") != std::string::npos);
    CHECK(xml.find("name=\"width\" value=\"100\"") != std::string::npos);
    const std::string code = camera_code(camera, film);
    CHECK(code.find(".aperture_radius = 0.125,") != std::string::npos);
    CHECK(code.find(".full_height = 50") != std::string::npos);
    CHECK(code.find("fov_axis") == std::string::npos);
}
