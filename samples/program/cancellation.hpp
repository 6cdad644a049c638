#pragma once

// Ctrl-C as a stop token.

#include <stop_token>
#include <thread>

namespace lightswitch::program {

/// While it lives, the first SIGINT or SIGTERM requests a stop through `token()`; after that both have their default
/// effect again, so a second one ends the program at once. A signal that the parent process has chosen to ignore
/// (nohup, a shell's background job) stays ignored. One object at a time.
class Cancellation {
public:
    Cancellation();
    ~Cancellation();
    Cancellation(const Cancellation&) = delete;
    Cancellation& operator=(const Cancellation&) = delete;

    std::stop_token token() const { return source_.get_token(); }

private:
    std::stop_source source_;
    std::jthread watcher_;  // a signal handler may do no more than set a flag
};

}  // namespace lightswitch::program
