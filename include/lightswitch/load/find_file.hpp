#pragma once

// Files by names that were written on other systems.

#include <lightswitch/load/text.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lightswitch::detail {

/// The entry of `folder` whose name differs from `name` in capitals alone; the first by name when there are several.
/// Looks at 100 000 names at most.
inline std::optional<std::filesystem::path> entry_in_any_case(const std::filesystem::path& folder,
                                                              const std::string& name) {
    std::error_code error;
    std::optional<std::filesystem::path> found;
    const std::string wanted = lower_case(name);
    std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error);
    for (int count = 0; !error && entry != std::filesystem::directory_iterator() && count < 100000;
         ++count, entry.increment(error)) {
        const std::string other = entry->path().filename().string();
        if (lower_case(other) == wanted && (!found || other < found->filename().string())) found = folder / other;
    }
    return found;
}

/// `folder / name`, when it exists but for capitals.
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

/// Finds a file by the name that another file gives it, relative to the first of `folders` that has it: as it is, with
/// slashes for backslashes, in quotes, in other letters' case, and at last without the folders that it is said to be
/// in.
inline std::optional<std::filesystem::path> find_loosely(std::string_view text,
                                                         const std::vector<std::filesystem::path>& folders) {
    text = trimmed(text);
    if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    if (text.empty() || text.size() > 4096 || text.find('\0') != std::string_view::npos) return {};
    std::string slashes(text);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    std::vector<std::filesystem::path> names{std::string(text)};
    for (const auto& name : {std::filesystem::path(slashes), std::filesystem::path(slashes).filename()})
        if (name != names.back()) names.push_back(name);
    std::error_code error;
    for (const auto& name : names) {
        if (name.empty()) continue;
        for (const auto& folder : folders)
            if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
        if (name.is_absolute()) continue;
        for (const auto& folder : folders)
            if (const auto found = in_any_case(folder, name); found && std::filesystem::is_regular_file(*found, error))
                return found;
    }
    return {};
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
