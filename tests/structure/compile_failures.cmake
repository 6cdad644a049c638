# What must not compile: expect_compile_failure(<name> <source> <case> <regex>), see CMakeLists.txt.

set(no_conversion "no known conversion|could not convert|no viable")
expect_compile_failure(pdf_order pdf_mixing.cpp 1 "operator<|binary expression")
expect_compile_failure(pdf_equality pdf_mixing.cpp 2 "operator==|binary expression")
expect_compile_failure(pdf_weight pdf_mixing.cpp 3 "${no_conversion}")
expect_compile_failure(pdf_assignment pdf_mixing.cpp 4 "operator=|${no_conversion}")
expect_compile_failure(pdf_conversion pdf_mixing.cpp 5 "${no_conversion}")
expect_compile_failure(pdf_sum pdf_mixing.cpp 6 "operator\\+|binary expression")
