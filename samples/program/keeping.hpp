#pragma once

// Renders that survive: their states and images are written while they go on.

#include "load.hpp"
#include "run.hpp"

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace lightswitch::program {

/// A text of what the scene holds: of all files that were read, and what the command line says of it.
std::string content_of(const SceneOptions& options, const SceneSummary& summary);

/// The iterations that a command is to make.
struct Span {
    std::uint64_t begin = 0;
    int samples = 0;  ///< 0: without end
};
/// Those of the share, if there is one. Throws `Error` when there can be none.
Span span_of(const RenderOptions& options, const Budget& budget, const AnyMethod& method);

/// Something that is done from time to time.
class Now {
public:
    /// Every so many seconds; 0: never.
    explicit Now(double seconds) : seconds_(seconds) {}
    bool due() const { return seconds_ > 0 && seconds_since(last_) >= seconds_; }
    void done() { last_ = Clock::now(); }

private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point then) {
        return std::chrono::duration<double>(Clock::now() - then).count();
    }

    double seconds_;
    Clock::time_point last_ = Clock::now();
};

/// The checkpoint of a render.
class Checkpoint {
public:
    /// Reads the file where there is one, and tells of it. Throws `Error` when it is not of these iterations, or
    /// nothing can be taken from it.
    Checkpoint(const RenderOptions& options, const Span& span);

    /// Where to go on, if anywhere; once.
    std::optional<RenderState> take() { return std::move(from_); }
    std::uint64_t rays_before() const { return rays_before_; }

    /// Whether it is time to write it.
    bool due() const { return !file_.empty() && now_.due(); }
    /// Between two iterations: writes it when it is time. A failure is a warning; later it is tried again.
    void observe(const Halt& halt);
    /// At the end. A failure is kept until `complain`, so that the images can be written before.
    void end(const Halt& halt);
    /// Throws `Error` when the last writing failed.
    void complain() const;

private:
    bool write(const Halt& halt);

    std::filesystem::path file_;
    Now now_;
    std::optional<RenderState> from_;
    std::uint64_t written_ = 0, rays_before_ = 0;  // iterations in the file
    std::string failure_;
};

}  // namespace lightswitch::program
