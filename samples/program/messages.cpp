#include "messages.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <cstdio>
#include <string>

namespace lightswitch::program {
namespace {

bool silent = false;

/// One write, so that lines of several programs stay whole. Where standard error is gone, nobody is left to tell.
void print(std::string_view kind, std::string_view message) {
    if (silent) return;
    std::string line = "lightswitch: ";
    line.append(kind);
    for (const char c : message) line += c == '\n' || c == '\r' ? ' ' : c;
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void silence_messages() { silent = true; }

void print_error(std::string_view message) { print("error: ", message); }
void print_warning(std::string_view message) { print("warning: ", message); }
void print_note(std::string_view message) { print("", message); }

DivertedOutput::DivertedOutput() {
    std::fflush(stdout);
    output_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (output_ != -1) dup2(STDERR_FILENO, STDOUT_FILENO);
}

DivertedOutput::~DivertedOutput() {
    if (output_ == -1) return;
    std::fflush(stdout);
    dup2(output_, STDOUT_FILENO);
    close(output_);
}

}  // namespace lightswitch::program
