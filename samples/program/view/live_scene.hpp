#pragma once

// What a window shows: one scene, what the methods have made of it so far, and what is known about them.

#include "../load.hpp"
#include "../program.hpp"
#include "../run.hpp"
#include "background.hpp"
#include "camera_control.hpp"

#include <lightswitch/method/any_method.hpp>
#include <lightswitch/render/interactive.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch::program {

/// How the error of a method fell: root mean square over the image's mean.
struct ErrorPoint {
    double seconds = 0;
    std::uint64_t samples = 0;
    double estimated = 0;  ///< by the spread of the method's own samples
    double measured = 0;   ///< by its difference from the reference as it is now; 0 when that is not known
};

/// A method of the window. Its number is its place in the list of all methods, and its key.
struct LiveMethod {
    AnyMethod method;
    std::string name;
    Kind kind = Kind::unbiased;
    std::shared_ptr<const Snapshot> snapshot;  ///< the newest; see `InteractiveRender`
    std::vector<ErrorPoint> curve;
    std::vector<std::shared_ptr<const Snapshot>> kept;  ///< those of the curve whose error can still be measured
    double unsaved_seconds = 0;                         ///< of work on this view that no saved file holds
    double saved_seconds = 0;                           ///< of work that one does
};

/// The words and numbers of a verdict while it is being found.
struct VerdictSoFar {
    std::shared_ptr<const Verdict> verdict;  ///< empty before the first look
    VerifyProgress progress;
    std::string problem;  ///< why there is none
    bool done = false;
};

/// How a sample of a pixel came about.
struct FollowedPath {
    ReplayedPixel at;
    std::string method;
    std::optional<PathReplay> replay;
    std::optional<BrightestSample> brightest;  ///< where that was looked for
    std::string problem;                       ///< why there is none
};

/// Renders, compares and verifies in the background. To be used from one thread; `wake` is called on others when there
/// is something new.
class LiveScene {
public:
    LiveScene(LoadedScene loaded, const ViewOptions& options, std::function<void()> wake);

    const SceneSummary& summary() const { return summary_; }
    const FilmDescription& film() const { return film_; }
    /// Which of the scene types it has, and the bytes that it takes.
    std::string scene_type() const;
    double scene_bytes() const;
    const std::vector<LiveMethod>& methods() const { return methods_; }
    std::size_t shown() const { return shown_; }
    const LiveMethod& shown_method() const { return methods_[shown_]; }
    /// The method that the shown one is compared with.
    std::optional<std::size_t> reference() const { return reference_; }
    const LiveMethod* reference_method() const { return reference_ ? &methods_[*reference_] : nullptr; }

    void show(std::size_t method);
    void compare_with(std::optional<std::size_t> method);
    /// Whether the reference goes on while another method is looked at.
    bool in_background() const { return in_background_; }
    void set_in_background(bool yes);
    bool held() const { return held_; }
    void hold(bool yes);

    /// To be changed at will; `update` follows it.
    CameraControl camera;

    /// Fetches what is new, and follows the camera. Throws `Error` when that has gone where it cannot see the scene
    /// from; it is then where it was before.
    void update();

    /// The verdict about the shown method by the reference; nothing when it is not asked for.
    std::optional<VerdictSoFar> verdict() const;
    bool verifies() const { return verifies_; }
    void set_verifies(bool yes);

    /// The method whose error will be smallest at equal time, as far as it is known; nothing when it is not.
    std::optional<std::size_t> best() const;

    /// Albedo, normal and depth as layers; empty before they are there. Asking makes them.
    std::shared_ptr<const std::vector<Layer>> outputs();

    /// Repeats that sample by the shown method, or first looks for the brightest of those that there are.
    void follow(const ReplayedPixel& at, bool brightest);
    /// Empty before it is known; forgotten when the camera moves.
    std::shared_ptr<const FollowedPath> followed() const { return followed_.result(); }

    /// The image as `render` would save it, with what stood in for what the scene file says.
    Image image_to_save(std::size_t method) const;
    void saved(std::size_t method);
    /// Names of methods with work that would be lost.
    std::vector<std::string> unsaved() const;

private:
    void choose();
    void verify_anew();
    void take(LiveMethod& method, std::shared_ptr<const Snapshot> snapshot);
    void measure_curves();

    SceneSummary summary_;
    FilmDescription film_;
    Settings settings_;
    std::function<void()> wake_;
    std::vector<LiveMethod> methods_;
    std::size_t shown_ = 0;
    std::optional<std::size_t> reference_;
    bool in_background_ = true, held_ = false, verifies_ = false;
    CameraControl seen_by_;  // the camera that was followed last
    std::uint64_t view_ = 0;
    std::uint64_t measured_with_ = 0;  // samples of the reference
    Background<VerdictSoFar> verdict_;
    std::uint64_t verdict_view_ = 0;
    std::chrono::steady_clock::time_point moved_{};
    Background<std::vector<Layer>> outputs_;
    std::optional<std::uint64_t> outputs_view_;
    Background<FollowedPath> followed_;
    InteractiveRender<AnyScene> live_;
};

}  // namespace lightswitch::program
