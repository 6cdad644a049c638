#pragma once

// Files by names that were written on other systems.

#include <lightswitch/load/text.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace lightswitch::detail {

/// The file in `folder` that is called so but for small and capital letters; looks at 100 000 names at most.
inline std::optional<std::filesystem::path> find_in_any_case(std::filesystem::path folder,
                                                             const std::filesystem::path& name) {
    std::error_code error;
    for (const auto& part : name) {
        auto next = folder / part;
        if (!std::filesystem::exists(next, error)) {
            const std::string wanted = lower_case(part.string());
            std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error);
            for (int count = 0;; ++count, entry.increment(error)) {
                if (error || entry == std::filesystem::directory_iterator() || count == 100000) return {};
                if (lower_case(entry->path().filename().string()) == wanted) break;
            }
            next = folder / entry->path().filename();
        }
        folder = next;
    }
    if (!std::filesystem::is_regular_file(folder, error)) return {};
    return folder;
}

/// Finds a file by the name that another file gives it, relative to the first of `folders` that has it: as it is, with
/// slashes for backslashes, in quotes, in other letters' case, and at last without the folders that it is said to be
/// in.
inline std::optional<std::filesystem::path> find_file(std::string_view text,
                                                      const std::vector<std::filesystem::path>& folders) {
    text = trimmed(text);
    if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    if (text.empty() || text.size() > 4096 || text.find('\0') != std::string_view::npos) return {};
    std::string slashes(text);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    std::vector<std::filesystem::path> names{std::string(text), slashes};
    names.push_back(names.back().filename());
    std::error_code error;
    for (const auto& name : names) {
        if (name.empty()) continue;
        for (const auto& folder : folders)
            if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
        if (name.is_absolute()) continue;
        for (const auto& folder : folders)
            if (const auto found = find_in_any_case(folder, name)) return found;
    }
    return {};
}

}  // namespace lightswitch::detail
