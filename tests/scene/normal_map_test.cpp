// Which way normal maps turn the normal.

#include "../support/relative.hpp"

#include <lightswitch/bsdf/lambert.hpp>
#include <lightswitch/scene/build.hpp>
#include <lightswitch/texture/textured.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace lightswitch;

namespace {

/// The shading normal in the middle of a square that looks along +z, under a map that says (0, 0.6, 0.8) everywhere, or
/// `stored`. Without a mirror u grows with x, and v, as on an upright image, against y.
Vec3 mapped_normal(bool mirror_u, bool mirror_v, bool against_v, float scale = 1, Vec3 stored = {0, 0.6f, 0.8f}) {
    SceneDescription<Textured<Lambert>> scene;
    Mesh mesh = rectangle();
    for (Vec2& uv : mesh.uvs) uv = {mirror_u ? 1 - uv.x : uv.x, mirror_v ? uv.y : 1 - uv.y};
    const std::size_t inner = scene.add(Textured<Lambert>());
    const std::size_t map = scene.add(NormalMap{
        .inner = inner, .normals = Texture(0.5f * stored + Vec3(0.5f)), .scale = scale, .against_v = against_v});
    scene.add(std::move(mesh), map);
    const auto built = build_scene<Bsdfs<Textured<Lambert>>>(scene);
    const auto point = built.intersect(Ray{.origin = {0.1f, 0.1f, 0.5f}, .direction = {0, 0, -1}});
    REQUIRE(point);
    return point->shading_normal;
}

bool near(const Vec3& a, const Vec3& b) { return length_squared(a - b) < 1e-10f; }

}  // namespace

TEST_CASE("the second direction of a normal map is a quarter turn from where u grows, or against v") {
    const Vec3 up(0, 0.6f, 0.8f), down(0, -0.6f, 0.8f);
    CHECK(near(mapped_normal(false, false, false), up));
    CHECK(near(mapped_normal(false, true, false), up));
    CHECK(near(mapped_normal(true, false, false), down));
    CHECK(near(mapped_normal(true, true, false), down));
    CHECK(near(mapped_normal(false, false, true), up));
    CHECK(near(mapped_normal(false, true, true), down));
    CHECK(near(mapped_normal(true, false, true), up));
    CHECK(near(mapped_normal(true, true, true), down));
}

TEST_CASE("the scale of a normal map counts across the normal") {
    const Vec3 stored(0.6f, 0, 0.8f);
    CHECK(near(mapped_normal(false, false, false, 2, stored), normalize(Vec3(1.2f, 0, 0.8f))));
    CHECK(near(mapped_normal(true, false, true, 0.5f, {0.48f, 0.36f, 0.8f}), normalize(Vec3(-0.24f, 0.18f, 0.8f))));
    CHECK(near(mapped_normal(false, false, true, 0, stored), Vec3(0, 0, 1)));
}
