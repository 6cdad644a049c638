#include "live_scene.hpp"

#include "../method_options.hpp"

#include <lightswitch/compare/metrics.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightswitch::program {
namespace {

using Clock = std::chrono::steady_clock;

/// Where the optical axis meets a surface, or else how large the scene is: in scene units, from the camera.
double pivot_distance(const AnyScene& any_scene, const CameraDescription& camera) {
    return std::visit(
        [&](const auto& scene) {
            const auto& film = scene.film();
            const Ray ray = scene.camera().ray({0.5f * float(film.width), 0.5f * float(film.height)}, Vec2(0.5f));
            double distance = scene.radius() / scene.space().scale();
            if (const auto hit = scene.intersect(ray)) {
                const DVec3 place = scene.space().scene_point(DVec3(hit->position));
                const double along = glm::dot(place - DVec3(camera.to_world[3]), DVec3(camera.to_world[2]));
                if (along > 0) distance = along;
            }
            return distance > 0 ? distance : 1;
        },
        any_scene);
}

/// The error of the image, over the mean of the reference; 0 when that is black.
double measured_error(const Image& image, const Image& reference) {
    const DVec3 mean = reference.mean();
    const double level = (mean.x + mean.y + mean.z) / 3;
    return level > 0 ? rmse(image, reference) / level : 0;
}

FilmDescription film_of(const AnyScene& scene) {
    return std::visit([](const auto& s) { return s.film(); }, scene);
}

/// The same view with at most 128 pixels a side: verdicts need no more, as those of the command line.
AnyScene scene_to_verify(const AnyScene& scene, const CameraDescription& camera, FilmDescription film) {
    film.shrink(128);
    return std::visit([&](const auto& s) -> AnyScene { return s.with_camera(camera, film); }, scene);
}

/// Longer work than this is not thrown away without asking.
constexpr double worth_saving = 30;  // seconds of rendering
constexpr std::size_t most_kept = 14;

}  // namespace

LiveScene::LiveScene(LoadedScene loaded, const ViewOptions& options, std::function<void()> wake)
    : camera(loaded.summary.camera, pivot_distance(loaded.scene, loaded.summary.camera)),
      summary_(std::move(loaded.summary)),
      film_(film_of(loaded.scene)),
      settings_{.seed = options.seed, .threads = options.threads, .sampling = options.sampling},
      wake_(std::move(wake)),
      seen_by_(camera),
      live_(std::move(loaded.scene), summary_.camera, settings_, wake_) {
    std::vector<AnyMethod> all;
    for_each_method([&](const auto& m) { all.emplace_back(m); });
    set_options(all, options.of_methods, std::size_t(film_.width) * std::size_t(film_.height));
    const PathLength length = path_length(summary_, options.max_depth, options.rr_depth);
    for (AnyMethod& method : all) {
        set_path_length(method, length);
        // Chains are slow to begin with: their coarse pictures are those of the method that they move paths of.
        AnyMethod coarse = method;
        if (std::holds_alternative<Mlt>(method))
            coarse = Bdpt{.max_depth = length.max_depth, .rr_depth = length.rr_depth};
        // What guides paths takes a while to learn, too.
        if (std::holds_alternative<PathGuided>(method))
            coarse = PathTracerNee{.max_depth = length.max_depth, .rr_depth = length.rr_depth};
        live_.add(method, coarse);
        methods_.push_back({.method = method,
                            .name = std::string(method_name(method)),
                            .kind = method_kind(method),
                            .snapshot = {},
                            .curve = {},
                            .kept = {}});
    }
    live_.limit(static_cast<std::uint64_t>(options.samples));
    const auto number_of = [&](const std::string& name) {
        const auto found =
            std::find_if(methods_.begin(), methods_.end(), [&](const auto& m) { return m.name == name; });
        return static_cast<std::size_t>(found - methods_.begin());
    };
    shown_ = number_of(options.method);
    if (!options.against.empty()) reference_ = number_of(options.against);
    verifies_ = reference_.has_value();
    choose();
    verify_anew();
}

std::string LiveScene::scene_type() const {
    const std::string_view type = scene_type_name(*live_.scene());
    return std::string(type.substr(0, type.find(':')));
}

double LiveScene::scene_bytes() const {
    return std::visit(
        [](const auto& s) { return double(s.statistics().embree_bytes) + double(s.statistics().scene_bytes); },
        *live_.scene());
}

void LiveScene::choose() {
    std::vector<std::size_t> active;
    if (!held_) {
        active.push_back(shown_);
        if (reference_ && in_background_ && *reference_ != shown_) active.push_back(*reference_);
    }
    live_.show(active);
}

void LiveScene::show(std::size_t method) {
    if (method == shown_) return;
    shown_ = method;
    const auto& snapshot = methods_[method].snapshot;
    if (!snapshot || snapshot->iterations == 0) held_ = false;  // there is nothing to look at yet
    choose();
    verify_anew();
}

void LiveScene::compare_with(std::optional<std::size_t> method) {
    if (method == reference_) return;
    if (method && !reference_) verifies_ = true;
    reference_ = method;
    measured_with_ = 0;
    for (LiveMethod& m : methods_)
        for (ErrorPoint& point : m.curve) point.measured = 0;
    choose();
    verify_anew();
}

void LiveScene::set_in_background(bool yes) {
    in_background_ = yes;
    choose();
}

void LiveScene::hold(bool yes) {
    held_ = yes;
    choose();
    verify_anew();
}

void LiveScene::set_verifies(bool yes) {
    verifies_ = yes;
    verify_anew();
}

void LiveScene::verify_anew() {
    verdict_.stop();
    verdict_view_ = view_;
    moved_ = Clock::now();
    if (!verifies_ || !reference_ || *reference_ == shown_ || held_) return;
    const auto scene = std::make_shared<const AnyScene>(scene_to_verify(*live_.scene(), seen_by_.description(), film_));
    const AnyMethod ours = methods_[shown_].method, theirs = methods_[*reference_].method;
    verdict_.start([=, settings = settings_, wake = wake_](const std::stop_token& stop, const auto& publish) {
        VerdictSoFar so_far;
        VerifyOptions options{.seconds = 600, .seed = settings.seed + 1, .threads = settings.threads};
        options.stop = stop;
        auto last = Clock::now();
        const auto tell = [&] {
            publish(so_far);
            last = Clock::now();
            if (!stop.stop_requested()) wake();
        };
        options.looked = [&](const Verdict& verdict) {
            so_far.verdict = std::make_shared<const Verdict>(verdict);
            tell();
        };
        options.observer = [&](const VerifyProgress& progress) {
            so_far.progress = progress;
            if (Clock::now() - last > std::chrono::milliseconds(250)) tell();
        };
        try {
            Settings own = settings;
            own.stop = stop;
            // Something new to look at matters more than a verdict.
            for (int i = 0; i < 5 && !stop.stop_requested(); ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            if (stop.stop_requested()) return;
            so_far.verdict = std::make_shared<const Verdict>(
                lightswitch::verify(make_estimator(*scene, ours, own), make_estimator(*scene, theirs, own), options));
        } catch (const std::exception& error) {
            so_far.problem = error.what();
        }
        so_far.done = true;
        tell();
    });
}

std::optional<VerdictSoFar> LiveScene::verdict() const {
    const auto result = verdict_.result();
    if (result) return *result;
    if (verifies_ && reference_ && *reference_ != shown_ && !held_) return VerdictSoFar{};
    return {};
}

void LiveScene::update() {
    if (camera.changes() != seen_by_.changes()) {
        try {
            live_.move(camera.description(), film_);
        } catch (const Error&) {
            camera = seen_by_;
            throw;
        }
        seen_by_ = camera;
        ++view_;
        if (held_) {  // there is nothing to look at yet
            held_ = false;
            choose();
        }
        for (LiveMethod& method : methods_) {
            method.curve.clear();
            method.kept.clear();
            method.unsaved_seconds = method.saved_seconds = 0;
        }
        measured_with_ = 0;
        verdict_.stop();
        followed_.stop();
        moved_ = Clock::now();
    }
    // A verdict on a view is begun when the camera has come to rest.
    if (verdict_view_ != view_ && Clock::now() - moved_ > std::chrono::milliseconds(700)) verify_anew();
    for (std::size_t i = 0; i < methods_.size(); ++i) {
        auto snapshot = live_.snapshot(i);
        if (snapshot != methods_[i].snapshot) take(methods_[i], std::move(snapshot));
    }
}

void LiveScene::take(LiveMethod& method, std::shared_ptr<const Snapshot> snapshot) {
    method.snapshot = std::move(snapshot);
    if (!method.snapshot) return;
    const Snapshot& now = *method.snapshot;
    if (now.iterations == 0 || now.view != view_) return;
    method.unsaved_seconds = now.statistics.seconds - method.saved_seconds;
    auto& curve = method.curve;
    if (curve.empty() || now.statistics.seconds > 1.1 * curve.back().seconds) {
        curve.push_back({.seconds = now.statistics.seconds, .samples = now.iterations, .estimated = now.error});
        if (method.kept.empty() || now.iterations >= 2 * method.kept.back()->iterations) {
            if (method.kept.size() == most_kept) method.kept.erase(method.kept.begin());
            method.kept.push_back(method.snapshot);
        }
    }
    measure_curves();
}

/// When the reference has become much better, all errors are measured again by it.
void LiveScene::measure_curves() {
    const LiveMethod* reference = reference_method();
    if (!reference || !reference->snapshot || reference->snapshot->iterations == 0 ||
        reference->snapshot->view != view_)
        return;
    const Snapshot& truth = *reference->snapshot;
    const bool anew = truth.iterations >= 2 * measured_with_;
    if (anew) measured_with_ = truth.iterations;
    for (LiveMethod& method : methods_) {
        if (&method == reference || method.kind == Kind::heuristic) continue;
        for (const auto& kept : method.kept) {
            const auto point = std::find_if(method.curve.begin(), method.curve.end(),
                                            [&](const auto& p) { return p.samples == kept->iterations; });
            if (point == method.curve.end() || (!anew && point->measured > 0)) continue;
            point->measured = measured_error(kept->image, truth.image);
        }
    }
}

std::optional<std::size_t> LiveScene::best() const {
    std::optional<std::size_t> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < methods_.size(); ++i) {
        const LiveMethod& method = methods_[i];
        if (method.kind == Kind::heuristic) continue;
        // The square of the error falls as one over the time; the newest point that was measured stands for it.
        double cost = std::numeric_limits<double>::infinity();
        for (const ErrorPoint& point : method.curve) {
            const double error = reference_ && *reference_ != i ? point.measured : reference_ ? 0 : point.estimated;
            if (error > 0 && std::isfinite(error) && point.samples >= 4) cost = error * error * point.seconds;
        }
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    return best;
}

std::shared_ptr<const std::vector<Layer>> LiveScene::outputs() {
    if (outputs_view_ != view_ && camera.changes() == seen_by_.changes()) {
        outputs_view_ = view_;
        const auto scene = live_.scene();
        outputs_.start([=, settings = settings_, wake = wake_](const std::stop_token& stop, const auto& publish) {
            Settings own = settings;
            own.stop = stop;
            for (const int samples : {1, 16}) {
                auto layers = run_outputs(*scene, {Albedo{}, ShadingNormal{}, Depth{}}, samples, own);
                if (stop.stop_requested()) return;
                publish(std::move(layers));
                wake();
            }
        });
    }
    return outputs_.result();
}

void LiveScene::follow(const ReplayedPixel& at, bool brightest) {
    const LiveMethod& shown = methods_[shown_];
    if (!shown.snapshot || shown.snapshot->iterations == 0) return;
    followed_.start([=, scene = live_.scene(), method = shown.method, name = shown.name, settings = settings_,
                     wake = wake_,
                     iterations = shown.snapshot->iterations](const std::stop_token& stop, const auto& publish) {
        FollowedPath path{.at = at, .method = name, .replay = {}, .brightest = {}, .problem = {}};
        Settings own = settings;
        own.stop = stop;
        // Splats of other pixels' paths would take a whole iteration of bdpt.
        const ReplayOptions options{.others = false};
        try {
            if (brightest) {
                path.brightest = run_brightest(*scene, method, own, at, iterations, options);
                path.at.iteration = path.brightest->iteration;
            }
            if (!stop.stop_requested()) path.replay = run_replay(*scene, method, own, path.at, options);
        } catch (const std::exception& error) {
            path.problem = error.what();
        }
        if (stop.stop_requested()) return;
        publish(std::move(path));
        wake();
    });
}

Image LiveScene::image_to_save(std::size_t method) const {
    const auto& snapshot = methods_[method].snapshot;
    if (!snapshot || snapshot->iterations == 0) throw Error(methods_[method].name + " has no image of this view yet");
    Image image = snapshot->image;
    keep_stand_ins(image, summary_);
    return image;
}

void LiveScene::saved(std::size_t method) {
    methods_[method].saved_seconds += std::exchange(methods_[method].unsaved_seconds, 0);
}

std::vector<std::string> LiveScene::unsaved() const {
    std::vector<std::string> names;
    for (const LiveMethod& method : methods_)
        if (method.unsaved_seconds > worth_saving) names.push_back(method.name);
    return names;
}

}  // namespace lightswitch::program
