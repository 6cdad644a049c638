#include "method_notes.hpp"
#include "program.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lightswitch::program {

AnyMethod find_method(std::string_view wanted, std::string_view option, std::string_view hint) {
    if (std::find(known_methods.begin(), known_methods.end(), wanted) == known_methods.end())
        throw Error(fmt::format("{}: there is no method \"{}\"{}; known are {}{}", option, wanted,
                                suggestion(wanted, known_methods), list(known_methods), hint));
    return method_by_name(wanted);
}

int list_methods() {
    for_each_method([](const auto& method) {
        const MethodNotes& notes = notes_on(method.name);
        fmt::print("{:<12}{:<12}can:    {}\n", method.name, lightswitch::name(method.kind), notes.can);
        const std::string lacking = describe(lightswitch::cannot_make<std::remove_cvref_t<decltype(method)>>());
        if (!lacking.empty()) fmt::print("{:<24}cannot: show {}\n", "", lacking);
        if (!notes.cannot.empty()) fmt::print("{:<24}cannot: {}\n", "", notes.cannot);
    });
    fmt::print(
        "\nunbiased:   the expected image is exact for any number of samples\n"
        "consistent: the error vanishes as the work grows\n"
        "heuristic:  a picture of the scene, not of its light transport; not to be compared with the others\n");
    return success;
}

}  // namespace lightswitch::program
