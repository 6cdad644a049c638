#include "progress.hpp"

#include <fmt/format.h>

#include <unistd.h>
#include <cstdio>

namespace lightswitch::program {
namespace {

/// "42 s", "3:07 min" or "2:15 h".
std::string duration(double seconds) {
    if (seconds < 10) return fmt::format("{:.1f} s", seconds);
    if (seconds < 100) return fmt::format("{:.0f} s", seconds);
    if (!(seconds < 3.6e6)) return "very long";
    const auto whole = static_cast<long long>(seconds);
    return whole < 3600 ? fmt::format("{}:{:02} min", whole / 60, whole % 60)
                        : fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

void write(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

constexpr auto erase_line = "\r\033[K";

}  // namespace

ProgressLine::ProgressLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) == 1) {}

void ProgressLine::update(double seconds, const std::string& text) {
    if (!shown_ || seconds < next_) return;
    next_ = seconds + 0.1;
    dirty_ = true;
    write(erase_line + text);
}

void ProgressLine::update(const Progress& progress, std::uint64_t rays) {
    if (!shown_ || progress.seconds < next_) return;
    const double rate = progress.seconds > 0 ? double(rays) / progress.seconds : 0;
    const std::string left = progress.fraction > 0 ? ", " + duration(progress.seconds_left) + " left" : std::string();
    update(progress.seconds,
           fmt::format("{:3.0f} %  {} samples per pixel  {}{}  {:.2f} Mrays/s", 100 * progress.fraction,
                       progress.iterations, duration(progress.seconds), left, rate * 1e-6));
}

void ProgressLine::clear() {
    if (dirty_) write(erase_line);
    dirty_ = false;
}

void ProgressLine::restart() {
    clear();
    next_ = 0;
}

}  // namespace lightswitch::program
