#include "window.hpp"

#include <lightswitch/core/error.hpp>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lightswitch::program {

/// GLFW calls functions, which know the window by its user pointer.
struct WindowCallbacks {
    static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }
    static void key(GLFWwindow* window, int key, int, int action, int modifiers) {
        Window& self = of(window);
        self.had_input_ = true;
        if (action != GLFW_RELEASE) self.keys_.push_back({key, modifiers, 0});
        if (action == GLFW_RELEASE) self.combined_.erase(key);
        else if (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) self.combined_.insert(key);
    }
    static void character(GLFWwindow* window, unsigned code) {
        of(window).keys_.push_back({0, 0, static_cast<char32_t>(code)});
    }
    static void drop(GLFWwindow* window, int count, const char** paths) {
        of(window).had_input_ = true;
        for (int i = 0; i < count; ++i) of(window).dropped_.emplace_back(paths[i]);
    }
    static void happened(GLFWwindow* window) { of(window).had_input_ = true; }
    template <class... T>
    static void happened_with(GLFWwindow* window, T...) {
        happened(window);
    }
};

namespace {

std::string last_problem() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? std::string(": ") + text : "";
}

}  // namespace

Window::Window(Size size, const std::string& title) : title_(title) {
    if (!glfwInit()) throw Error("a window could not be opened" + last_problem() + " (is there a display?)");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string problem = last_problem();
        glfwTerminate();
        throw Error("a window could not be opened" + problem + " (OpenGL 3 is needed)");
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    // ImGui calls the callbacks that are there before its own.
    glfwSetKeyCallback(window_, WindowCallbacks::key);
    glfwSetCharCallback(window_, WindowCallbacks::character);
    glfwSetDropCallback(window_, WindowCallbacks::drop);
    glfwSetWindowRefreshCallback(window_, WindowCallbacks::happened);
    glfwSetWindowCloseCallback(window_, WindowCallbacks::happened);
    glfwSetWindowSizeCallback(window_, WindowCallbacks::happened_with<int, int>);
    glfwSetMouseButtonCallback(window_, WindowCallbacks::happened_with<int, int, int>);
    glfwSetCursorPosCallback(window_, WindowCallbacks::happened_with<double, double>);
    glfwSetScrollCallback(window_, WindowCallbacks::happened_with<double, double>);
    glfwSetWindowFocusCallback(window_, WindowCallbacks::happened_with<int>);
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // nothing is left behind
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    scale_ = std::max(1.0f, std::max(x, y));
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(scale_);
    ImGui::GetStyle().WindowRounding = 0;
    load_font();
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 130");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

/// One that systems have, or else ImGui's own, which has no other size.
void Window::load_font() {
    constexpr std::array files{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf",
                               "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
                               "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf"};
    ImGuiIO& io = ImGui::GetIO();
    for (const char* file : files) {
        std::error_code ignored;
        if (std::filesystem::exists(file, ignored) && io.Fonts->AddFontFromFileTTF(file, std::round(14 * scale_)))
            return;
    }
    io.Fonts->AddFontDefault();
    io.FontGlobalScale = scale_;
}

void Window::wait(double seconds) {
    if (seconds > 0) glfwWaitEventsTimeout(seconds);
    else glfwPollEvents();
}

void Window::wake() { glfwPostEmptyEvent(); }

void Window::begin_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::end_frame() {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.08f, 0.08f, 0.09f, 1);  // so that a black image has edges
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
}

bool Window::wants_to_close() const { return glfwWindowShouldClose(window_); }
void Window::keep_open() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

bool Window::is_down(int key) const {
    return !ImGui::GetIO().WantTextInput && !combined_.contains(key) && glfwGetKey(window_, key) == GLFW_PRESS;
}

void Window::copy(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

bool Window::take_input() { return std::exchange(had_input_, false); }
std::vector<Window::Key> Window::take_keys() { return std::exchange(keys_, {}); }
std::vector<std::filesystem::path> Window::take_dropped() { return std::exchange(dropped_, {}); }

Texture::~Texture() { clear(); }

void Texture::clear() {
    if (id_ != 0) glDeleteTextures(1, &id_);
    id_ = 0;
    width_ = height_ = 0;
}

void Texture::set(const Picture& picture) {
    if (id_ == 0) glGenTextures(1, &id_);
    glBindTexture(GL_TEXTURE_2D, id_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, 0x812F);  // to the edge; older headers do not name it
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, 0x812F);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (picture.width == width_ && picture.height == height_) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
    } else {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, picture.width, picture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     picture.rgba.data());
        width_ = picture.width;
        height_ = picture.height;
    }
}

std::intptr_t Texture::handle(bool enlarged) const {
    glBindTexture(GL_TEXTURE_2D, id_);
    const GLint filter = enlarged ? GL_NEAREST : GL_LINEAR;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    return static_cast<std::intptr_t>(id_);
}

}  // namespace lightswitch::program
