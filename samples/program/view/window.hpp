#pragma once

// A window with OpenGL and Dear ImGui, and nothing of what is in it.

#include "../program.hpp"
#include "pictures.hpp"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

struct GLFWwindow;

namespace lightswitch::program {

/// One at a time, on the main thread.
class Window {
public:
    struct Key {
        int key = 0, modifiers = 0;  ///< GLFW's
        char32_t character = 0;      ///< or a character, when there is no key
    };

    /// Throws `Error` where there is no display, or none with OpenGL 3.
    Window(Size size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Waits for something to happen, at most so many seconds; from other threads `wake` ends it.
    void wait(double seconds);
    static void wake();
    void begin_frame();
    void end_frame();

    bool wants_to_close() const;
    void keep_open();
    void set_title(const std::string& title);
    /// Pixels of the interface per pixel of a usual screen.
    float scale() const { return scale_; }
    /// Whether a key is held down that no text field wants, and that was not pressed together with Control or Alt: who
    /// lets go of Control first does not mean the key alone.
    bool is_down(int key) const;
    void copy(const std::string& text);

    /// Whether the user or the system has done something since it was asked last.
    bool take_input();
    std::vector<Key> take_keys();
    std::vector<std::filesystem::path> take_dropped();

private:
    friend struct WindowCallbacks;
    void load_font();

    GLFWwindow* window_ = nullptr;
    float scale_ = 1;
    std::string title_;
    bool had_input_ = true;
    std::vector<Key> keys_;
    std::set<int> combined_;  // keys that are down since they were pressed with Control or Alt
    std::vector<std::filesystem::path> dropped_;
};

/// A picture on the graphics card. Lives within the life of the window.
class Texture {
public:
    Texture() = default;
    ~Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;

    void set(const Picture& picture);
    void clear();
    bool empty() const { return id_ == 0; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// OpenGL's number. Enlarged pixels have edges, reduced ones are smoothed.
    std::intptr_t handle(bool enlarged) const;

private:
    unsigned id_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace lightswitch::program
