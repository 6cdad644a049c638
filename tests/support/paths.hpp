#pragma once

// Where things are. Only main.cpp is told, so that all test programs can share what they precompile, and a compiler
// cache can serve another checkout.

#include <string>

namespace lightswitch::test {

/// The folder `tests`.
std::string folder();
/// The program `lightswitch`; empty when it is not built.
std::string program();

}  // namespace lightswitch::test
