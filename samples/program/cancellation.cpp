#include "cancellation.hpp"

#include <atomic>
#include <chrono>
#include <csignal>

namespace lightswitch::program {
namespace {

constexpr int signals[] = {SIGINT, SIGTERM};
std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // or a signal handler might not touch it

void restore_defaults() {
    for (const int signal : signals)
        if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

extern "C" void on_signal(int) {
    asked_to_stop = true;
    restore_defaults();
}

}  // namespace

Cancellation::Cancellation() {
    asked_to_stop = false;
    for (const int signal : signals)
        if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
    watcher_ = std::jthread([this](const std::stop_token& finished) {
        while (!finished.stop_requested() && !source_.stop_requested()) {
            if (asked_to_stop) source_.request_stop();
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    });
}

Cancellation::~Cancellation() { restore_defaults(); }

}  // namespace lightswitch::program
