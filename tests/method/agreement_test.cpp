#include "method/agreement.hpp"

using namespace lightswitch::test;

// False alarm: 1e-3.
TEST_CASE("path tracing agrees with and without next event estimation") { check_agreement(1, 6, 48, 1e-3); }
