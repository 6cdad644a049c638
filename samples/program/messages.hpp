#pragma once

// What the program says on standard error, one line each, and what others say there.

#include <string_view>

namespace lightswitch::program {

/// Says nothing from now on: another process does.
void silence_messages();

void print_error(std::string_view message);
void print_warning(std::string_view message);
void print_note(std::string_view message);

/// While it lives, what is written to standard output goes to standard error: Embree tells there what it does when its
/// configuration says so, and standard output may be read by a program.
class DivertedOutput {
public:
    DivertedOutput();
    ~DivertedOutput();
    DivertedOutput(const DivertedOutput&) = delete;
    DivertedOutput& operator=(const DivertedOutput&) = delete;

private:
    int output_;  // the descriptor of standard output; -1 when there is none to spare
};

}  // namespace lightswitch::program
