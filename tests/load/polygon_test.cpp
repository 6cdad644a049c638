#include "load/files.hpp"
#include "support/paths.hpp"
#include "support/relative.hpp"

#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/ply.hpp>
#include <lightswitch/load/polygon.hpp>

#include <iterator>
#include <numbers>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Outline = std::vector<DVec3>;

/// By the shoelace formula, and as a vector along the polygon's normal.
DVec3 area_of(const Outline& outline) {
    DVec3 twice(0);
    for (std::size_t i = 0; i < outline.size(); ++i)
        twice += glm::cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
    return 0.5 * twice;
}

/// Area of the triangles; fails the test when one of them faces against `normal`.
double area_of(const Mesh& mesh, const DVec3& normal) {
    double area = 0;
    int turned_over = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const DVec3 twice = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        area += 0.5 * glm::length(twice);
        turned_over += glm::dot(twice, normal) < 0 ? 1 : 0;
    }
    CHECK(turned_over == 0);
    return area;
}

struct Cut {
    Mesh mesh;
    bool is_simple;
};

Cut cut(const Outline& outline) {
    Cut result;
    result.mesh.positions = outline;
    std::vector<std::uint32_t> corners(outline.size());
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
    result.is_simple = detail::PolygonCutter().cut(corners, result.mesh);
    return result;
}

Outline in_plane(std::initializer_list<DVec2> points) {
    Outline outline;
    for (const DVec2& p : points) outline.emplace_back(p, 0);
    return outline;
}

/// `radius` gives the distance from the center, by the number of the corner.
template <class Radius>
Outline around(int corners, const Radius& radius) {
    Outline outline;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners, distance = radius(i);
        outline.emplace_back(distance * std::cos(angle), distance * std::sin(angle), 0);
    }
    return outline;
}

/// Teeth along the x axis, and a wall above them.
Outline comb(int corners) {
    Outline outline;
    for (int i = 0; i < corners - 2; ++i) outline.emplace_back(i, i % 2, 0);
    outline.emplace_back(corners, 2, 0);
    outline.emplace_back(0, 2, 0);
    return outline;
}

std::vector<Outline> concave_outlines() {
    Outline spiral;
    for (int i = 0; i < 200; ++i) spiral.emplace_back(i * std::cos(0.2 * i), i * std::sin(0.2 * i), 0);
    for (int i = 199; i > 0; --i) spiral.emplace_back((i + 7) * std::cos(0.2 * i), (i + 7) * std::sin(0.2 * i), 0);
    return {
        in_plane({{0, -0.3}, {1, -1}, {0, 1}, {-1, -1}}),
        around(10, [](int i) { return i % 2 ? 0.4 : 1; }),
        around(301, [](int i) { return 2 + std::sin(0.2 * i); }),
        comb(101),
        spiral,
        // An L with corners on lines, some of them given twice.
        in_plane({{0, 0}, {1, 0}, {2, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 2}, {1, 3}, {0, 3}, {0, 2}}),
        in_plane({{0, 0}, {4, 0}, {4, 0}, {4, 0}, {1, 1}, {1, 1}, {0, 4}, {0, 4}}),
        // A cut, and a whisker.
        in_plane({{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {2, 4}, {0, 4}}),
        in_plane({{0, 0}, {2, 0}, {2, 1}, {3, 1}, {2, 1}, {2, 2}, {0, 2}}),
        // A hole joined to the outline, another one that touches it, and a corner that touches an edge.
        in_plane({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}}),
        in_plane({{0, 0}, {4, 0}, {4, 4}, {2, 3}, {3, 2}, {1, 2}, {2, 3}, {4, 4}, {0, 4}}),
        in_plane({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}),
    };
}

std::string obj_of(const Outline& outline, std::size_t first) {
    std::string text, face = "f";
    for (std::size_t i = 0; i < outline.size(); ++i) {
        for (int c = 0; c < 3; ++c) text += (c == 0 ? "v " : " ") + detail::shown(outline[i][c]);
        text += '\n';
        face += " " + std::to_string((first + i) % outline.size() + 1);
    }
    return text + face + "\n";
}

std::string ply_of(const Outline& outline, std::size_t first) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(outline.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list int "
                       "int vertex_indices\nend_header\n";
    std::string face = std::to_string(outline.size());
    for (std::size_t i = 0; i < outline.size(); ++i) {
        for (int c = 0; c < 3; ++c) text += detail::shown(outline[i][c]) + (c < 2 ? " " : "\n");
        face += " " + std::to_string((first + i) % outline.size());
    }
    return text + face + "\n";
}

}  // namespace

TEST_CASE("a polygon has its area, whichever corner comes first and whichever way it is turned") {
    for (const Outline& flat : concave_outlines())
        for (const double scale : {1.0, 1e-150, 1e150})
            for (const bool reversed : {false, true})
                for (std::size_t first = 0; first < flat.size(); first += 1 + flat.size() / 40) {
                    Outline outline = flat;
                    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
                    if (reversed) std::reverse(outline.begin(), outline.end());
                    const double area = glm::length(area_of(outline));
                    const DVec3 normal = area_of(outline) / area;
                    // Into a plane that is not one of the axes'; an isometry.
                    const DVec3 u(2.0 / 3, 2.0 / 3, 1.0 / 3), v(-2.0 / 3, 1.0 / 3, 2.0 / 3), w = glm::cross(u, v);
                    for (DVec3& p : outline) p = scale * (p.x * u + p.y * v);
                    Cut result = cut(outline);
                    CHECK(result.is_simple);
                    for (DVec3& p : result.mesh.positions) p /= scale;
                    CHECK(area_of(result.mesh, normal.z * w) == lightswitch::test::relative(area, 1e-9));
                }
}

TEST_CASE("concave polygons in files have their area, whichever corner comes first") {
    const std::filesystem::path data = std::filesystem::path(test::folder()) / "data/concave";
    const Folder folder;
    for (const auto& [name, area] : {std::pair("arrow.obj", 1.3), std::pair("star.obj", 1.17557)}) {
        const Outline outline = load_obj(data / name).positions;
        for (std::size_t first = 0; first < outline.size(); ++first) {
            Notices notices;
            const Mesh obj = load_obj(folder.write("mesh.obj", obj_of(outline, first)), FileNormals::use, &notices);
            CHECK(area_of(obj, {0, 0, 1}) == lightswitch::test::relative(area, 1e-6));
            const Mesh ply = load_ply(folder.write("mesh.ply", ply_of(outline, first)), FileNormals::use, &notices);
            CHECK(area_of(ply, {0, 0, 1}) == lightswitch::test::relative(area, 1e-6));
            CHECK(notices.empty());
        }
    }
    CHECK(area_of(load_ply(data / "star.ply"), {0, 0, 1}) == lightswitch::test::relative(1.17557, 1e-6));
}

TEST_CASE("a polygon remains a fan where its fan covers it") {
    const auto fan = [](std::size_t corners) {
        std::vector<Triangle> triangles;
        for (std::uint32_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
        return triangles;
    };
    // Corners on lines, pressed in by as much as a float rounds.
    Outline rounded;
    for (int i = 0; i < 24; ++i) {
        const double angle = std::numbers::pi / 6 * (i / 2);
        const DVec3 p(std::cos(angle), std::sin(angle), 0),
            q(std::cos(angle + std::numbers::pi / 6), std::sin(angle + std::numbers::pi / 6), 0);
        rounded.push_back(i % 2 ? (0.5 - 2e-8) * (p + q) : p);
    }
    const Outline convex[] = {
        around(7, [](int) { return 3; }),
        in_plane({{0, 0}, {0, 0}, {1, 0}, {2, 0}, {2, 2}, {2, 2}, {1, 2}, {0, 2}}),
        {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}},  // not plane
        rounded,
    };
    for (const Outline& outline : convex)
        for (std::size_t first = 0; first < outline.size(); ++first) {
            Outline turned = outline;
            std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
            const Cut result = cut(turned);
            CHECK(result.is_simple);
            CHECK(result.mesh.triangles == fan(turned.size()));
        }
    CHECK(cut(in_plane({{0, -0.3}, {1, -1}, {0, 1}, {-1, -1}})).mesh.triangles == fan(4));
    CHECK(cut(in_plane({{1, -1}, {0, 1}, {-1, -1}, {0, -0.3}})).mesh.triangles != fan(4));
}

TEST_CASE("a polygon that crosses itself or has no area loads with a notice") {
    const Outline outlines[] = {
        in_plane({{0, 0}, {2, 2}, {2, 0}, {0, 1}}),                            // a bow tie
        in_plane({{3, 0}, {-2, 2}, {1, -3}, {1, 3}, {-2, -2}}),                // a pentagram
        in_plane({{0, 0}, {1, 1}, {1, 0}, {0, 1}}),                            // a bow tie of equal halves
        in_plane({{0, 0}, {1, 0}, {3, 0}, {2, 0}}),                            // a line
        in_plane({{1, 1}, {1, 1}, {1, 1}, {1, 1}}),                            // a point
        in_plane({{0, 0}, {2, 0}, {1, 1}, {0, 2}, {2, 3}, {1, 1}}),            // crosses in a corner
        in_plane({{4, 3}, {0, 4}, {2, 1}, {0, 1}, {2, 2}, {4, 3}}),            // all triangles could face one way
        in_plane({{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}, {2, 0}, {1, 2}}),  // around the first corner and on
        in_plane({{1, 0}, {0, 3}, {2, 3}, {0, -1}, {0, 2}, {3, 2}, {3, 0}}),   // two strips, no corner in the other
    };
    const Folder folder;
    for (const Outline& outline : outlines) {
        Notices notices;
        const Mesh obj = load_obj(folder.write("mesh.obj", obj_of(outline, 0)), FileNormals::use, &notices);
        const Mesh ply = load_ply(folder.write("mesh.ply", ply_of(outline, 0)), FileNormals::use, &notices);
        CHECK(obj.triangles.size() == outline.size() - 2);
        CHECK(ply.triangles == obj.triangles);
        REQUIRE(notices.size() == 2);
        const std::string line = std::to_string(outline.size() + 1), what = "the polygon crosses itself or has no area";
        CHECK_MESSAGE(contains(notices[0], "mesh.obj:" + line + ": " + what), notices[0]);
        CHECK_MESSAGE(contains(notices[1], "mesh.ply:" + std::to_string(outline.size() + 10) + ": face 0: " + what),
                      notices[1]);
    }
    // Once for the whole file.
    Notices notices;
    load_obj(folder.write("mesh.obj", obj_of(outlines[0], 0) + "f 1 2 3 4\nf 1 2 3\nf 1 2 3 4\n"), FileNormals::use,
             &notices);
    REQUIRE(notices.size() == 1);
    CHECK_MESSAGE(contains(notices[0], "mesh.obj:5: the polygon"), notices[0]);
    CHECK_MESSAGE(notices[0].ends_with(" (3 times)"), notices[0]);
}

TEST_CASE("polygons of 100 000 corners are cut") {
    std::minstd_rand random(1);
    const Outline outlines[] = {
        around(100'000, [](int i) { return 2 + std::sin(0.001 * i); }),
        around(100'000, [&](int) { return 0.1 + 1e-9 * double(random()); }),
        comb(100'000),
    };
    for (Outline outline : outlines) {
        std::rotate(outline.begin(), outline.begin() + 12345, outline.end());
        const double area = glm::length(area_of(outline));
        const Cut result = cut(outline);
        CHECK(result.is_simple);
        CHECK(area_of(result.mesh, {0, 0, 1}) == lightswitch::test::relative(area, 1e-9));
    }
}
