#pragma once

#include "verify/planted/catalogue.hpp"

namespace lightswitch::test {

/// Every method that samples lights against `bdpt`, on scenes made to break the comparison: spots and lamps smaller
/// than anything that an image resolves, caustics, mirrors. All are right.
std::vector<CorrectPair> lamp_pairs();

}  // namespace lightswitch::test
