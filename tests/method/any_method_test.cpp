// Methods chosen at run time, of any variant of methods.

#include "support/errors.hpp"

#include <lightswitch/method/any_method.hpp>

#include <doctest/doctest.h>

using namespace lightswitch;
using lightswitch::test::message_of;

namespace {

struct Mine {
    static constexpr std::string_view name = "mine";
    static constexpr Kind kind = Kind::consistent;
    int max_depth = 7;
    Rgb radiance(const auto&, const Ray&, auto&) const { return Rgb(1); }
};

/// Has the name of one of the library's.
struct Namesake : Mine {
    static constexpr std::string_view name = PathTracer::name;
};

using Beside = append_t<AnyMethod, Mine>;
using Alone = std::variant<Mine, Phong>;

template <class Variant = AnyMethod>
std::string visited() {
    std::string names;
    for_each_method<Variant>([&](const auto& m) { names += std::string(m.name) + " "; });
    return names;
}

}  // namespace

TEST_CASE("methods by name: the library's, and any other variant of methods") {
    static_assert(
        std::is_same_v<append_t<std::variant<Phong>, Mine, Silhouette>, std::variant<Phong, Mine, Silhouette>>);
    CHECK(visited() == "silhouette phong path path-nee light bdpt photon vcm mlt path-guided ");
    CHECK(visited<Beside>() == visited() + "mine ");
    CHECK(method_names<Alone>() == "mine, phong");
    CHECK(std::holds_alternative<Bdpt>(method_by_name("bdpt")));
    CHECK(std::holds_alternative<Bdpt>(method_by_name<Beside>("bdpt")));
    CHECK(message_of([] { method_by_name("mine"); }) == "there is no method \"mine\"; known are " + method_names());
    CHECK(message_of([] { method_by_name<Alone>("path"); }) == "there is no method \"path\"; known are mine, phong");

    Beside method = method_by_name<Beside>("mine");
    CHECK(method_name(method) == "mine");
    CHECK(method_kind(method) == Kind::consistent);
    CHECK(std::get<Mine>(method).max_depth == 7);
    set_path_length(method, {.max_depth = 3});
    CHECK(std::get<Mine>(method).max_depth == 3);
    method = method_by_name<Beside>("phong");
    CHECK_NOTHROW(set_path_length(method, {.max_depth = 3}));  // has none
    CHECK(method_name(Alone()) == "mine");
}

TEST_CASE("methods by name: of two with one name, the first") {
    CHECK(method_by_name<append_t<AnyMethod, Namesake>>("path").index() == AnyMethod(PathTracer()).index());
    CHECK(method_by_name<std::variant<Namesake, PathTracer>>("path").index() == 0);
}
