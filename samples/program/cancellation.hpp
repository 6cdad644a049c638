#pragma once

// Ctrl-C as a stop token.

#include <stop_token>
#include <thread>

namespace lightswitch::program {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP requests a stop through `token()`; after that SIGINT and SIGTERM
/// have their default effect again, so a second one ends the program at once. Not so SIGHUP: a terminal that is closed,
/// or a service that is stopped, may send it after another. A signal that the parent process has chosen to ignore
/// (nohup, a shell's background job) stays ignored. One object at a time. Throws `Error` where no thread can be
/// started.
class Cancellation {
public:
    Cancellation();
    ~Cancellation();
    Cancellation(const Cancellation&) = delete;
    Cancellation& operator=(const Cancellation&) = delete;

    std::stop_token token() const { return source_.get_token(); }
    /// Requests the stop, without a signal.
    void stop() { source_.request_stop(); }

private:
    std::stop_source source_;
    std::jthread watcher_;  // a signal handler may do no more than set a flag
};

/// While it lives, those signals wait: what is being written becomes whole. One object at a time, inside the life of a
/// `Cancellation` or without one.
class Uninterrupted {
public:
    Uninterrupted();
    ~Uninterrupted();
    Uninterrupted(const Uninterrupted&) = delete;
    Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace lightswitch::program
