#pragma once

// The decoders of stb_image for PNG, JPEG, BMP and TGA. The only file that includes it; see stb_decode.hpp for its use.

#include <lightswitch/core/floating_point.hpp>

#include <cassert>
#include <climits>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace lightswitch::detail {

/// The most that stb_image may allocate at once in this thread: a few bytes of deflated data can stand for gigabytes.
inline thread_local std::size_t stb_largest_block = 0;

inline void* stb_allocate(void* old, std::size_t size) {
    return size <= stb_largest_block ? std::realloc(old, size) : nullptr;
}

}  // namespace lightswitch::detail

// Its implementation is compiled here with internal linkage in our own namespace, and the macros that steer it are put
// back so that a program may use its own copy of stb_image before or after this header. Without SIMD, whose headers do
// not belong in a namespace, it also gives the same texels on all machines.
#pragma push_macro("stbi__err")
#pragma push_macro("stbi__errpf")
#pragma push_macro("stbi__errpuc")
#pragma push_macro("stbi__vertically_flip_on_load")
#pragma push_macro("STBI_HAS_LROTL")
#pragma push_macro("STBI_THREAD_LOCAL")
#pragma push_macro("STBI_NO_THREAD_LOCALS")
#pragma push_macro("STBI_INCLUDE_STB_IMAGE_H")
#pragma push_macro("STB_IMAGE_IMPLEMENTATION")
#pragma push_macro("STB_IMAGE_STATIC")
#pragma push_macro("STBIDEF")
#pragma push_macro("STBI_ASSERT")
#pragma push_macro("STBI_MALLOC")
#pragma push_macro("STBI_REALLOC")
#pragma push_macro("STBI_REALLOC_SIZED")
#pragma push_macro("STBI_FREE")
#pragma push_macro("STBI_MAX_DIMENSIONS")
#pragma push_macro("STBI_NO_STDIO")
#pragma push_macro("STBI_NO_LINEAR")
#pragma push_macro("STBI_NO_SIMD")
#pragma push_macro("STBI_NO_ZLIB")
#pragma push_macro("STBI_SUPPORT_ZLIB")
#pragma push_macro("STBI_NO_FAILURE_STRINGS")
#pragma push_macro("STBI_FAILURE_USERMSG")
#pragma push_macro("STBI_ONLY_PNG")
#pragma push_macro("STBI_ONLY_JPEG")
#pragma push_macro("STBI_ONLY_BMP")
#pragma push_macro("STBI_ONLY_TGA")
#pragma push_macro("STBI_NO_PNG")
#pragma push_macro("STBI_NO_JPEG")
#pragma push_macro("STBI_NO_BMP")
#pragma push_macro("STBI_NO_TGA")
#pragma push_macro("STBI_NO_PSD")
#pragma push_macro("STBI_NO_GIF")
#pragma push_macro("STBI_NO_HDR")
#pragma push_macro("STBI_NO_PIC")
#pragma push_macro("STBI_NO_PNM")
#undef stbi__err
#undef stbi__errpf
#undef stbi__errpuc
#undef stbi__vertically_flip_on_load
#undef STBI_HAS_LROTL
#undef STBI_THREAD_LOCAL
#undef STBI_NO_THREAD_LOCALS
#undef STBI_INCLUDE_STB_IMAGE_H
#undef STB_IMAGE_IMPLEMENTATION
#undef STB_IMAGE_STATIC
#undef STBIDEF
#undef STBI_ASSERT
#undef STBI_MALLOC
#undef STBI_REALLOC
#undef STBI_REALLOC_SIZED
#undef STBI_FREE
#undef STBI_MAX_DIMENSIONS
#undef STBI_NO_STDIO
#undef STBI_NO_LINEAR
#undef STBI_NO_SIMD
#undef STBI_NO_ZLIB
#undef STBI_SUPPORT_ZLIB
#undef STBI_NO_FAILURE_STRINGS
#undef STBI_FAILURE_USERMSG
#undef STBI_ONLY_PNG
#undef STBI_ONLY_JPEG
#undef STBI_ONLY_BMP
#undef STBI_ONLY_TGA
#undef STBI_NO_PNG
#undef STBI_NO_JPEG
#undef STBI_NO_BMP
#undef STBI_NO_TGA
#undef STBI_NO_PSD
#undef STBI_NO_GIF
#undef STBI_NO_HDR
#undef STBI_NO_PIC
#undef STBI_NO_PNM
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_SIMD
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_MAX_DIMENSIONS 65536
#define STBI_ASSERT(condition) assert(condition)
#define STBI_MALLOC(size) ::lightswitch::detail::stb_allocate(nullptr, size)
#define STBI_REALLOC(block, size) ::lightswitch::detail::stb_allocate(block, size)
#define STBI_FREE(block) ::std::free(block)
// Declared extern "C", which is one function in all namespaces: by these names they would be the program's own.
#define stbi_load_from_memory lightswitch_stbi_load_from_memory
#define stbi_load_from_callbacks lightswitch_stbi_load_from_callbacks
#define stbi_load_16_from_memory lightswitch_stbi_load_16_from_memory
#define stbi_load_16_from_callbacks lightswitch_stbi_load_16_from_callbacks
#define stbi_is_hdr_from_callbacks lightswitch_stbi_is_hdr_from_callbacks
#define stbi_is_hdr_from_memory lightswitch_stbi_is_hdr_from_memory
#define stbi_hdr_to_ldr_gamma lightswitch_stbi_hdr_to_ldr_gamma
#define stbi_hdr_to_ldr_scale lightswitch_stbi_hdr_to_ldr_scale
#define stbi_failure_reason lightswitch_stbi_failure_reason
#define stbi_image_free lightswitch_stbi_image_free
#define stbi_info_from_memory lightswitch_stbi_info_from_memory
#define stbi_info_from_callbacks lightswitch_stbi_info_from_callbacks
#define stbi_is_16_bit_from_memory lightswitch_stbi_is_16_bit_from_memory
#define stbi_is_16_bit_from_callbacks lightswitch_stbi_is_16_bit_from_callbacks
#define stbi_set_unpremultiply_on_load lightswitch_stbi_set_unpremultiply_on_load
#define stbi_convert_iphone_png_to_rgb lightswitch_stbi_convert_iphone_png_to_rgb
#define stbi_set_flip_vertically_on_load lightswitch_stbi_set_flip_vertically_on_load
#define stbi_set_unpremultiply_on_load_thread lightswitch_stbi_set_unpremultiply_on_load_thread
#define stbi_convert_iphone_png_to_rgb_thread lightswitch_stbi_convert_iphone_png_to_rgb_thread
#define stbi_set_flip_vertically_on_load_thread lightswitch_stbi_set_flip_vertically_on_load_thread
#define stbi_zlib_decode_malloc_guesssize lightswitch_stbi_zlib_decode_malloc_guesssize
#define stbi_zlib_decode_malloc_guesssize_headerflag lightswitch_stbi_zlib_decode_malloc_guesssize_headerflag
#define stbi_zlib_decode_malloc lightswitch_stbi_zlib_decode_malloc
#define stbi_zlib_decode_buffer lightswitch_stbi_zlib_decode_buffer
#define stbi_zlib_decode_noheader_malloc lightswitch_stbi_zlib_decode_noheader_malloc
#define stbi_zlib_decode_noheader_buffer lightswitch_stbi_zlib_decode_noheader_buffer
// In damaged JPEG files its integers overflow, which nothing depends on: they are to wrap.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((no_sanitize("signed-integer-overflow"))), apply_to = function)
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("wrapv")
#endif
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
namespace lightswitch::detail::stb_read {
#if __has_include(<stb/stb_image.h>)
#include <stb/stb_image.h>
#else
#include <stb_image.h>
#endif
}  // namespace lightswitch::detail::stb_read
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#if defined(__clang__)
#pragma clang attribute pop
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif
#undef stbi_load_from_memory
#undef stbi_load_from_callbacks
#undef stbi_load_16_from_memory
#undef stbi_load_16_from_callbacks
#undef stbi_is_hdr_from_callbacks
#undef stbi_is_hdr_from_memory
#undef stbi_hdr_to_ldr_gamma
#undef stbi_hdr_to_ldr_scale
#undef stbi_failure_reason
#undef stbi_image_free
#undef stbi_info_from_memory
#undef stbi_info_from_callbacks
#undef stbi_is_16_bit_from_memory
#undef stbi_is_16_bit_from_callbacks
#undef stbi_set_unpremultiply_on_load
#undef stbi_convert_iphone_png_to_rgb
#undef stbi_set_flip_vertically_on_load
#undef stbi_set_unpremultiply_on_load_thread
#undef stbi_convert_iphone_png_to_rgb_thread
#undef stbi_set_flip_vertically_on_load_thread
#undef stbi_zlib_decode_malloc_guesssize
#undef stbi_zlib_decode_malloc_guesssize_headerflag
#undef stbi_zlib_decode_malloc
#undef stbi_zlib_decode_buffer
#undef stbi_zlib_decode_noheader_malloc
#undef stbi_zlib_decode_noheader_buffer
#pragma pop_macro("STBI_NO_PNM")
#pragma pop_macro("STBI_NO_PIC")
#pragma pop_macro("STBI_NO_HDR")
#pragma pop_macro("STBI_NO_GIF")
#pragma pop_macro("STBI_NO_PSD")
#pragma pop_macro("STBI_NO_TGA")
#pragma pop_macro("STBI_NO_BMP")
#pragma pop_macro("STBI_NO_JPEG")
#pragma pop_macro("STBI_NO_PNG")
#pragma pop_macro("STBI_ONLY_TGA")
#pragma pop_macro("STBI_ONLY_BMP")
#pragma pop_macro("STBI_ONLY_JPEG")
#pragma pop_macro("STBI_ONLY_PNG")
#pragma pop_macro("STBI_FAILURE_USERMSG")
#pragma pop_macro("STBI_NO_FAILURE_STRINGS")
#pragma pop_macro("STBI_SUPPORT_ZLIB")
#pragma pop_macro("STBI_NO_ZLIB")
#pragma pop_macro("STBI_NO_SIMD")
#pragma pop_macro("STBI_NO_LINEAR")
#pragma pop_macro("STBI_NO_STDIO")
#pragma pop_macro("STBI_MAX_DIMENSIONS")
#pragma pop_macro("STBI_FREE")
#pragma pop_macro("STBI_REALLOC_SIZED")
#pragma pop_macro("STBI_REALLOC")
#pragma pop_macro("STBI_MALLOC")
#pragma pop_macro("STBI_ASSERT")
#pragma pop_macro("STBIDEF")
#pragma pop_macro("STB_IMAGE_STATIC")
#pragma pop_macro("STB_IMAGE_IMPLEMENTATION")
#pragma pop_macro("STBI_INCLUDE_STB_IMAGE_H")
#pragma pop_macro("STBI_NO_THREAD_LOCALS")
#pragma pop_macro("STBI_THREAD_LOCAL")
#pragma pop_macro("STBI_HAS_LROTL")
#pragma pop_macro("stbi__vertically_flip_on_load")
#pragma pop_macro("stbi__errpuc")
#pragma pop_macro("stbi__errpf")
#pragma pop_macro("stbi__err")
