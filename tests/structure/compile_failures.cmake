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
expect_compile_failure(own_bsdf_specular own_types.cpp 5 "Bsdf.*B::specular")
expect_compile_failure(own_bsdf_problem own_types.cpp 6 "Bsdf.*bsdf\\.problem\\(\\)")
