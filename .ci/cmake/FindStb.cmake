# Finds stb_image.h and stb_image_write.h and defines the target stb::stb. Distributions put it in include/stb or in include itself.

find_path(Stb_INCLUDE_DIR NAMES stb/stb_image_write.h stb_image_write.h)
find_path(Stb_READER_INCLUDE_DIR NAMES stb/stb_image.h stb_image.h HINTS "${Stb_INCLUDE_DIR}")
mark_as_advanced(Stb_INCLUDE_DIR Stb_READER_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  Stb
  REQUIRED_VARS Stb_INCLUDE_DIR Stb_READER_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "stb_image.h and stb_image_write.h are in the package libstb-dev (Debian, Ubuntu) or stb (vcpkg, Conan)")

if(Stb_FOUND AND NOT TARGET stb::stb)
  add_library(stb::stb INTERFACE IMPORTED)
  set_target_properties(stb::stb PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${Stb_INCLUDE_DIR}")
endif()
