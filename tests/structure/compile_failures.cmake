# What must not compile: expect_compile_failure(<name> <source> <case> <regex>), see CMakeLists.txt.

set(no_conversion "no known conversion|could not convert|no viable")
expect_compile_failure(pdf_order pdf_mixing.cpp 1 "operator<|binary expression")
expect_compile_failure(pdf_equality pdf_mixing.cpp 2 "operator==|binary expression")
expect_compile_failure(pdf_weight pdf_mixing.cpp 3 "${no_conversion}")
expect_compile_failure(pdf_assignment pdf_mixing.cpp 4 "operator=|${no_conversion}")
expect_compile_failure(pdf_conversion pdf_mixing.cpp 5 "${no_conversion}")
expect_compile_failure(pdf_sum pdf_mixing.cpp 6 "operator\\+|binary expression")

set(method_needs "a rendering method needs")
expect_compile_failure(own_method_kind own_types.cpp 1 "${method_needs}")
expect_compile_failure(own_method_radiance own_types.cpp 2 "${method_needs}")
expect_compile_failure(own_method_const own_types.cpp 3 "${method_needs}")
expect_compile_failure(own_method_iterate own_types.cpp 4 "${method_needs}")
# The type that is no surface model is named, though nothing but the scene's type mentions it:
# by GCC before the message, by Clang after it.
set(no_surface_model "(RequireBsdf<Chalk>.*a surface model needs|a surface model needs.*RequireBsdf<Chalk>)")
set(no_scene "RequireScene<int>.*what is rendered must be a scene|what is rendered must be a scene.*RequireScene<int>")
expect_compile_failure(own_bsdf_specular own_types.cpp 5 "${no_surface_model}.*B::specular")
expect_compile_failure(own_bsdf_problem own_types.cpp 6 "${no_surface_model}.*bsdf\\.problem\\(\\)")
expect_compile_failure(own_bsdf_described own_types.cpp 18 "${no_surface_model}.*bsdf\\.problem\\(\\)")
expect_compile_failure(own_pixels_ray own_types.cpp 7 "frame\\.pixels needs a function")
expect_compile_failure(own_pixels_value own_types.cpp 8 "frame\\.pixels needs a function")
expect_compile_failure(own_pixels_mutable own_types.cpp 9 "frame\\.pixels needs a function.*must not be .mutable")
expect_compile_failure(own_paths_splatter own_types.cpp 10 "frame\\.paths needs a function")
expect_compile_failure(own_paths_mutable own_types.cpp 11 "frame\\.paths needs a function.*must not be .mutable")
expect_compile_failure(render_no_scene own_types.cpp 12 "${no_scene}")
expect_compile_failure(render_any_scene own_types.cpp 13 "what is rendered must be a scene.*std::visit")
expect_compile_failure(verify_no_scene own_types.cpp 14 "${no_scene}")
expect_compile_failure(render_any_method own_types.cpp 15 "${method_needs}.*std::visit")
expect_compile_failure(own_light_source own_types.cpp 16 "a light in a description also needs .light\\(const RenderSpace")
expect_compile_failure(own_camera_rays own_types.cpp 17 "methods that connect light paths to the camera")

foreach(option IN ITEMS -ffast-math -ffinite-math-only)
  expect_compile_failure(refused${option} fast_math.cpp 1 "lightswitch: compiled with -ffast-math.*LIGHTSWITCH_ALLOW_FAST_MATH"
                         ${option})
endforeach()

expect_compile_failure(kinds_of_bsdfs scenes.cpp 1 "at most 30 kinds of surface models")
expect_compile_failure(kinds_of_lights scenes.cpp 2 "at most 31 kinds of lights")
set(deleted_session "(use of|call to) deleted (function|constructor).*Session")
expect_compile_failure(session_of_temporary scenes.cpp 3 "${deleted_session}")
expect_compile_failure(session_of_temporary_executor scenes.cpp 4 "${deleted_session}")
