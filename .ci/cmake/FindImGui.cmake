# Finds Dear ImGui as a library with its backends for GLFW and OpenGL 3, and defines the target imgui::imgui.

find_path(ImGui_INCLUDE_DIR NAMES imgui.h PATH_SUFFIXES imgui)
find_path(ImGui_BACKENDS_INCLUDE_DIR NAMES backends/imgui_impl_glfw.h HINTS "${ImGui_INCLUDE_DIR}")
find_library(ImGui_LIBRARY NAMES imgui)
find_library(ImGui_STB_LIBRARY NAMES stb)  # Debian's has it apart
mark_as_advanced(ImGui_INCLUDE_DIR ImGui_BACKENDS_INCLUDE_DIR ImGui_LIBRARY ImGui_STB_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ImGui REQUIRED_VARS ImGui_LIBRARY ImGui_INCLUDE_DIR ImGui_BACKENDS_INCLUDE_DIR
                                  REASON_FAILURE_MESSAGE "it is in the package libimgui-dev (Debian, Ubuntu)")

if(ImGui_FOUND AND NOT TARGET imgui::imgui)
  add_library(imgui::imgui UNKNOWN IMPORTED)
  set_target_properties(imgui::imgui PROPERTIES IMPORTED_LOCATION "${ImGui_LIBRARY}"
                                                INTERFACE_INCLUDE_DIRECTORIES "${ImGui_INCLUDE_DIR};${ImGui_BACKENDS_INCLUDE_DIR}")
  target_link_libraries(imgui::imgui INTERFACE ${CMAKE_DL_LIBS} $<$<BOOL:${ImGui_STB_LIBRARY}>:${ImGui_STB_LIBRARY}>)
endif()
