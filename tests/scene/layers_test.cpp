// Layers of materials: what a description may say of them, and that it is checked in little time.

#include <lightswitch/scene/any_scene.hpp>

#include "support/errors.hpp"

#include <doctest/doctest.h>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

/// A ball of the last of the materials, which shines.
LibraryDescription luminous_ball(LibraryDescription scene) {
    scene.add(Sphere{}, scene.materials.size() - 1, Rgb(1));
    scene.camera.to_world[3] = glm::dvec4(0, 0, -5, 1);
    return scene;
}

std::string refusal(const LibraryDescription& scene) {
    return message_of([&] { build_scene<TexturedBsdfs, AllLights>(scene); });
}

const Texture half{Rgb(0.5f)};

}  // namespace

TEST_CASE("layers: a material that is used in many ways is looked at once") {
    LibraryDescription scene;
    scene.add(Lambert{});
    for (std::size_t i = 0; i < 60; ++i) scene.add(Blend{i, i, half});  // 2^60 ways down
    CHECK(refusal(luminous_ball(scene)) == "(no error)");
    scene.materials[0].layer = Mask{1, half};
    CHECK(refusal(luminous_ball(scene)).find("contains itself") != std::string::npos);
}

TEST_CASE("layers: what is impossible is refused with a reason") {
    LibraryDescription masked;
    masked.add(Lambert{});
    masked.add(Mask{0, half});
    masked.add(Blend{0, 1, half});
    CHECK(refusal(luminous_ball(masked)).find("a surface that shines cannot be masked") != std::string::npos);
    masked.materials[2].layer = Blend{0, 7, half};
    CHECK(refusal(luminous_ball(masked)).find("the material inside does not exist") != std::string::npos);
    masked.materials[2].layer = Blend{0, 0, Texture(Rgb(1.5f))};
    CHECK(refusal(luminous_ball(masked)).find("the weight has values outside 0 to 1") != std::string::npos);
    masked.materials[2].layer = BumpMap{0, half, infinity};
    CHECK(refusal(luminous_ball(masked)).find("the scale of the bump map") != std::string::npos);

    LibraryDescription deep;
    deep.add(Lambert{});
    for (std::size_t i = 0; i < 65; ++i) deep.add(Blend{i, i, half});
    CHECK(refusal(luminous_ball(deep)).find("more than 64 materials") != std::string::npos);
    // From the top, it is not followed down to its end.
    LibraryDescription downwards;
    for (std::size_t i = 0; i < 100'000; ++i) downwards.add(Mask{i + 1, half});
    downwards.add(Lambert{});
    CHECK(refusal(luminous_ball(downwards)).find("more than 64 materials") != std::string::npos);

    LibraryDescription plain;
    plain.add(Lambert{});
    plain.add(Blend{0, 0, half});
    plain.add(Sphere{}, 1);
    CHECK(message_of([&] { build_scene<AllBsdfs, AllLights>(plain); }).find("no place for layers") !=
          std::string::npos);
}

TEST_CASE("layers: coats lie over models, blends and two sides, and under anything") {
    LibraryDescription scene;
    const std::size_t grey = scene.add(Lambert{}), mirror = scene.add(Conductor{});
    scene.add(Blend{grey, mirror, half});
    scene.add(Coating{2, {}});
    scene.add(BothSides{3, grey});
    scene.add(BumpMap{4, half});
    CHECK(refusal(luminous_ball(scene)) == "(no error)");
    scene.materials[3].layer = Coating{2, {.alpha = 0.3f}};
    CHECK(refusal(luminous_ball(scene)).find("a rough coat cannot lie over a mirror") != std::string::npos);
    scene.materials[3].layer = Coating{2, {.eta = 0}};
    CHECK(refusal(luminous_ball(scene)).find("eta is 0") != std::string::npos);
    scene.materials[3].layer = Coating{9, {}};
    CHECK(refusal(luminous_ball(scene)).find("the material inside does not exist") != std::string::npos);
    scene.materials[3].layer = Coating{2, {}};
    scene.add(Coating{5, {}});
    CHECK(refusal(luminous_ball(scene)).find("cannot lie over another layer that is a bump map") != std::string::npos);
    scene.materials[6].layer = Coating{4, {}};
    CHECK(refusal(luminous_ball(scene)).find("cannot lie over another layer that is a coat") != std::string::npos);
    scene.materials[4].layer = Mask{0, half};
    CHECK(refusal(scene).find("cannot lie over another layer that is a mask") != std::string::npos);
}

TEST_CASE("layers: a smooth coat is a mirror, and what is below is asked inside of it") {
    LibraryDescription scene;
    scene.add(Lambert{Rgb(0.5f)});
    scene.add(Coating{0, {.eta = 1.5f}});
    scene.add(Sphere{}, 1);
    scene.materials[1].two_sided = true;
    scene.camera.to_world[3] = glm::dvec4(0, 0, -5, 1);
    const auto coated = build_scene<TexturedBsdfs, AllLights>(scene);
    CHECK(coated.has_specular());
    const auto point = coated.intersect({.origin = {0, 0, -4}, .direction = {0, 0, 1}});
    REQUIRE(point);
    CHECK(coated.presence(*point) == 1);
    const Vec3 up(0, 0, 1);
    const float value =
        coated.with_bsdf(*point, [&](const auto& bsdf) { return bsdf.evaluate(up, up, Transport::radiance).value.x; });
    CHECK(std::abs(value - 0.96f * 0.96f * 0.5f * inv_pi / 2.25f) < 1e-6f);
    scene.materials[1].layer = Coating{0, {.eta = 1.5f, .alpha = 0.2f}};
    CHECK_FALSE(build_scene<TexturedBsdfs, AllLights>(scene).has_specular());
}
