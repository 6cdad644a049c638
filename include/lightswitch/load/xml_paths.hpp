#pragma once

// Where the files are that a scene file names.

#include <lightswitch/load/text.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch::detail {

/// The entry of `folder` whose name differs from `name` in capitals alone; the first by name when there are several.
inline std::optional<std::filesystem::path> entry_in_any_case(const std::filesystem::path& folder,
                                                              const std::string& name) {
    std::error_code error;
    std::optional<std::filesystem::path> found;
    const std::string wanted = lower_case(name);
    const auto where = folder.empty() ? std::filesystem::path(".") : folder;
    for (auto entry = std::filesystem::directory_iterator(where, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string other = entry->path().filename().string();
        if (lower_case(other) == wanted && (!found || other < found->filename().string())) found = folder / other;
    }
    return found;
}

/// `folder / name`, when it exists with other capitals.
inline std::optional<std::filesystem::path> in_any_case(std::filesystem::path folder,
                                                        const std::filesystem::path& name) {
    std::error_code error;
    for (const auto& part : name) {
        if (std::filesystem::exists(folder / part, error)) {
            folder /= part;
        } else if (const auto entry = entry_in_any_case(folder, part.string())) {
            folder = *entry;
        } else {
            return {};
        }
    }
    return folder;
}

/// A file that a scene names, as the first of `folders` has it.
struct FoundFile {
    std::filesystem::path path;  ///< in the folder `otherwise`, when it is nowhere
    bool exactly = true;         ///< whether the name is right but for backslashes
};

/// Looks for `name`, in which backslashes may stand between folders, in all folders, and then with other capitals.
inline FoundFile find_file(std::string name, const std::vector<std::filesystem::path>& folders,
                           const std::filesystem::path& otherwise) {
    std::error_code error;
    std::replace(name.begin(), name.end(), '\\', '/');
    for (const auto& folder : folders)
        if (std::filesystem::exists(folder / name, error)) return {folder / name};
    for (const auto& folder : folders) {
        const std::filesystem::path relative(name);
        const auto found = relative.is_absolute() ? in_any_case(relative.root_path(), relative.relative_path())
                                                  : in_any_case(folder, relative);
        if (found) return {*found, false};
    }
    return {otherwise / name};
}

}  // namespace lightswitch::detail
