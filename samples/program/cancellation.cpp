#include "cancellation.hpp"

#include <lightswitch/core/error.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <system_error>

namespace lightswitch::program {
namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};
using Handler = void (*)(int);

std::atomic<bool> asked_to_stop{false};
std::atomic<int> waiting{0};  // the last signal that came while something was written
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);  // for the handlers

/// Unless the parent process has chosen to ignore the signal. Returns what was there before.
Handler handle(int signal, Handler handler) {
    const Handler before = std::signal(signal, handler);
    if (before == SIG_IGN) std::signal(signal, SIG_IGN);
    return before;
}

extern "C" void on_signal(int) {
    asked_to_stop = true;
    handle(SIGINT, SIG_DFL);
    handle(SIGTERM, SIG_DFL);
}

extern "C" void on_signal_while_writing(int signal) { waiting = signal; }

std::array<Handler, signals.size()> handlers_before_writing;

}  // namespace

Cancellation::Cancellation() {
    asked_to_stop = false;
    try {
        watcher_ = std::jthread([this](const std::stop_token& finished) {
            while (!finished.stop_requested() && !source_.stop_requested()) {
                if (asked_to_stop) source_.request_stop();
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            }
        });
    } catch (const std::system_error& error) {
        throw Error("the system starts no thread for this program: " + error.code().message());
    }
    for (const int signal : signals) handle(signal, on_signal);
}

Cancellation::~Cancellation() {
    for (const int signal : signals) handle(signal, SIG_DFL);
}

Uninterrupted::Uninterrupted() {
    waiting = 0;
    for (std::size_t i = 0; i < signals.size(); ++i)
        handlers_before_writing[i] = handle(signals[i], on_signal_while_writing);
}

Uninterrupted::~Uninterrupted() {
    for (std::size_t i = 0; i < signals.size(); ++i) std::signal(signals[i], handlers_before_writing[i]);
    if (waiting != 0) std::raise(waiting);
}

}  // namespace lightswitch::program
