// What keys and menus do.

#include "interface.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdio>

namespace lightswitch::program {

void Interface::add(const char* menu, std::string text, std::string key_text, int key, int modifiers,
                    std::function<void()> act, std::function<bool()> is_on, std::function<bool()> is_possible) {
    commands_.push_back({menu, std::move(text), std::move(key_text), key, modifiers, std::move(act), std::move(is_on),
                         std::move(is_possible)});
}

void Interface::make_commands() {
    constexpr int shift = GLFW_MOD_SHIFT, control = GLFW_MOD_CONTROL;
    const auto there = [this] { return live_ != nullptr; };
    const auto compared = [this] { return live_ && live_->reference(); };

    add("Scene", "Open ...", "Ctrl+O", GLFW_KEY_O, control, [this] {
        opens_ = true;
        open_name_.clear();
    });
    add(
        "Scene", "Save picture (.png) ...", "Ctrl+S", GLFW_KEY_S, control, [this] { begin_save(".png"); }, {}, there);
    add(
        "Scene", "Save image (.exr) ...", "Ctrl+E", GLFW_KEY_E, control, [this] { begin_save(".exr"); }, {}, there);
    add(
        "Scene", "Save comparison page (.html) ...", "Ctrl+R", GLFW_KEY_R, control, [this] { begin_save(".html"); }, {},
        there);
    add("Scene", "Quit", "Ctrl+Q", GLFW_KEY_Q, control, [this] { close(); });

    std::size_t number = 0;
    for_each_method([&](const auto& m) {
        const std::size_t i = number++;
        if (i > 9) return;
        const std::string digit = std::to_string(i);
        add(
            "Method", std::string(m.name), digit, GLFW_KEY_0 + static_cast<int>(i), 0, [this, i] { live_->show(i); },
            [this, i] { return live_ && live_->shown() == i; }, there);
        add(
            "Compare", "with " + std::string(m.name), "Shift+" + digit, GLFW_KEY_0 + static_cast<int>(i), shift,
            [this, i] { live_->compare_with(i); }, [this, i] { return live_ && live_->reference() == i; }, there);
    });
    add(
        "Method", "Hold", "P", GLFW_KEY_P, 0, [this] { live_->hold(!live_->held()); },
        [this] { return live_ && live_->held(); }, there);
    add(
        "Compare", "with nothing", "Shift+Backspace", GLFW_KEY_BACKSPACE, shift,
        [this] {
            live_->compare_with({});
            if (compares()) view_ = View::image;
        },
        [this] { return live_ && !live_->reference(); }, there);
    add(
        "Compare", "Swap the two", "X", GLFW_KEY_X, 0,
        [this] {
            const std::size_t shown = live_->shown();
            live_->show(*live_->reference());
            live_->compare_with(shown);
        },
        {}, compared);
    add(
        "Compare", "Render the reference in the background", "B", GLFW_KEY_B, 0,
        [this] { live_->set_in_background(!live_->in_background()); },
        [this] { return live_ && live_->in_background(); }, there);
    add(
        "Compare", "Verify", "V", GLFW_KEY_V, 0, [this] { live_->set_verifies(!live_->verifies()); },
        [this] { return live_ && live_->verifies(); }, compared);

    for (int i = 0; i <= static_cast<int>(View::depth); ++i) {
        const auto view = static_cast<View>(i);
        const bool two = view > View::image && view < View::albedo;
        add(
            "View", std::string(name(view)), fmt::format("F{}", i + 2), GLFW_KEY_F2 + i, 0,
            [this, view] { view_ = view; }, [this, view] { return view_ == view; },
            two ? std::function<bool()>(compared) : there);
    }
    add("View", "Brighter", "=", GLFW_KEY_EQUAL, 0, [this] { display_.stops += 0.5f; });
    add("View", "Darker", "-", GLFW_KEY_MINUS, 0, [this] { display_.stops -= 0.5f; });
    add(
        "View", "Expose by the image", "O", GLFW_KEY_O, 0, [this] { auto_expose(); }, {}, there);
    add(
        "View", "Filmic tones", "T", GLFW_KEY_T, 0,
        [this] { display_.curve = display_.curve == ToneCurve::clamp ? ToneCurve::filmic : ToneCurve::clamp; },
        [this] { return display_.curve == ToneCurve::filmic; });
    add("View", "Next channel", "C", GLFW_KEY_C, 0,
        [this] { display_.channel = static_cast<Channel>((static_cast<int>(display_.channel) + 1) % 5); });
    add("View", "Zoom: all", "Z", GLFW_KEY_Z, 0, [this] {
        zoom_ = 1;
        center_ = DVec2(0.5);
    });
    add("View", "Zoom in", "PageUp", GLFW_KEY_PAGE_UP, 0, [this] { zoom_ = std::min(zoom_ * 2, 1024.0f); });
    add("View", "Zoom out", "PageDown", GLFW_KEY_PAGE_DOWN, 0, [this] { zoom_ = std::max(zoom_ / 2, 0.25f); });
    add(
        "View", "Next value that is not finite", "N", GLFW_KEY_N, 0, [this] { next_non_finite(); }, {}, there);
    const auto neighbour = [this](int step) {
        const auto path = live_->followed();
        follow(path ? static_cast<std::int64_t>(path->at.iteration) + step : 0);
    };
    add(
        "Pixel", "Path of a later sample", "Y", GLFW_KEY_Y, 0, [=] { neighbour(1); }, {}, there);
    add(
        "Pixel", "Path of an earlier sample", "Shift+Y", GLFW_KEY_Y, shift, [=] { neighbour(-1); }, {}, there);
    add(
        "Pixel", "Path of the brightest sample", "U", GLFW_KEY_U, 0, [this] { follow_brightest(); }, {}, there);
    add(
        "Pixel", "None", "Esc", GLFW_KEY_ESCAPE, 0, [this] { picked_.reset(); }, {}, there);
    add(
        "View", "Panel", "H", GLFW_KEY_H, 0, [this] { shows_panel_ = !shows_panel_; }, [this] { return shows_panel_; });

    add(
        "Camera", "Back to the start", "Home", GLFW_KEY_HOME, 0, [this] { live_->camera.reset(); }, {}, there);
    add(
        "Camera", "Wider", ".", GLFW_KEY_PERIOD, 0, [this] { live_->camera.widen(1.1); }, {}, there);
    add(
        "Camera", "Narrower", ",", GLFW_KEY_COMMA, 0, [this] { live_->camera.widen(1 / 1.1); }, {}, there);
    add(
        "Camera", "Turn left", "Left", GLFW_KEY_LEFT, 0, [this] { live_->camera.orbit(0.05, 0); }, {}, there);
    add(
        "Camera", "Turn right", "Right", GLFW_KEY_RIGHT, 0, [this] { live_->camera.orbit(-0.05, 0); }, {}, there);
    add(
        "Camera", "Turn up", "Up", GLFW_KEY_UP, 0, [this] { live_->camera.orbit(0, 0.05); }, {}, there);
    add(
        "Camera", "Turn down", "Down", GLFW_KEY_DOWN, 0, [this] { live_->camera.orbit(0, -0.05); }, {}, there);
    const auto copy = [this](const std::string& text, const char* what) {
        window_.copy(text);
        // Where nobody keeps the clipboard, it is gone with the window.
        fmt::print("{}", text);
        std::fflush(stdout);
        tell(fmt::format("The camera is copied as {}, and printed.", what));
    };
    add(
        "Camera", "Copy as XML", "Ctrl+C", GLFW_KEY_C, control,
        [=, this] { copy(camera_xml(live_->camera.description(), live_->film()), "a <sensor>"); }, {}, there);
    add(
        "Camera", "Copy as C++", "Ctrl+Shift+C", GLFW_KEY_C, control | shift,
        [=, this] { copy(camera_code(live_->camera.description(), live_->film()), "C++"); }, {}, there);
    add(
        "Help", "Keys and mouse", "F1 or ?", GLFW_KEY_F1, 0, [this] { shows_help_ = !shows_help_; },
        [this] { return shows_help_; });
}

void Interface::handle_keys() {
    // ImGui overlooks keys that are pressed and released between two frames.
    escaped_ = entered_ = false;
    for (const Window::Key& key : window_.take_keys()) {
        if (key.character != 0) {
            if (key.character == U'?' && !ImGui::GetIO().WantTextInput) shows_help_ = !shows_help_;
            continue;
        }
        if (key.key == GLFW_KEY_ESCAPE) {
            escaped_ = true;
            shows_help_ = false;
            message_.clear();
            if (!asks()) picked_.reset();
            continue;
        }
        entered_ = entered_ || key.key == GLFW_KEY_ENTER || key.key == GLFW_KEY_KP_ENTER;
        if (ImGui::GetIO().WantTextInput || asks()) continue;
        const int relevant = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;
        for (const Command& command : commands_) {
            if (command.key != key.key || command.modifiers != (key.modifiers & relevant)) continue;
            if (!command.is_possible || command.is_possible()) {
                command.act();
            } else if (live_) {
                tell(fmt::format("{}: choose what to compare with first (Shift and a digit).", command.text));
            }
            break;
        }
    }
}

/// While W, A, S, D, Q or E are held down.
void Interface::fly() {
    moves_camera_ = false;
    if (!live_ || asks()) return;
    const auto axis = [&](int positive, int negative) {
        return double(window_.is_down(positive)) - double(window_.is_down(negative));
    };
    const DVec3 step(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
    if (step == DVec3(0)) return;
    const bool fast = window_.is_down(GLFW_KEY_LEFT_SHIFT) || window_.is_down(GLFW_KEY_RIGHT_SHIFT);
    const double amount = (fast ? 2.0 : 0.5) * std::min(double(ImGui::GetIO().DeltaTime), 0.1);
    live_->camera.fly(amount * step.x, amount * step.y, amount * step.z);
    moves_camera_ = true;
}

}  // namespace lightswitch::program
