// Renders in the background while a window of your own shows what there is: keys 1 to 4 switch the method, which keeps
// what it has made; the arrow keys turn the camera. `--frames N` ends it after so many.

#include <lightswitch/compiled.hpp>
#include <lightswitch/film/tonemap.hpp>
#include <lightswitch/render/interactive.hpp>
#include <lightswitch/scene/stock.hpp>

#include <GLFW/glfw3.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace ls = lightswitch;

/// The image at the window's top left corner, by the oldest way that OpenGL has.
void draw(const ls::Image& image, int width, int height) {
    const std::string bytes = ls::tone_map(image, 1.5f);
    glClear(GL_COLOR_BUFFER_BIT);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glRasterPos2f(-1, 1);
    glPixelZoom(float(width) / float(image.width()), -float(height) / float(image.height()));
    glDrawPixels(image.width(), image.height(), GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
}

int main(int argc, char** argv) try {
    const int frames = argc == 3 && std::string(argv[1]) == "--frames" ? std::atoi(argv[2]) : -1;
    if (!glfwInit()) throw ls::Error("there is no display");
    GLFWwindow* const window = glfwCreateWindow(512, 512, "lightswitch", nullptr, nullptr);
    if (!window) throw ls::Error("there is no OpenGL");
    glfwMakeContextCurrent(window);

    const ls::LibraryDescription description = *ls::stock::describe("cornell-spheres");
    ls::InteractiveRender live(ls::build_any(description), description.camera, {}, [] { glfwPostEmptyEvent(); });
    for (const char* name : {"path-nee", "bdpt", "photon", "mlt"}) live.add(ls::method_by_name(name));
    std::size_t shown = 0;
    live.show(shown);

    double angle = 0;  // around the vertical axis, in degrees
    for (int frame = 0; frame != frames && !glfwWindowShouldClose(window); ++frame) {
        for (std::size_t i = 0; i < 4; ++i)
            if (glfwGetKey(window, GLFW_KEY_1 + int(i)) == GLFW_PRESS && i != shown) live.show(shown = i);
        const double step = 2.0 * (glfwGetKey(window, GLFW_KEY_RIGHT) - glfwGetKey(window, GLFW_KEY_LEFT));
        if (step != 0) {
            ls::CameraDescription camera = description.camera;
            angle += step;
            camera.to_world *=
                glm::dmat4(glm::dmat3(std::cos(glm::radians(angle)), 0, std::sin(glm::radians(angle)), 0, 1, 0,
                                      -std::sin(glm::radians(angle)), 0, std::cos(glm::radians(angle))));
            live.move(camera, description.film);
        }
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        if (const auto snapshot = live.snapshot(shown)) draw(snapshot->image, width, height);
        glfwSwapBuffers(window);
        glfwWaitEventsTimeout(0.1);
    }
    glfwTerminate();
} catch (const ls::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
