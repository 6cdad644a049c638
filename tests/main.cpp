// The main() of every test program.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "support/paths.hpp"

#include <doctest/doctest.h>

std::string lightswitch::test::folder() { return LIGHTSWITCH_TESTS_DIR; }
std::string lightswitch::test::program() { return LIGHTSWITCH_PROGRAM; }
