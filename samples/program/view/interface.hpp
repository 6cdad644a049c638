#pragma once

// What the window shows, and what keys, menus and mouse do in it.

#include "live_scene.hpp"
#include "pictures.hpp"
#include "window.hpp"

#include <array>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch::program {

/// What fills the image's place.
enum class View {
    image,
    side_by_side,
    split,
    flicker,
    difference,
    relative,
    significance,
    albedo,
    normal,
    depth,
};
std::string_view name(View view);

/// Such as "12.3 MB".
std::string bytes_text(double bytes);

/// Draws a window's contents once per `frame`. Uses `live` while a scene is there.
class Interface {
public:
    Interface(Window& window, const ViewOptions& options);

    /// Shows another scene.
    void set_scene(LoadedScene loaded, const ViewOptions& options);
    const LiveScene* scene() const { return live_.get(); }

    void frame();
    /// Whether the next frame differs from this one though nothing happens.
    bool moves() const;
    /// Whether what comes next should be seen at once: first pictures.
    bool is_waited_for() const;
    bool wants_to_close() const { return closes_; }
    /// Closes, but asks first if something would be lost.
    void close();

private:
    struct Command {
        const char* menu;
        std::string text, key_text;
        int key, modifiers;
        std::function<void()> act;
        std::function<bool()> is_on = {};        // for a tick
        std::function<bool()> is_possible = {};  // empty: always
    };
    /// What is drawn of a film, and where on the screen.
    struct Place {
        float x, y, width, height;  // of the area that it may use
        float left, top, size;      // of the image's corner, and of one of its pixels
    };

    void make_commands();
    void add(const char* menu, std::string text, std::string key_text, int key, int modifiers,
             std::function<void()> act, std::function<bool()> is_on = {}, std::function<bool()> is_possible = {});
    void handle_keys();
    void fly();
    void menu_bar();
    void status_bar();
    void popups();
    void help();
    void save_popup();
    void open_popup();
    void message_popup();
    void loss_popup();

    // image_area.cpp
    void image_area(float width, float height);
    void draw_views(const Place& whole);
    void draw_texture(const Texture& texture, const Place& place);
    void draw_values(const Place& place, const Image& image);
    void draw_label(const Place& place, const std::string& text);
    void draw_legend(const Place& place);
    void handle_mouse(const Place& place);
    Place place_in(float x, float y, float width, float height) const;
    void update_pictures();
    void picture_of_snapshot(Texture& texture, std::shared_ptr<const Snapshot>& drawn, const LiveMethod* method,
                             bool changed);
    bool compares() const;

    // panels.cpp
    float panel_width() const;
    void side_panel();
    void method_table();
    void compare_panel();
    void verdict_panel();
    void plot_panel(float width);
    void pixel_panel();
    void path_window();
    void problems_panel();

    void begin_save(const std::string& ending);
    void save(const std::filesystem::path& file);
    void open(const std::string& scene);
    void begin_to_open(const std::string& scene);
    /// Does it, but asks first if something would be lost.
    void unless_lost(const char* what, std::function<void()> act);
    /// Whether something is over the window that keys belong to.
    bool asks() const { return saves_ || opens_ || would_lose_; }
    void pick(int x, int y);
    void follow(std::int64_t iteration);
    void follow_brightest();
    void auto_expose();
    void next_non_finite();
    void tell(std::string message);
    std::string scene_name() const;

    Window& window_;
    ViewOptions options_;
    std::unique_ptr<LiveScene> live_;
    std::vector<Command> commands_;
    bool closes_ = false, shows_panel_ = true, shows_help_ = false;
    bool escaped_ = false, entered_ = false;  // the keys, since the last frame

    View view_ = View::image;
    Display display_, drawn_display_;
    bool exposure_is_chosen_ = false;
    float zoom_ = 1;
    DVec2 center_{0.5};  // of what is seen, as a fraction of the image
    float split_ = 0.5f;
    bool drags_split_ = false, moves_camera_ = false;
    DVec2 drag_{0};  // how far the mouse has moved with a button down
    std::optional<std::pair<int, int>> picked_;
    std::size_t non_finite_ = 0;

    Texture ours_, theirs_, numbers_, legend_, output_;
    std::shared_ptr<const Snapshot> drawn_ours_, drawn_theirs_, numbers_ours_, numbers_theirs_;
    std::shared_ptr<const std::vector<Layer>> drawn_outputs_;
    View numbers_view_ = View::image, output_view_ = View::image;
    Image number_image_;
    float legend_scale_ = 0;
    int legend_width_ = 0;

    std::chrono::steady_clock::time_point told_{};
    std::string message_, save_name_, save_problem_, open_name_;
    bool saves_ = false, opens_ = false;
    std::function<void()> would_lose_;  // what is asked about
    const char* lost_by_ = "";
    std::future<LoadedScene> loading_;
    std::string loading_name_;
    double frames_per_second_ = 0;
    std::chrono::steady_clock::time_point last_frame_{};
};

}  // namespace lightswitch::program
