#pragma once

// MTL: the material files of Wavefront OBJ, as they are written.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/mesh_file.hpp>
#include <lightswitch/load/text.hpp>

#include <filesystem>
#include <map>
#include <optional>

namespace lightswitch::detail {

/// Larger material files are refused.
inline constexpr std::uintmax_t max_mtl_bytes = std::uintmax_t(1) << 24;

/// An image that a material names, and its options.
struct MtlMap {
    std::string file;           ///< as the file spells it
    DVec3 scale{1}, offset{0};  ///< of texture coordinates: `-s`, `-o`
    bool clamp = false;
    double base = 0, gain = 1;  ///< a value v becomes base + gain v: `-mm`
    double bump = 1;            ///< `-bm`
    Origin origin;
};

/// One `newmtl`. Names are in small letters, without a distinction between `bump` and `map_bump`.
struct MtlMaterial {
    std::string name;
    Origin origin;
    std::map<std::string, DVec3, std::less<>> colors;
    std::map<std::string, double, std::less<>> numbers;
    std::map<std::string, MtlMap, std::less<>> maps;

    std::optional<Rgb> color(std::string_view key) const {
        const auto found = colors.find(key);
        return found == colors.end() ? std::nullopt : std::optional(Rgb(found->second));
    }
    std::optional<double> number(std::string_view key) const {
        const auto found = numbers.find(key);
        return found == numbers.end() ? std::nullopt : std::optional(found->second);
    }
    const MtlMap* map(std::string_view key) const {
        const auto found = maps.find(key);
        return found == maps.end() ? nullptr : &found->second;
    }
};

/// Reads a material file. What it holds besides is skipped with a notice; malformed numbers are an `Error`.
class MtlReader {
public:
    using Materials = std::map<std::string, MtlMaterial, std::less<>>;

    explicit MtlReader(const std::filesystem::path& path) : path_(path), origin_{path.string(), 0, {}} {}

    /// Adds the file's materials to others; of one name the first counts.
    void read(Materials& materials, FileNotices& notices) {
        const std::string bytes = read_file(path_, max_mtl_bytes);
        std::string_view text = without_byte_order_mark(bytes);
        MtlMaterial* material = nullptr;
        while (!text.empty()) {
            ++origin_.line;
            std::string_view line = trimmed(next_line(text));
            const std::string keyword = lower_case(next_word(line));
            if (keyword.empty() || keyword.front() == '#') continue;
            line = trimmed(line);
            if (keyword == "newmtl") {
                if (line.empty()) fail(origin_, "a material needs a name");
                const auto [entry, is_new] = materials.try_emplace(std::string(line));
                if (!is_new) notices.add(origin_, "a material of that name is known already: this one is skipped");
                material = is_new ? &entry->second : &repeated_;
                material->name = entry->first;
                material->origin = origin_;
            } else if (material == nullptr) {
                fail(origin_, quote(keyword) + " comes before the first \"newmtl\"");
            } else {
                statement(*material, keyword, line, notices);
            }
        }
    }

private:
    void statement(MtlMaterial& material, const std::string& keyword, std::string_view line, FileNotices& notices) {
        const auto is_in = [&](const auto& list) { return std::find(list.begin(), list.end(), keyword) != list.end(); };
        if (is_in(color_names)) {
            if (const auto value = color(keyword, line, notices)) material.colors[keyword] = *value;
        } else if (is_in(number_names)) {
            // "d -halo 0.5" is a form of dissolve that depends on the view.
            if (keyword == "d" && line.starts_with("-halo")) {
                next_word(line);
                notices.add(origin_, "\"-halo\" is skipped");
            }
            material.numbers[keyword] = number(next_word(line));
        } else if (is_in(map_names)) {
            const std::string name = keyword == "bump"                              ? "map_bump"
                                     : keyword == "map_norm" || keyword == "map_kn" ? "norm"
                                     : keyword == "map_tr"                          ? "map_d"
                                                                                    : keyword;
            material.maps[name] = map(line, notices);
        } else {
            notices.add(origin_, quote(keyword) + " is skipped");
        }
    }

    double number(std::string_view word) const {
        const double value = finite_number(word, origin_);
        if (!(std::abs(value) <= 1e30)) fail(origin_, quote(word) + " is beyond 1e30");
        return value;
    }

    std::optional<DVec3> color(const std::string& keyword, std::string_view line, FileNotices& notices) const {
        const std::string_view first = next_word(line);
        if (first == "spectral" || first == "xyz") {
            notices.add(origin_, quote(keyword + " " + std::string(first)) + " is skipped: only RGB is known");
            return {};
        }
        DVec3 result(number(first));
        if (const std::string_view second = next_word(line); !second.empty()) {
            result.y = number(second);
            result.z = number(next_word(line));
        }
        if (std::min({result.x, result.y, result.z}) >= 0) return result;
        notices.add(origin_, quote(keyword) + " is negative and counts as 0");
        return glm::max(result, DVec3(0));
    }

    MtlMap map(std::string_view line, FileNotices& notices) const {
        MtlMap result;
        result.origin = origin_;
        for (; line.starts_with('-'); line = trimmed(line)) {
            const std::string option = lower_case(next_word(line));
            if (option == "-s") numbers(line, result.scale);
            else if (option == "-o") numbers(line, result.offset);
            else if (option == "-bm") result.bump = number(next_word(line));
            else if (option == "-clamp") result.clamp = lower_case(next_word(line)) == "on";
            else if (option == "-mm") {
                result.base = number(next_word(line));
                result.gain = number(next_word(line));
            } else if (option == "-t") {
                DVec3 ignored;
                numbers(line, ignored);
                notices.add(origin_, "the option \"-t\" is skipped");
            } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-texres" ||
                       option == "-imfchan" || option == "-type" || option == "-boost" || option == "-colorspace") {
                next_word(line);
                notices.add(origin_, "the option " + quote(option) + " is skipped");
            } else {
                fail(origin_, "unknown option " + quote(option));
            }
        }
        if (line.empty()) fail(origin_, "names no image");
        result.file = line;
        return result;
    }

    /// One to three numbers: those that are left out stay.
    void numbers(std::string_view& line, DVec3& result) const {
        for (int i = 0; i < 3; ++i) {
            std::string_view rest = line;
            const std::string_view word = next_word(rest);
            if (i > 0 && !parse_number(word)) return;
            result[i] = number(word);
            line = rest;
        }
    }

    static constexpr auto color_names = std::to_array<std::string_view>({"ka", "kd", "ks", "ke", "tf"});
    static constexpr auto number_names = std::to_array<std::string_view>(
        {"ns", "ni", "d", "tr", "illum", "sharpness", "pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"});
    static constexpr auto map_names =
        std::to_array<std::string_view>({"map_kd", "map_ks", "map_ke", "map_d", "map_tr", "map_bump", "bump", "norm",
                                         "map_norm", "map_kn", "map_pr", "map_pm"});

    std::filesystem::path path_;
    Origin origin_;
    MtlMaterial repeated_;
};

}  // namespace lightswitch::detail
