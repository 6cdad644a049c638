#include "interface.hpp"

#include <lightswitch/film/tonemap.hpp>

#include <fmt/format.h>
#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace lightswitch::program {
namespace {

constexpr std::array<std::string_view, 10> view_names{
    "image",        "side by side", "split",  "flicker", "difference", "relative difference",
    "significance", "albedo",       "normal", "depth"};

/// Of this process, in bytes; 0 where the system does not tell.
double memory_in_use() {
    std::ifstream file("/proc/self/statm");
    double total = 0, resident = 0;
    file >> total >> resident;
    return file ? resident * double(sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace

std::string bytes_text(double bytes) {
    if (bytes < 1e6) return fmt::format("{:.3g} kB", bytes / 1e3);
    return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6) : fmt::format("{:.3g} GB", bytes / 1e9);
}

std::string_view name(View view) { return view_names[static_cast<std::size_t>(view)]; }

Interface::Interface(Window& window, const ViewOptions& options) : window_(window), options_(options) {
    make_commands();
}

void Interface::set_scene(LoadedScene loaded, const ViewOptions& options) {
    live_.reset();  // its memory is free before the next one takes some
    options_ = options;
    const std::optional<float> exposure = options.exposure ? options.exposure : loaded.summary.exposure;
    live_ = std::make_unique<LiveScene>(std::move(loaded), options, [] { Window::wake(); });
    exposure_is_chosen_ = exposure.has_value();
    display_.stops = exposure.value_or(0);
    zoom_ = 1;
    center_ = DVec2(0.5);
    picked_.reset();
    drawn_ours_ = drawn_theirs_ = numbers_ours_ = numbers_theirs_ = {};
    drawn_outputs_.reset();
    for (Texture* texture : {&ours_, &theirs_, &numbers_, &output_}) texture->clear();
    if (!live_->reference() && compares()) view_ = View::image;
}

std::string Interface::scene_name() const { return std::filesystem::path(options_.scene.scene).filename().string(); }

bool Interface::compares() const { return view_ > View::image && view_ < View::albedo; }

bool Interface::moves() const { return view_ == View::flicker || moves_camera_ || ImGui::GetIO().WantTextInput; }

bool Interface::is_waited_for() const {
    if (loading_.valid() || !live_) return true;
    const auto& snapshot = live_->shown_method().snapshot;
    return !snapshot || snapshot->iterations < 4;
}

void Interface::close() {
    unless_lost("Close", [this] { closes_ = true; });
}

void Interface::frame() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_frame_).count();
    last_frame_ = now;
    if (seconds > 0) frames_per_second_ += 0.1 * (1 / seconds - frames_per_second_);

    handle_keys();
    fly();
    for (const auto& file : window_.take_dropped()) open(file.string());
    if (loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        try {
            ViewOptions next = options_;
            LoadedScene loaded = loading_.get();
            next.scene.scene = loading_name_;
            if (live_) next.method = live_->shown_method().name;
            if (live_) next.against = live_->reference_method() ? live_->reference_method()->name : "";
            set_scene(std::move(loaded), next);
            tell(fmt::format("Opened {}.", loading_name_));
        } catch (const std::exception& error) {
            tell(error.what());
        }
    }
    if (live_) {
        try {
            live_->update();
        } catch (const Error& error) {
            tell(error.what());
        }
    }
    if (live_ && !exposure_is_chosen_) {
        const auto& snapshot = live_->shown_method().snapshot;
        if (snapshot && !snapshot->image.empty()) auto_expose();
    }
    update_pictures();

    window_.begin_frame();
    menu_bar();
    const ImGuiIO& io = ImGui::GetIO();
    const float top = ImGui::GetFrameHeight(), bottom = ImGui::GetFrameHeight();
    const float height = std::max(io.DisplaySize.y - top - bottom, 1.0f);
    const float panel = panel_width();
    // The window is cleared already: painting it again would be most of the work where the processor does it.
    constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                                       ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({std::max(io.DisplaySize.x - panel, 1.0f), height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("image", nullptr, fixed | ImGuiWindowFlags_NoScrollWithMouse);
    image_area(std::max(io.DisplaySize.x - panel, 1.0f), height);
    ImGui::End();
    ImGui::PopStyleVar();
    if (shows_panel_) {
        ImGui::SetNextWindowPos({io.DisplaySize.x - panel, top});
        ImGui::SetNextWindowSize({panel, height});
        ImGui::Begin("panel", nullptr, fixed & ~ImGuiWindowFlags_NoScrollbar);
        side_panel();
        ImGui::End();
    }
    status_bar();
    if (live_) path_window();
    popups();
    window_.end_frame();

    if (live_) {
        const LiveMethod& shown = live_->shown_method();
        const std::uint64_t samples = shown.snapshot ? shown.snapshot->iterations : 0;
        window_.set_title(
            fmt::format("lightswitch: {}: {}, {} samples, {}", scene_name(), shown.name, samples, name(view_)));
    }
}

void Interface::menu_bar() {
    if (!ImGui::BeginMainMenuBar()) return;
    for (const char* menu : {"Scene", "Method", "Compare", "View", "Pixel", "Camera", "Help"}) {
        if (!ImGui::BeginMenu(menu)) continue;
        for (const Command& command : commands_) {
            if (std::string_view(command.menu) != menu) continue;
            const bool possible = !command.is_possible || command.is_possible();
            if (ImGui::MenuItem(command.text.c_str(), command.key_text.c_str(), command.is_on && command.is_on(),
                                possible))
                command.act();
        }
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

void Interface::status_bar() {
    const ImGuiIO& io = ImGui::GetIO();
    const float height = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({0, io.DisplaySize.y - height});
    ImGui::SetNextWindowSize({io.DisplaySize.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {6 * window_.scale(), 2 * window_.scale()});
    ImGui::Begin("status", nullptr,
                 ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs);
    if (loading_.valid()) {
        ImGui::Text("opening %s ...", loading_name_.c_str());
    } else if (live_) {
        const LiveMethod& shown = live_->shown_method();
        std::string text = shown.name;
        if (const auto& s = shown.snapshot; s && s->iterations > 0) {
            text += fmt::format("   {} samples per pixel   {:.1f} s", s->iterations, s->statistics.seconds);
            if (s->statistics.seconds > 0)
                text +=
                    fmt::format("   {:.2f} Mrays/s", 1e-6 * double(s->statistics.counts.rays) / s->statistics.seconds);
            if (std::isfinite(s->error)) text += fmt::format("   estimated error {:.2g} %", 100 * s->error);
        } else {
            text += "   first picture ...";
        }
        text += fmt::format("   exposure {:+.1f}", display_.stops);
        if (display_.curve != ToneCurve::clamp) text += fmt::format(", {}", name(display_.curve));
        if (display_.channel != Channel::all) text += fmt::format(", {}", name(display_.channel));
        text += fmt::format("   zoom {:.0f} %   {}", 100 * zoom_, bytes_text(memory_in_use()));
        if (moves()) text += fmt::format("   {:.0f} frames/s", frames_per_second_);
        if (live_->held()) text += "   held";
        ImGui::TextUnformatted(text.c_str());
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void Interface::auto_expose() {
    const auto& snapshot = live_->shown_method().snapshot;
    if (!snapshot || snapshot->image.empty()) return;
    display_.stops = auto_exposure(snapshot->image);
    exposure_is_chosen_ = true;
}

void Interface::next_non_finite() {
    const auto& snapshot = live_->shown_method().snapshot;
    if (!snapshot || snapshot->statistics.counts.first_non_finite.empty()) return tell("All values are finite so far.");
    const auto& places = snapshot->statistics.counts.first_non_finite;
    const NonFinite& place = places[non_finite_++ % places.size()];
    const auto width = static_cast<std::uint32_t>(live_->film().width);
    picked_ = {static_cast<int>(place.pixel % width), static_cast<int>(place.pixel / width)};
    zoom_ = std::max(zoom_, 16.0f);
    center_ = {(picked_->first + 0.5) / live_->film().width, (picked_->second + 0.5) / live_->film().height};
    follow(static_cast<std::int64_t>(place.iteration));
    tell(fmt::format("Pixel ({}, {}), iteration {}, seed {}.", picked_->first, picked_->second, place.iteration,
                     place.seed));
}

void Interface::pick(int x, int y) {
    picked_ = {x, y};
    const auto& snapshot = live_->shown_method().snapshot;
    // The sample of a chain takes all iterations before it, and a guided one all that was learnt: only who asks for it
    // gets it.
    const std::string& method = live_->shown_method().name;
    if (snapshot && snapshot->iterations > 0 && method != Mlt::name && method != PathGuided::name)
        follow(static_cast<std::int64_t>(snapshot->iterations) - 1);
}

/// Of the picked pixel, as far as there are such iterations.
void Interface::follow(std::int64_t iteration) {
    const auto& snapshot = live_->shown_method().snapshot;
    if (!picked_) return tell("Pick a pixel first: click on it.");
    if (!snapshot || snapshot->iterations == 0) return;
    const auto last = static_cast<std::int64_t>(snapshot->iterations) - 1;
    live_->follow(
        {picked_->first, picked_->second, static_cast<std::uint64_t>(std::clamp<std::int64_t>(iteration, 0, last))},
        false);
}

void Interface::follow_brightest() {
    if (!picked_) return tell("Pick a pixel first: click on it.");
    live_->follow({picked_->first, picked_->second, 0}, true);
}

}  // namespace lightswitch::program
