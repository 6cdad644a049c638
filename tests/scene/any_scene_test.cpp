#include <lightswitch/scene/any_scene.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;

namespace {

LibraryDescription with(const AnyMaterial& bsdf) {
    LibraryDescription scene;
    scene.film.width = scene.film.height = 8;
    scene.add(rectangle(), scene.add(bsdf));
    return scene;
}

template <class T>
bool becomes(const LibraryDescription& scene) {
    const AnyScene built = build_any(scene, {.embree_config = "threads=1"});
    const bool named = std::visit([](const auto& s) { return s.statistics().triangles == 2; }, built);
    return named && std::holds_alternative<T>(built);
}

/// A model of one's own.
struct Soot {
    static constexpr bool specular = false;
    BsdfValue evaluate(const Vec3&, const Vec3&, Transport) const { return {}; }
    Maybe<BsdfSample> sample(const Vec3&, const Vec3&, Transport) const { return {}; }
    std::string problem() const { return {}; }
};

}  // namespace

TEST_CASE("any scene: a description takes models of one's own, and so does a scene that has a place for them") {
    LibraryDescription scene = with(Soot{});
    scene.add(Lambert{});
    const auto built = build_scene<Bsdfs<Lambert, Soot>>(scene);
    CHECK(built.statistics().triangles == 2);
    CHECK(build_scene<Bsdfs<Textured<Lambert>, Soot>>(scene).statistics().triangles == 2);
    std::string message;
    try {
        build_any(scene);
    } catch (const Error& error) {
        message = error.what();
    }
    CHECK(message.find("has no place for that surface model") != std::string::npos);
}

TEST_CASE("any scene: the smallest type that holds everything") {
    CHECK(becomes<DiffuseScene>(with(Lambert{})));
    LibraryDescription both = with(Lambert{});
    both.materials[0].two_sided = true;
    CHECK(becomes<DiffuseScene>(both));
    for (const AnyMaterial& bsdf : {AnyMaterial(Conductor{}), AnyMaterial(RoughConductor{}), AnyMaterial(Dielectric{})})
        CHECK(becomes<FullScene>(with(bsdf)));

    LibraryDescription scene = with(Lambert{});
    scene.shapes[0].emission = Rgb(1);
    CHECK(becomes<DiffuseScene>(scene));
    scene.add(Sphere{}, 0);
    CHECK(becomes<DiffuseScene>(scene));
    scene.shapes.back().emission = Rgb(1);
    CHECK(becomes<FullScene>(scene));

    for (const Source& source :
         {Source(PointSource{{0, 0, 1}, Rgb(1)}), Source(DirectionalSource{}), Source(EnvironmentSource{})}) {
        LibraryDescription lit = with(Lambert{});
        lit.add(source);
        CHECK(becomes<FullScene>(lit));
    }
    // A material that nothing uses still counts: it must have a place.
    LibraryDescription unused = with(Lambert{});
    unused.add(Dielectric{});
    CHECK(becomes<FullScene>(unused));
}

TEST_CASE("any scene: the first of any types that can hold it") {
    using Types = std::variant<DiffuseScene, TexturedScene, FullScene>;
    CHECK(std::holds_alternative<DiffuseScene>(build_any<Types>(with(Lambert{}))));
    CHECK(std::holds_alternative<TexturedScene>(build_any<Types>(with(Plastic{}))));
    CHECK(std::holds_alternative<TexturedScene>(build_any<Types>(with(Principled{.anisotropic = 0.5f}))));
    LibraryDescription layered = with(Lambert{});
    layered.shapes[0].material = layered.add(Mask{0, Texture(Rgb(0.5f))});
    CHECK(std::holds_alternative<TexturedScene>(build_any<Types>(layered)));
}

TEST_CASE("any scene: names begin with the word that the program shows") {
    LibraryDescription scene = with(Lambert{});
    CHECK(scene_type_name(build_any(scene)).substr(0, 8) == "diffuse:");
    scene.add(Source(PointSource{}));
    CHECK(scene_type_name(build_any(scene)).substr(0, 5) == "full:");
}

TEST_CASE("any scene: errors of the description pass through") {
    LibraryDescription scene = with(Lambert{Rgb(1.5f)});
    scene.materials[0].origin = {"room.xml", 3, "<bsdf>"};
    CHECK_THROWS_WITH_AS(build_any(scene), doctest::Contains("room.xml:3: <bsdf>: "), Error);
}
