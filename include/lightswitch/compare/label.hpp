#pragma once

// Text drawn into images with a built-in 5 x 7 dot font.

#include <lightswitch/film/image.hpp>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace lightswitch {

namespace detail {

/// The printable ASCII characters from the blank to the tilde. A glyph is seven rows from the top; a row is a digit to
/// base 32 (0-9, a-v) whose highest bit is the leftmost of five dots.
// clang-format off
inline constexpr std::string_view glyphs =
    "0000000" "4444404" "aa00000" "aavavaa" "4fke5u4" "op248j3" "cik8lid" "4400000"   //   ! " # $ % & '
    "2488842" "8422248" "04lel40" "044v440" "0000c48" "000v000" "00000cc" "01248g0"   // ( ) * + , - . /
    "ehjlphe" "4c4444e" "eh1248v" "v2421he" "26aiv22" "vgu11he" "68guhhe" "v124888"   // 0 1 2 3 4 5 6 7
    "ehhehhe" "ehhf12c" "0cc0cc0" "0cc0c48" "248g842" "00v0v00" "8421248" "eh12404"   // 8 9 : ; < = > ?
    "eh1dlle" "ehhvhhh" "uhhuhhu" "ehggghe" "sihhhis" "vgguggv" "vgguggg" "ehgnhhf"   // @ A B C D E F G
    "hhhvhhh" "e44444e" "72222ic" "hikokih" "ggggggv" "hrllhhh" "hhpljhh" "ehhhhhe"   // H I J K L M N O
    "uhhuggg" "ehhhlid" "uhhukih" "fgge11u" "v444444" "hhhhhhe" "hhhhha4" "hhhllla"   // P Q R S T U V W
    "hha4ahh" "hhha444" "v1248gv" "e88888e" "0g84210" "e22222e" "4ah0000" "000000v"   // X Y Z [ \ ] ^ _
    "8420000" "00e1fhf" "ggmphhu" "00egghe" "11djhhf" "00ehvge" "698s888" "0fhhf1e"   // ` a b c d e f g
    "ggmphhh" "40c444e" "20622ic" "ggikoki" "c44444e" "00qllhh" "00mphhh" "00ehhhe"   // h i j k l m n o
    "00uhugg" "00djf11" "00mpggg" "00ege1u" "88s8896" "00hhhjd" "00hhha4" "00hhlla"   // p q r s t u v w
    "00ha4ah" "00hhf1e" "00v248v" "2448442" "4444444" "8442448" "009li00";             // x y z { | } ~
// clang-format on
static_assert(glyphs.size() == 95 * 7);

/// The row `y` (0 to 6) of a character as five bits; '?' for what the font does not hold.
constexpr unsigned glyph_row(char character, int y) {
    const char known = character >= ' ' && character <= '~' ? character : '?';
    const char digit = glyphs[static_cast<std::size_t>(known - ' ') * 7 + static_cast<std::size_t>(y)];
    return static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
}

}  // namespace detail

inline constexpr int glyph_advance = 6;  ///< from one character to the next, in dots
inline constexpr int glyph_height = 7;   ///< of a line without leading, in dots

/// Width of `text` in pixels when a dot is `scale` pixels wide, without the gap after the last character.
constexpr int text_width(std::string_view text, int scale = 1) {
    return text.empty() ? 0 : (static_cast<int>(text.size()) * glyph_advance - 1) * scale;
}

/// Draws one line of ASCII text with its upper left corner at (x, y) and dots of `scale` x `scale` pixels. Whatever
/// leaves the image is cut off; other characters show as '?'.
inline void draw_text(Image& image, int x, int y, std::string_view text, const Rgb& color, int scale = 1) {
    for (const char character : text) {
        for (int row = 0; row < glyph_height * scale; ++row)
            for (int column = 0; column < 5 * scale; ++column) {
                const bool set = (detail::glyph_row(character, row / scale) >> (4 - column / scale) & 1) != 0;
                const int px = x + column, py = y + row;
                if (set && px >= 0 && px < image.width() && py >= 0 && py < image.height()) image(px, py) = color;
            }
        x += glyph_advance * scale;
    }
}

/// Fills a rectangle; whatever leaves the image is cut off.
inline void fill_rectangle(Image& image, int x, int y, int width, int height, const Rgb& color) {
    for (int py = std::max(y, 0); py < std::min(y + height, image.height()); ++py)
        for (int px = std::max(x, 0); px < std::min(x + width, image.width()); ++px) image(px, py) = color;
}

/// Copies `source` into `image` with its upper left corner at (x, y); whatever leaves the image is cut off.
inline void paste(Image& image, int x, int y, const Image& source) {
    for (int row = std::max(0, -y); row < std::min(source.height(), image.height() - y); ++row)
        for (int column = std::max(0, -x); column < std::min(source.width(), image.width() - x); ++column)
            image(x + column, y + row) = source(column, row);
}

}  // namespace lightswitch
