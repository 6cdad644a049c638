#pragma once

// The line that tells how far a render is.

#include <lightswitch/render/render.hpp>

namespace lightswitch::program {

/// Rewrites one line on standard error, at most ten times per second, and clears it at the end. Silent unless standard
/// error is a terminal.
class ProgressLine {
public:
    explicit ProgressLine(bool wanted);
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void update(const Progress& progress, std::uint64_t rays);
    /// Any text, after so many seconds of work.
    void update(double seconds, const std::string& text);
    void clear();
    /// Clears it, for other work whose seconds count from 0.
    void restart();

private:
    bool shown_, dirty_ = false;
    double next_ = 0;  // seconds of rendering at which the line is written again
};

}  // namespace lightswitch::program
