#include <lightswitch/scene/description.hpp>

#include "../support/relative.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace lightswitch;
using test::relative;

namespace {

DVec3 area_normal(const Mesh& mesh, std::size_t t) {
    const auto [a, b, c] = mesh.triangles[t];
    return glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]) * 0.5;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += glm::length(area_normal(mesh, t));
    return sum;
}

/// Signed volume: positive when a closed mesh has its front outside.
double volume(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += glm::dot(mesh.positions[a], glm::cross(mesh.positions[b], mesh.positions[c])) / 6;
    return sum;
}

DMat4 scaling(double x, double y, double z) { return {{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}}; }

void check_close(const DVec3& a, const DVec3& b, double tolerance = 1e-12) {
    CHECK_MESSAGE(glm::length(a - b) <= tolerance,
                  a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z);
}

}  // namespace

TEST_CASE("simple shapes have their area and front") {
    CHECK(area(rectangle()) == relative(4, 1e-5));
    CHECK(area_normal(rectangle(), 0).z > 0);
    CHECK(area_normal(rectangle(), 1).z > 0);
    CHECK(area(disk()) == relative(std::numbers::pi, 1e-12));
    CHECK(disk().triangles.size() == 256);
    for (std::size_t t = 0; t < 256; ++t) CHECK(area_normal(disk(), t).z > 0);
    CHECK(area(cube()) == relative(24, 1e-5));
    CHECK(volume(cube()) == relative(8, 1e-5));
    // Each face looks outward, not only most of them.
    for (std::size_t t = 0; t < 12; ++t)
        CHECK(glm::dot(area_normal(cube(), t), cube().positions[cube().triangles[t][0]]) > 0);
    CHECK(area_normal(quad({0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}), 1) == DVec3(0, 0, 1));
}

TEST_CASE("a reflection leaves the front where the normals point") {
    CHECK(volume(cube(scaling(-1, 2, 3))) == relative(48, 1e-5));
    CHECK(area_normal(rectangle(scaling(-1, 1, 1)), 0).z > 0);
    CHECK(area_normal(rectangle(scaling(1, 1, -1)), 0).z < 0);

    Mesh mesh = rectangle();
    mesh.smooth();
    const Mesh mirrored = mesh.transformed(scaling(1, 1, -2));
    check_close(mirrored.normals[0], {0, 0, -1});
    CHECK(area_normal(mirrored, 0).z < 0);
}

TEST_CASE("normals follow the inverse transpose") {
    // The plane x + y = 1 scaled by 2 along x is x / 2 + y = 1.
    Mesh mesh{.positions = {{1, 0, 0}, {0, 1, 0}, {1, 0, 1}}, .normals = {}, .triangles = {{0, 1, 2}}};
    mesh.smooth();
    const double half = std::sqrt(0.5);
    check_close(mesh.normals[0], {half, half, 0});
    const Mesh wide = mesh.transformed(scaling(2, 1, 1));
    check_close(wide.normals[1], glm::normalize(DVec3(0.5, 1, 0)));
    CHECK(wide.positions[0] == DVec3(2, 0, 0));
    // Tiny and huge scales neither underflow nor overflow.
    check_close(mesh.transformed(scaling(2e-200, 1e-200, 1e-200)).normals[1], glm::normalize(DVec3(0.5, 1, 0)));
    check_close(mesh.transformed(scaling(2e99, 1e99, 1e99)).normals[1], glm::normalize(DVec3(0.5, 1, 0)));
    // A translation moves positions and leaves normals.
    DMat4 moved(1);
    moved[3] = {5, 6, 7, 1};
    CHECK(mesh.transformed(moved).positions[0] == DVec3(6, 6, 7));
    check_close(mesh.transformed(moved).normals[0], {half, half, 0});
}

TEST_CASE("flipping exchanges front and back of winding and normals") {
    Mesh mesh = rectangle();
    mesh.smooth();
    const Mesh back = mesh.flipped();
    check_close(back.normals[3], {0, 0, -1});
    CHECK(area_normal(back, 0).z < 0);
    CHECK(back.flipped().triangles == mesh.triangles);
}

TEST_CASE("a mesh that is given away is changed in place, with the same result") {
    Mesh mesh = rectangle();
    mesh.smooth();
    for (const double z : {2.0, -2.0}) {
        const Mesh expected = mesh.transformed(scaling(1, 3, z)).flipped();
        Mesh given = mesh;
        const DVec3* const positions = given.positions.data();
        const Mesh result = std::move(given).transformed(scaling(1, 3, z)).flipped();
        CHECK(result.positions.data() == positions);
        CHECK(result.positions == expected.positions);
        CHECK(result.normals == expected.normals);
        CHECK(result.triangles == expected.triangles);
    }
}

TEST_CASE("smooth normals weigh triangles by their angle at the vertex") {
    // Two faces of a cube around the edge from a to b; the first is cut in two triangles at a, which must not change
    // a's normal: 45 + 45 degrees of +z and 90 degrees of +x.
    Mesh mesh{.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}, {0, 0, -1}, {7, 7, 7}},
              .normals = {},
              .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {2, 2, 5}}};
    mesh.smooth();
    const double half = std::sqrt(0.5);
    check_close(mesh.normals[0], {half, 0, half});
    // At b the first face has 90 degrees and the second 45.
    check_close(mesh.normals[1], glm::normalize(DVec3(45, 0, 90)));
    check_close(mesh.normals[3], {0, 0, 1});
    // No triangle with an area: Mitsuba's stand-in.
    CHECK(mesh.normals[5] == DVec3(1, 0, 0));
}

TEST_CASE("triangles can be turned to face along their normals") {
    Mesh mesh = rectangle();
    mesh.smooth();
    std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
    CHECK(area_normal(mesh, 1).z < 0);
    mesh.face_along_normals();
    CHECK(area_normal(mesh, 0).z > 0);
    CHECK(area_normal(mesh, 1).z > 0);
}

TEST_CASE("look_at gives left, up and forward") {
    const DMat4 m = CameraDescription::look_at({1, 2, 3}, {1, 2, 8}, {0, 5, 1});
    CHECK(m == DMat4{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {1, 2, 3, 1}});
    const DMat4 turned = CameraDescription::look_at({0, 0, 0}, {-4, 0, 0}, {0, 0, 2});
    CHECK(turned == DMat4{{0, -1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 0}, {0, 0, 0, 1}});
    CHECK_THROWS_WITH_AS(CameraDescription::look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}),
                         doctest::Contains("its own position"), Error);
    CHECK_THROWS_WITH_AS(CameraDescription::look_at({0, 0, 0}, {0, 2, 0}, {0, -1, 0}), doctest::Contains("parallel"),
                         Error);
}
