#pragma once

// What the program says on standard error, one line each.

#include <string_view>

namespace lightswitch::program {

void print_error(std::string_view message);
void print_warning(std::string_view message);
void print_note(std::string_view message);

}  // namespace lightswitch::program
