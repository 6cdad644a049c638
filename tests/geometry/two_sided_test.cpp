#include <lightswitch/method/path_tracer_nee.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace lightswitch;
using test::relative;

namespace {

/// A square of that material around the origin, which faces +z, under white light; the camera looks along -z from
/// `eye_z` above it, or along +z from below.
LibraryDescription square_seen_from(double eye_z, bool two_sided, const AnyMaterial& bsdf = Lambert{Rgb(0.5f)}) {
    LibraryDescription scene;
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.materials.push_back({bsdf, {}, two_sided});
    scene.add(std::move(mesh), 0);
    scene.add(EnvironmentSource{Rgb(1)});
    scene.camera.to_world = CameraDescription::look_at({0.1, 0.2, eye_z}, {0.1, 0.2, 0}, {0, 1, 0});
    scene.film.width = scene.film.height = 8;
    return scene;
}

double brightness(const LibraryDescription& description) {
    return render(build_scene<AllBsdfs, AllLights>(description), PathTracerNee{}, {.samples = 64}).mean().y;
}

}  // namespace

TEST_CASE("two-sided: models see their front, in a frame that differs from the other side's in its normal alone") {
    SurfacePoint point;
    point.normal = point.shading_normal = normalize(Vec3(1, 2, 3));
    const Vec3 above = normalize(Vec3(0.3f, 0.2f, 0.9f)), below = -above;
    for (const bool both : {false, true}) {
        point.material = MaterialIndex(3, 12345, both ? MaterialIndex::both_sides : 0);
        CHECK(point.material.kind() == 3);
        CHECK(point.material.position() == 12345);
        point.wo = above;
        const Basis front = point.shading_frame();
        CHECK(front.normal == point.shading_normal);
        point.wo = below;
        const Basis back = point.shading_frame();
        CHECK(back.normal == (both ? -point.shading_normal : point.shading_normal));
        CHECK(back.tangent == front.tangent);
        CHECK(back.bitangent == front.bitangent);
        CHECK((back.to_local(below).z > 0) == both);
    }
}

TEST_CASE("two-sided: the back looks like the front, and is black otherwise") {
    const double front = brightness(square_seen_from(3, false));
    CHECK(front > 0.4);
    CHECK(brightness(square_seen_from(3, true)) == front);
    CHECK(brightness(square_seen_from(-3, false)) < 0.5 * front);
    CHECK(brightness(square_seen_from(-3, true)) == relative(front, 0.02));
    const RoughConductor metal{.distribution = Facets::ggx, .alpha_u = 0.3f, .alpha_v = 0.3f};
    CHECK(brightness(square_seen_from(-3, true, metal)) ==
          relative(brightness(square_seen_from(3, false, metal)), 0.02));
}
