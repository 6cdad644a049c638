// What the camera sees beside light, on scenes where geometry says what that is.

#include "support/errors.hpp"
#include "support/random_scenes.hpp"
#include "support/relative.hpp"
#include "support/renders.hpp"

#include <lightswitch/method/extra_outputs.hpp>
#include <lightswitch/method/silhouette.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <set>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

FullScene build(const LibraryDescription& description) { return build_scene<AllBsdfs, AllLights>(description); }

/// What an output says of one camera ray.
template <class SceneType, class M>
Rgb seen(const SceneType& scene, const M& method, const Vec2& pixel, const Vec2& lens = Vec2(0.5f)) {
    const IterationPoints points(Sampling::independent, 1, 0);
    Sampler sampler(points, 0, 0);
    return method.radiance(scene, scene.camera().ray(pixel, lens), sampler);
}

/// A camera at height 10 that looks down, in the middle of its image along the axis.
LibraryDescription looking_down() {
    LibraryDescription scene;
    scene.camera.to_world = CameraDescription::look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    scene.camera.fov = glm::degrees(2 * std::atan(0.2));
    scene.film.width = scene.film.height = 16;
    return scene;
}

Mesh square_at(double z, double half_side = 4) {
    return quad({-half_side, -half_side, z}, {half_side, -half_side, z}, {half_side, half_side, z},
                {-half_side, half_side, z});
}

/// It sees 4 x 4 of the plane z = 0: column x, row y looks at (x / 4 - 2, 2 - y / 4).
LibraryDescription describe_plane(const AnyMaterial& bsdf = Lambert{Rgb(0.5f)}) {
    LibraryDescription scene = looking_down();
    scene.add(square_at(0), scene.add(bsdf));
    return scene;
}

constexpr Vec2 middle(8, 8);

bool near(const Rgb& a, const Rgb& b, float tolerance = 1e-6f) { return max_component(glm::abs(a - b)) <= tolerance; }

/// A surface model that says its colour, and one that says nothing.
struct Silent {
    static constexpr bool specular = false;
    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }
    Maybe<BsdfSample> sample(const Vec3&, const Vec3&, Transport) const { return {}; }
    std::string problem() const { return {}; }
};
struct Outspoken : Silent {
    Rgb colour{0};
    Rgb albedo() const { return colour; }
    PhongTerms phong() const { return {}; }
};

}  // namespace

TEST_CASE("albedo: the walls of the Cornell box have their colours, the lamp is white") {
    const auto scene = stock::cornell_box();
    int walls = 0, lamp = 0;
    for (int y = 0; y < scene.camera().height(); ++y)
        for (int x = 0; x < scene.camera().width(); ++x) {
            const Vec2 pixel(float(x) + 0.3f, float(y) + 0.6f);  // where walls meet lie centres of pixels
            const Rgb at = seen(scene, Position{}, pixel), albedo = seen(scene, Albedo{}, pixel);
            const auto is = [](float a, float b) { return std::abs(a - b) < 1e-4f; };
            if (is(at.x, -1)) CHECK(albedo == Rgb(0.570068f, 0.0430135f, 0.0443706f));
            else if (is(at.x, 1)) CHECK(albedo == Rgb(0.105421f, 0.37798f, 0.076425f));
            else if (is(at.z, -1) || is(at.y, 1)) CHECK(albedo == Rgb(0.885809f, 0.698859f, 0.666422f));
            else if (is(at.y, 0.99f)) CHECK(albedo == Rgb(1));
            walls += is(std::abs(at.x), 1) || is(at.z, -1);
            lamp += is(at.y, 0.99f);
        }
    CHECK(walls > 10000);
    CHECK(lamp > 100);
}

TEST_CASE("albedo: what the model says, or its Phong terms, or grey; never above 1") {
    CHECK(detail::albedo_of(Outspoken{{}, Rgb(0.1f, 0.2f, 0.3f)}) == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(detail::albedo_of(Silent{}) == Rgb(0.5f));
    const RoughConductor gold{.distribution = Facets::ggx,
                              .alpha_u = 0.3f,
                              .alpha_v = 0.3f,
                              .eta = {0.14f, 0.37f, 1.44f},
                              .k = {3.98f, 2.39f, 1.6f}};
    CHECK(seen(build(describe_plane(gold)), Albedo{}, middle) == fresnel_conductor(1, gold.eta, gold.k));
    SceneDescription<Outspoken> own;
    const std::size_t bright = own.add(Outspoken{{}, Rgb(0.25f, 7, -1)});
    own.add(Sphere{{0, 0, 3}, 1}, bright);
    CHECK(seen(build_scene<Bsdfs<Outspoken>, AllLights>(own), Albedo{}, {128, 128}) == Rgb(0.25f, 1, 0));
}

TEST_CASE("albedo: emission is added, from the front") {
    for (const bool flipped : {false, true}) {
        LibraryDescription description = looking_down();
        const Mesh lamp = square_at(0);
        description.add(flipped ? lamp.flipped() : lamp, description.add(Lambert{Rgb(0.2f)}), Rgb(0.3f, 0.5f, 9));
        CHECK(near(seen(build(description), Albedo{}, middle), flipped ? Rgb(0.2f) : Rgb(0.5f, 0.7f, 1)));
    }
}

TEST_CASE("albedo: a mirror shows what is seen in it, times its own colour") {
    LibraryDescription description = describe_plane(Conductor{.reflectance = {0.9f, 0.8f, 0.5f}});
    const std::size_t paint = description.add(Lambert{{0.5f, 0.25f, 0.75f}});
    CHECK(seen(build(description), Albedo{}, middle) == Rgb(0));  // nothing is seen in it
    description.add(square_at(12).flipped(), paint);              // behind the camera
    const FullScene scene = build(description);
    CHECK(near(seen(scene, Albedo{}, middle), {0.45f, 0.2f, 0.375f}));
    CHECK(near(seen(scene, Albedo{.max_bounces = 0}, middle), Rgb(1)));
    description.shapes[1].emission = Rgb(0.1f, 0.1f, 0.2f);
    CHECK(near(seen(build(description), Albedo{}, middle), {0.54f, 0.28f, 0.475f}));
    // From behind it is black.
    std::get<Mesh>(description.shapes[0].geometry) = square_at(0).flipped();
    CHECK(seen(build(description), Albedo{}, middle) == Rgb(0));
}

TEST_CASE("albedo: two mirrors that face each other are white after the last bounce") {
    LibraryDescription description = describe_plane(Conductor{.reflectance = {1, 0.5f, 0.25f}});
    description.add(square_at(12).flipped(), 0);
    const Rgb two = seen(build(description), Albedo{.max_bounces = 2}, middle);
    CHECK(near(two, {1, 0.25f, 0.0625f}));
    CHECK(near(seen(build(description), Albedo{}, middle), {1, 0x1p-8f, 0x1p-16f}));
}

TEST_CASE("albedo: clear glass shows what is behind it, and beyond the critical angle what it reflects") {
    const Rgb tint(0.5f, 1, 0.25f), paint(0.5f, 0.25f, 0.75f);
    LibraryDescription pane = looking_down();
    const std::size_t glass = pane.add(Dielectric{.eta = 1.5f, .transmittance = tint});
    pane.add(square_at(5), glass);
    pane.add(square_at(4).flipped(), glass);
    pane.add(square_at(0), pane.add(Lambert{paint}));
    pane.add(square_at(12).flipped(), pane.add(Lambert{Rgb(0.9f)}));
    const FullScene clear = build(pane);
    for (const float x : {0.5f, 8.0f, 15.5f}) CHECK(near(seen(clear, Albedo{}, {x, 8}), tint * tint * paint));

    // Out of the glass: a colour is not squeezed like radiance.
    LibraryDescription outwards = looking_down();
    outwards.add(square_at(5).flipped(), outwards.add(Dielectric{.eta = 1.5f, .transmittance = tint}));
    outwards.add(square_at(0), outwards.add(Lambert{paint}));
    CHECK(near(seen(build(outwards), Albedo{}, middle), tint * paint));

    // From inside of glass, 60 degrees from its surface's normal.
    LibraryDescription inside = looking_down();
    inside.camera.to_world = CameraDescription::look_at({-std::sqrt(3.0), 0, 1}, {0, 0, 0}, {0, 1, 0});
    const Dielectric water{.eta = 1.5f, .reflectance = Rgb(0.5f)};
    inside.add(square_at(0, 9).flipped(), inside.add(water));
    inside.add(square_at(-1, 9), inside.add(Lambert{Rgb(0.9f)}));
    inside.add(square_at(2, 9).flipped(), inside.add(Lambert{paint}));
    CHECK(near(seen(build(inside), Albedo{}, middle), 0.5f * paint));
}

TEST_CASE("albedo: mirrors and glass bring no noise") {
    LibraryDescription description = looking_down();
    description.add(Sphere{{0, 0, 0}, 5}, description.add(Dielectric{}));  // fills the view
    description.add(square_at(-9, 100), description.add(Lambert{{0.5f, 0.25f, 0.75f}}));
    const FullScene scene = build(description);
    const Image one = render(scene, Albedo{}, {.samples = 1}, {.sampling = Sampling::independent});
    for (const Rgb& p : one.pixels()) CHECK(near(p, {0.5f, 0.25f, 0.75f}));
}

TEST_CASE("normal: of a sphere, on the side that is seen") {
    for (const bool inward : {false, true})
        for (const bool within : {false, true}) {
            LibraryDescription description = looking_down();
            const DVec3 center = within ? DVec3(0.5, 0, 9) : DVec3(0.1, -0.2, 3);
            description.add(Sphere{.center = center, .radius = within ? 3.0 : 1.25, .inward = inward},
                            description.add(Lambert{}));
            const FullScene scene = build(description);
            int hits = 0;
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) {
                    const DVec3 direction = glm::normalize(DVec3((x + 0.5) / 40 - 0.2, 0.2 - (y + 0.5) / 40, -1));
                    const DVec3 from = DVec3(0, 0, 10) - center;
                    const double b = glm::dot(from, direction), radius = within ? 3.0 : 1.25;
                    const double root = b * b - glm::dot(from, from) + radius * radius;
                    const Rgb normal = seen(scene, ShadingNormal{}, {float(x) + 0.5f, float(y) + 0.5f});
                    if (root < 0) {
                        CHECK(normal == Rgb(0));
                        continue;
                    }
                    const DVec3 expected = (from + (within ? -b + std::sqrt(root) : -b - std::sqrt(root)) * direction) /
                                           (within ? -radius : radius);
                    // At the edge of the disk the rounding of the ray moves the hit by a root of it.
                    CHECK(glm::length(DVec3(normal) - expected) < 1e-6 / std::max(std::sqrt(root), 1e-2));
                    ++hits;
                }
            CHECK(hits > (within ? 255 : 100));
        }
}

TEST_CASE("normal: flat surfaces and interpolated normals face the viewer, the latter as the surface does") {
    for (const bool flipped : {false, true}) {
        LibraryDescription description = looking_down();
        Mesh mesh = square_at(0);
        if (flipped) mesh = mesh.flipped();
        description.add(mesh, description.add(Lambert{}));
        CHECK(seen(build(description), ShadingNormal{}, middle) == Rgb(0, 0, 1));
        // Bent beyond the horizon of the viewer: it stays on the side of the surface and does not jump.
        const DVec3 bent = glm::normalize(DVec3(3, 0, -0.1)) * (flipped ? -1.0 : 1.0);
        mesh.normals.assign(mesh.positions.size(), bent);
        std::get<Mesh>(description.shapes[0].geometry) = mesh;
        CHECK(near(seen(build(description), ShadingNormal{}, middle), Rgb(glm::normalize(DVec3(3, 0, -0.1)))));
    }
}

TEST_CASE("depth and position of a plane: near, far from the origin, and at any scale") {
    const LibraryDescription plane = describe_plane();
    const auto check = [](const FullScene& scene, double factor, const DVec3& shift, double precision) {
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const Vec2 pixel(float(x) + 0.5f, float(y) + 0.5f);
                const DVec3 at((x + 0.5) / 4 - 2, 2 - (y + 0.5) / 4, 0);
                CHECK(seen(scene, Depth{}, pixel).x == relative(factor * glm::length(at - DVec3(0, 0, 10)), 3e-7));
                CHECK(glm::length(DVec3(seen(scene, Position{}, pixel)) - (factor * at + shift)) < precision);
            }
    };
    check(build(plane), 1, DVec3(0), 2e-6);
    const DVec3 far(1e6, -2e6, 3e6);
    // Half of a float's step at 3e6 is 0.125 in z, at 2e6 and 1e6 as much and half of it less.
    check(build(mapped(
              plane, [&](const DVec3& p) { return p + far; }, 1)),
          1, far, 0.19);
    const double large = std::ldexp(1.0, 20);
    check(build(scaled(plane, 20)), large, DVec3(0), 2e-6 * large);
    for (const auto& method : {ExtraOutput(Depth{}), ExtraOutput(Position{})}) {
        const Image base = render_outputs(build(plane), {method}, 4)[0].image;
        Image scaled_up = render_outputs(build(scaled(plane, 20)), {method}, 4)[0].image;
        for (Rgb& p : scaled_up.pixels()) p *= 0x1p-20f;
        CHECK(identical(base, scaled_up));
    }
}

TEST_CASE("depth: from the camera, wherever its rays begin") {
    const auto check = [](LibraryDescription description, double height) {
        const FullScene scene = build(description);
        for (const Vec2 pixel : {Vec2(0.5f, 0.5f), Vec2(8, 3), Vec2(15.5f, 9)})
            for (const Vec2 lens : {Vec2(0.5f), Vec2(0.1f, 0.9f)}) {
                const double cosine = -double(scene.camera().ray(pixel, lens).direction.z);
                CHECK(seen(scene, Depth{}, pixel, lens).x == relative(height / cosine, 5e-7));
            }
    };
    LibraryDescription description = describe_plane();
    check(description, 10);
    description.camera.near_clip = 4;
    check(description, 10);
    description.camera.aperture_radius = 0.5;
    description.camera.focus_distance = 7;
    check(description, 10);
    description.camera.projection = CameraDescription::Projection::orthographic;
    description.camera.half_width = 2;
    check(description, 10);
    description.camera.aperture_radius = 0;
    check(description, 10);
    for (const double height : {1000.0, 1e9}) {  // rays begin at the scene's bounding sphere
        LibraryDescription distant = describe_plane();
        distant.camera.to_world = CameraDescription::look_at({0, 0, height}, {0, 0, 0}, {0, 1, 0});
        distant.camera.fov = glm::degrees(2 * std::atan(2 / height));
        check(distant, height);
    }
}

namespace {

/// Looks down; in render space.
struct OwnCamera {
    Ray ray(const Vec2&, const Vec2&) const { return {.origin = {0, 0, 0.75f}, .direction = {0, 0, -1}}; }
    bool has_lens() const { return false; }
    int width() const { return 4; }
    int height() const { return 3; }
};

}  // namespace

TEST_CASE("depth: with a camera that does not say where its rays begin, from there") {
    const FullScene scene = build(describe_plane());
    const auto own = scene.with_camera(OwnCamera{});
    const Image depth = render(own, Depth{}, {.samples = 1});
    CHECK(depth(1, 1) == Rgb(static_cast<float>(scene.space().scene_length(0.75))));
}

TEST_CASE("what belongs to no surface is 0") {
    LibraryDescription description = looking_down();
    description.add(square_at(20), description.add(Lambert{}));  // behind the camera
    description.add(EnvironmentSource{Rgb(2)});
    for (const Layer& layer : render_outputs(build(description), extra_outputs(), 2)) {
        CAPTURE(layer.name);
        CHECK(layer.image.mean() == DVec3(0));
    }
}

TEST_CASE("shape and primitive: numbers of what the centre of a pixel sees, whatever the filter and the lens") {
    LibraryDescription description = looking_down();
    const std::size_t grey = description.add(Lambert{});
    description.add(quad({-9, -2, 0}, {0, -2, 0}, {0, 2, 0}, {-9, 2, 0}), grey);      // left half
    description.add(Sphere{{0.8, 1, 1}, 0.7}, grey);                                  // right, above
    description.add(Mesh{{{9, 9, 0}, {9, 9, 0}, {9, 9, 0}}, {}, {{0, 1, 2}}}, grey);  // has no area
    description.add(Sphere{{0.8, -1, 1}, 0.7}, grey);
    description.add(quad({0.1, -3, -5}, {9, -3, -5}, {9, 3, -5}, {0.1, 3, -5}), grey);
    description.film.filter = Filter::gaussian();
    description.camera.aperture_radius = 0.3;
    description.camera.focus_distance = 10;
    const FullScene scene = build(description);
    const Image shape = render(scene, ShapeNumber{}, {.samples = 7});
    const Image primitive = render(scene, PrimitiveNumber{}, {.samples = 3}, {.seed = 9});
    std::set<std::pair<float, float>> found;
    for (std::size_t i = 0; i < shape.pixels().size(); ++i)
        found.insert({shape.pixels()[i].x, primitive.pixels()[i].x});
    // Two triangles of two quads, then the spheres.
    CHECK(found == std::set<std::pair<float, float>>{{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 1}, {3, 2}});
    CHECK(shape(3, 8) == Rgb(1));
    CHECK(shape(11, 4) == Rgb(3));
    CHECK(primitive(11, 4) == Rgb(1));
    CHECK(primitive(11, 12) == Rgb(2));
    CHECK(shape(14, 8) == Rgb(2));
    CHECK(identical(shape, render(scene, ShapeNumber{}, {.samples = 1}, {.seed = 5})));
}

TEST_CASE("shape and primitive: numbers of shapes in groups, the same in every instance") {
    LibraryDescription description = looking_down();
    const std::size_t grey = description.add(Lambert{});
    description.add(quad({-9, -9, -5}, {9, -9, -5}, {9, 9, -5}, {-9, 9, -5}), grey);
    description.add(Sphere{{0, 0, 0}, 0.3}, grey);
    using Group = LibraryDescription::Group;
    Group flat{.shapes = {}, .origin = {}}, round = flat;
    flat.shapes.push_back({.geometry = rectangle(), .material = grey, .emission = {}, .origin = {}});
    round.shapes.push_back({.geometry = rectangle(), .material = grey, .emission = {}, .origin = {}});
    round.shapes.push_back({.geometry = Sphere{{0, 0, 1}, 0.9}, .material = grey, .emission = {}, .origin = {}});
    description.groups = {flat, round};
    const auto at = [](double x, double y) {
        DMat4 m(0.5);
        m[3] = glm::dvec4(x, y, 0, 1);
        return m;
    };
    description.instances = {{0, at(-1.5, 1.5), {}}, {0, at(-1.5, -1.5), {}}, {1, at(1.5, 1.5), {}}};
    const FullScene scene = build(description);
    const Image shape = render(scene, ShapeNumber{}, {.samples = 1});
    const Image primitive = render(scene, PrimitiveNumber{}, {.samples = 1});
    std::set<std::pair<float, float>> found;
    for (std::size_t i = 0; i < shape.pixels().size(); ++i)
        found.insert({shape.pixels()[i].x, primitive.pixels()[i].x});
    // The floor, the first and the second group's rectangle, and two spheres, of which the one in place is the first.
    CHECK(found == std::set<std::pair<float, float>>{{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 1}, {3, 2}, {4, 1}, {4, 2}});
}

TEST_CASE("several outputs at once are those that their methods make, for any threads") {
    LibraryDescription description = random_scene(3);
    description.film.width = 53;
    description.film.height = 37;
    description.camera.aperture_radius = 0.05;
    const FullScene scene = build(description);
    for (const Sampling sampling : {Sampling::sobol, Sampling::independent}) {
        const Settings settings{.seed = 7, .threads = 2, .sampling = sampling};
        const std::vector<Layer> layers = render_outputs(scene, extra_outputs(), 5, settings);
        REQUIRE(layers.size() == std::variant_size_v<ExtraOutput>);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            CAPTURE(layers[i].name);
            CHECK(layers[i].name == output_name(extra_outputs()[i]));
            const Image alone =
                std::visit([&](const auto& output) { return render(scene, output, {.samples = 5}, settings); },
                           extra_outputs()[i]);
            CHECK(identical(layers[i].image, alone));
            CHECK(alone.mean() != DVec3(0));
        }
        for (const int threads : {1, 8}) {
            const auto others =
                render_outputs(scene, extra_outputs(), 5, {.seed = 7, .threads = threads, .sampling = sampling});
            for (std::size_t i = 0; i < layers.size(); ++i) CHECK(identical(layers[i].image, others[i].image));
        }
    }
}

TEST_CASE("the rays are those of the image") {
    LibraryDescription description = looking_down();
    description.add(Sphere{{0.1, -0.2, 3}, 1.1}, description.add(Lambert{Rgb(1)}));
    description.film.filter = Filter::tent();
    const FullScene scene = build(description);
    const Image coverage = render(scene, Silhouette{.color = Rgb(1)}, {.samples = 12}, {.seed = 4});
    CHECK(identical(coverage, render_outputs(scene, {Albedo{}}, 12, {.seed = 4})[0].image));
}

namespace {

/// Counts the rays that a scene is asked for.
struct CountingScene {
    const FullScene& inner;
    std::atomic<int>& rays;

    auto intersect(const Ray& ray) const {
        ++rays;
        return inner.intersect(ray);
    }
    bool occluded(const Ray& ray) const { return inner.occluded(ray); }
    decltype(auto) with_bsdf(const auto& point, auto&& f) const { return inner.with_bsdf(point, f); }
    Rgb emitted(const SurfacePoint& point, const Vec3& direction) const { return inner.emitted(point, direction); }
    const auto& camera() const { return inner.camera(); }
    const auto& film() const { return inner.film(); }
    const auto& space() const { return inner.space(); }
    auto identify(const Ray& ray) const { return inner.identify(ray); }
    const std::string& name() const { return inner.name(); }
    const std::string& camera_id() const { return inner.camera_id(); }
};

}  // namespace

TEST_CASE("one ray per sample serves all outputs, and none is traced when nothing is asked for") {
    const FullScene scene = build(describe_plane());
    std::atomic<int> rays = 0;
    const CountingScene counting{scene, rays};
    CHECK(render_outputs(counting, {Albedo{}, ShadingNormal{}, Depth{}, Position{}}, 3).size() == 4);
    CHECK(rays == 3 * 256);
    CHECK(render_outputs(counting, {}, 3).empty());
    CHECK(render_outputs(counting, {ShapeNumber{}}, 3).size() == 1);  // asks Embree itself
    CHECK(rays == 3 * 256);
}

TEST_CASE("outputs can be watched and stopped") {
    const FullScene scene = build(describe_plane());
    std::vector<double> fractions;
    Settings settings;
    settings.observer = [&](const Progress& progress) { fractions.push_back(progress.fraction); };
    const std::vector<ExtraOutput> outputs{PrimitiveNumber{}, Depth{}};
    CHECK(render_outputs(scene, outputs, 4, settings).size() == 2);
    CHECK(fractions == std::vector<double>{0.25, 0.5, 0.75, 1});

    std::stop_source stop;
    settings.stop = stop.get_token();
    std::uint64_t last = 0;
    settings.observer = [&](const Progress& progress) {
        last = progress.iterations;
        if (last == 3) stop.request_stop();
    };
    CHECK(render_outputs(scene, outputs, 100, settings).empty());
    CHECK(last == 3);
    CHECK(render_outputs(scene, {PrimitiveNumber{}}, 4, settings).empty());
    CHECK(message_of([&] { render_outputs(scene, outputs, 0); }).find("give at least 1") != std::string::npos);
}

TEST_CASE("outputs are found by name") {
    for (const ExtraOutput& output : extra_outputs())
        CHECK(output_by_name(output_name(output)).index() == output.index());
    CHECK(message_of([] { output_by_name("colour"); }) ==
          "there is no output \"colour\"; known are albedo, normal, depth, position, shape, primitive");
}

TEST_CASE("on random scenes outputs are finite and within their ranges") {
    for (std::uint32_t seed = 1; seed < 25; ++seed) {
        const FullScene scene = build(random_scene(seed));
        for (const Layer& layer : render_outputs(scene, extra_outputs(), 4, {.seed = seed})) {
            CAPTURE(layer.name);
            for (const Rgb& p : layer.image.pixels()) {
                CHECK(is_finite(p));
                if (layer.name != "normal" && layer.name != "position") CHECK(min_component(p) >= 0);
                if (layer.name == "albedo") CHECK(max_component(p) <= 1);
                if (layer.name == "normal") CHECK(length_squared(p) <= 1.000001f);
            }
        }
    }
}
