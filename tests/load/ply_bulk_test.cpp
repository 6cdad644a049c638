// Files long enough that the common layouts are read in bulk, with something out of the ordinary now and then.

#include "load/files.hpp"

#include <lightswitch/load/ply.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <limits>

using namespace lightswitch;
using namespace lightswitch::test;

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// What a file has, by name.
struct Layout {
    bool ascii = false, big_endian = false, wide = false;  ///< wide: double instead of float, int instead of uchar
    bool normals = false, uvs = false, extra = false, quads = false;  ///< quads: besides triangles
};

struct File {
    std::string bytes;
    std::vector<std::size_t> vertices, faces;  ///< where each begins
    Mesh mesh;                                 ///< what it says
};

class Writer {
public:
    explicit Writer(const Layout& layout) : layout_(layout) {}

    /// A curved sheet of `rows` rows, whose triangles and quadrilaterals face one way.
    File write(std::uint32_t rows) {
        constexpr std::uint32_t columns = 20;
        const std::string real = layout_.wide ? "double" : "float";
        text("ply\nformat " +
             std::string(layout_.ascii        ? "ascii"
                         : layout_.big_endian ? "binary_big_endian"
                                              : "binary_little_endian") +
             " 1.0\nelement vertex " + std::to_string(rows * columns) + "\n");
        if (layout_.extra) text("property uchar red\n");
        for (const char* name : {"x", "y", "z"}) text("property " + real + " " + name + "\n");
        if (layout_.extra) text("property double quality\n");
        if (layout_.normals)
            for (const char* name : {"nx", "ny", "nz"}) text("property float " + std::string(name) + "\n");
        if (layout_.uvs)
            for (const char* name : {"v", "u"}) text("property float " + std::string(name) + "\n");
        const std::uint32_t cells = (rows - 1) * (columns - 1);
        text("element face " + std::to_string(layout_.quads ? cells + (cells + 2) / 3 : 2 * cells) + "\n");
        if (layout_.extra) text("property short group\n");
        text(layout_.wide ? "property list int uint vertex_index\n" : "property list uchar int vertex_index\n");
        if (layout_.extra) text("property float area\n");
        text("end_header\n");
        for (std::uint32_t i = 0; i < rows * columns; ++i) vertex(i % columns, i / columns);
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = i / (columns - 1) * columns + i % (columns - 1), d = a + columns;
            if (layout_.quads && i % 3 != 0) {
                face({a, a + 1, d + 1, d});
            } else {
                face({a, a + 1, d + 1});
                face({a, d + 1, d});
            }
            file_.mesh.triangles.push_back({a, a + 1, d + 1});
            file_.mesh.triangles.push_back({a, d + 1, d});
        }
        return std::move(file_);
    }

private:
    void text(const std::string& part) { file_.bytes += part; }
    template <class T>
    void number(T value) {
        if (layout_.ascii) {
            std::array<char, 40> digits;
            // Short ones, long ones, and those that only std::from_chars reads.
            if constexpr (std::is_floating_point_v<T>)
                std::snprintf(digits.data(), digits.size(), written_++ % 5 == 0 ? "%.25f" : "%.17g", double(value));
            else std::snprintf(digits.data(), digits.size(), "%lld", static_cast<long long>(value));
            text(digits.data());
            text(written_ % 7 == 0 ? "  " : " ");
        } else {
            std::array<char, sizeof(T)> raw;
            std::memcpy(raw.data(), &value, sizeof(T));
            if (layout_.big_endian == (std::endian::native == std::endian::little))
                std::reverse(raw.begin(), raw.end());
            file_.bytes.append(raw.data(), raw.size());
        }
    }
    double real(double value) {
        if (layout_.wide) return number(value), value;
        number(static_cast<float>(value));
        return static_cast<double>(static_cast<float>(value));
    }
    float single(double value) {
        number(static_cast<float>(value));
        return static_cast<float>(value);
    }

    void vertex(std::uint32_t column, std::uint32_t row) {
        file_.vertices.push_back(file_.bytes.size());
        const double x = column / 7.0, y = row / 3.0;
        if (layout_.extra) number(static_cast<std::uint8_t>(column));
        const double px = real(x), py = real(y), pz = real(0.01 * x * y);
        file_.mesh.positions.emplace_back(px, py, pz);
        if (layout_.extra) number(1.5);
        if (layout_.normals) {
            const float nx = single(-0.01 * y), ny = single(-0.01 * x), nz = single(1);
            file_.mesh.normals.emplace_back(nx, ny, nz);
        }
        if (layout_.uvs) {
            const float v = single(row / 64.0), u = single(x);
            file_.mesh.uvs.emplace_back(u, v);
        }
        if (layout_.ascii) text(row % 2 == 0 ? "\n" : "\r\n");
    }
    void face(const std::vector<std::uint32_t>& corners) {
        file_.faces.push_back(file_.bytes.size());
        if (layout_.extra) number(static_cast<std::int16_t>(-1));
        if (layout_.wide) number(static_cast<std::int32_t>(corners.size()));
        else number(static_cast<std::uint8_t>(corners.size()));
        for (const std::uint32_t corner : corners) number(corner);
        if (layout_.extra) number(0.25f);
        if (layout_.ascii) text("\n");
    }

    Layout layout_;
    File file_;
    int written_ = 0;
};

template <class F>
void for_all_layouts(const F& f) {
    for (int i = 0; i < 96; ++i) {
        Layout layout{.ascii = i % 3 == 0, .big_endian = i % 3 == 1};
        layout.wide = i / 3 % 2 == 1;
        layout.normals = i / 6 % 2 == 1;
        layout.uvs = i / 12 % 2 == 1;
        layout.extra = i / 24 % 2 == 1;
        layout.quads = i / 48 % 2 == 1;
        CAPTURE(i);
        f(layout);
    }
}

bool equal(const Mesh& a, const Mesh& b) {
    return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles && a.uvs == b.uvs;
}

Mesh parse(std::string_view bytes) {
    const Folder folder;
    return load_ply(folder.write("mesh.ply", bytes));
}

}  // namespace

TEST_CASE("PLY files of all common layouts are read to the last bit") {
    for_all_layouts([](const Layout& layout) {
        const File file = Writer(layout).write(40);
        CHECK(equal(parse(file.bytes), file.mesh));
    });
}

TEST_CASE("PLY files that are mapped into memory are read as others are") {
    for (const bool ascii : {false, true}) {
        const File file = Writer({.ascii = ascii, .normals = true}).write(2000);
        REQUIRE(file.bytes.size() > (1u << 20));
        CHECK(equal(parse(file.bytes), file.mesh));
        CHECK(contains(message_of([&] { parse(file.bytes + "x"); }), "the file goes on after its last element"));
        CHECK(contains(message_of([&] { parse(std::string_view(file.bytes).substr(0, file.bytes.size() - 8)); }),
                       "face 75961: the file ends too early"));
    }
}

TEST_CASE("what is wrong in the middle of a PLY file is found, and named as in a short one") {
    for_all_layouts([](const Layout& layout) {
        const File file = Writer(layout).write(40);
        const auto header_lines =
            std::count(file.bytes.begin(), file.bytes.begin() + std::ptrdiff_t(file.vertices[0]), '\n');
        const auto place = [&](const std::string& element, std::size_t number) {
            const std::size_t line =
                static_cast<std::size_t>(header_lines) + 1 + number + (element == "face" ? 800 : 0);
            return "mesh.ply:" + (layout.ascii ? std::to_string(line) + ":" : "") + " " + element + " " +
                   std::to_string(number) + ": ";
        };
        // The last number of an element that counts is replaced by one that it cannot have.
        const auto changed = [&](std::size_t end, bool last, std::string_view ascii, std::string_view binary) {
            std::string bytes = file.bytes;
            if (layout.ascii) {
                const auto end_of_word = [&](std::size_t at) { return bytes.find_last_not_of(" \r\n", at - 1) + 1; };
                const auto begin_of_word = [&](std::size_t at) { return bytes.find_last_of(" \n", at - 1) + 1; };
                end = end_of_word(end);
                if (!last) end = end_of_word(begin_of_word(end));
                return bytes.replace(begin_of_word(end), end - begin_of_word(end), ascii);
            }
            const std::size_t after = last ? 0 : 4;
            std::string raw(binary);
            if (layout.big_endian) std::reverse(raw.begin(), raw.end());
            return bytes.replace(end - after - raw.size(), raw.size(), raw);
        };
        const std::string_view nan = layout.wide && !layout.normals && !layout.uvs && !layout.extra
                                         ? std::string_view("\0\0\0\0\0\0\xf8\x7f", 8)
                                         : std::string_view("\0\0\xc0\x7f", 4);
        for (const std::size_t number : {255u, 256u, 257u, 700u}) {
            CAPTURE(number);
            if (!layout.extra || layout.normals || layout.uvs) {
                const std::string message =
                    message_of([&] { parse(changed(file.vertices[number + 1], true, "nan", nan)); });
                CHECK_MESSAGE(contains(message, place("vertex", number) + (layout.ascii ? "\"nan\" is not a finite"
                                                                                        : "a number is not finite")),
                              message);
            }
            const std::string message = message_of([&] {
                parse(changed(file.faces[number + 1], !layout.extra, "800", std::string_view("\x20\3\0\0", 4)));
            });
            CHECK_MESSAGE(contains(message, place("face", number) + "vertex 800 does not exist"), message);
        }
    });
}

TEST_CASE("changed PLY files of common layouts load or are refused") {
    int loaded = 0, refused = 0;
    for_all_layouts([&](const Layout& layout) {
        const File file = Writer(layout).write(3);
        for (std::uint32_t seed = 0; seed < 40; ++seed) {
            try {
                const Mesh mesh = parse(mutated(file.bytes, seed));
                ++loaded;
                bool in_range = true;
                for (const Triangle& triangle : mesh.triangles)
                    for (const std::uint32_t corner : triangle) in_range = in_range && corner < mesh.positions.size();
                CHECK(in_range);
                for (const DVec3& p : mesh.positions) in_range = in_range && is_finite(p);
                CHECK(in_range);
            } catch (const Error&) {
                ++refused;
            }
        }
    });
    CHECK_MESSAGE((loaded > 100 && refused > 100), loaded, " and ", refused);
}
