#include "verify/planted/catalogue.hpp"

#include <iterator>

namespace lightswitch::test {

std::vector<PlantedBug> planted_bugs() {
    std::vector<PlantedBug> all;
    for (const auto& part : {method_bugs(), bsdf_bugs(), light_bugs(), pixel_bugs(), guided_bugs()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace lightswitch::test
