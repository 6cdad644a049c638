#include "method/agreement.hpp"

using namespace lightswitch::test;

// False alarm: 1e-3.
TEST_CASE("path tracing agrees with and without next event estimation on many scenes") {
    check_agreement(100, 40, 384, 1e-3);
}
