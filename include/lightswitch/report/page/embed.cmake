# cmake [-D CHECK=ON] -P embed.cmake: writes ../page.hpp, which holds the files of this folder as text, so that the headers
# need nothing but themselves; or checks that it is what it would write.

set(text [[
#pragma once

// The files in page/, which make a report's page. Written by page/embed.cmake: edit those and run
//   cmake -P include/lightswitch/report/page/embed.cmake

#include <lightswitch/core/floating_point.hpp>

namespace lightswitch::detail {
]])
foreach(file IN ITEMS head.html style.css viewer.html facts.html pixels.js charts.js viewer.js)
  file(READ "${CMAKE_CURRENT_LIST_DIR}/${file}" content)
  string(REPLACE "." "_" name "${file}")
  string(APPEND text "\ninline constexpr const char* page_${name} = R\"page(${content})page\";\n")
endforeach()
string(APPEND text "\n}  // namespace lightswitch::detail\n")

set(header "${CMAKE_CURRENT_LIST_DIR}/../page.hpp")
if(NOT CHECK)
  file(WRITE "${header}" "${text}")
else()
  file(READ "${header}" written)
  if(NOT written STREQUAL text)
    message(FATAL_ERROR "report/page.hpp is not made of the files in report/page/: run cmake -P ${CMAKE_CURRENT_LIST_FILE}")
  endif()
endif()
