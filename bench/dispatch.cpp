// What choosing costs: rendering the stock Cornell box by path-nee, one thread,
//   - through AnyScene and AnyMethod against the concrete types: the price of switching at run time, expected 1.00;
//   - with a scene type that holds every material and light against the diffuse one: what narrowing the type gains.
// Seconds of the first over seconds of the second; in brackets the middle half of the pairs.

#include <lightswitch/lightswitch.hpp>

#include "paired.hpp"

namespace {

namespace ls = lightswitch;

void run(const auto& scene, const auto& method) {
    ls::Session<std::remove_cvref_t<decltype(scene)>, std::remove_cvref_t<decltype(method)>, ls::SerialExecutor>
        session(scene, method, {}, {});
    session.run({.samples = 4});
}

void report(const char* what, const bench::Pairs& pairs) {
    std::printf("%-40s %6.3f  (%.3f to %.3f)\n", what, pairs.ratio.median, pairs.ratio.low, pairs.ratio.high);
}

}  // namespace

int main() {
    const auto description = ls::stock::describe_cornell_box();
    const ls::DiffuseScene diffuse = ls::stock::cornell_box();
    const ls::FullScene full = ls::build_scene<ls::AllBsdfs, ls::AllLights>(description);
    const ls::AnyScene any_scene = ls::build_any(description);
    const ls::AnyMethod any_method = ls::method_by_name("path-nee");
    const auto direct = [&] { run(diffuse, ls::PathTracerNee{}); };

    report("variants / concrete types",
           bench::compare(
               31,
               [&] {
                   std::visit([](const auto& scene, const auto& method) { run(scene, method); }, any_scene, any_method);
               },
               direct));
    report("concrete types / concrete types (noise)", bench::compare(31, direct, direct));
    report("full scene type / diffuse scene type", bench::compare(
                                                       31, [&] { run(full, ls::PathTracerNee{}); }, direct));
}
