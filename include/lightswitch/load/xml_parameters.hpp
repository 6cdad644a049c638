#pragma once

// The parameters of scene files: `<default>` and `$name`.

#include <lightswitch/core/error.hpp>
#include <lightswitch/load/text.hpp>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::detail {

/// Values of `$name`, as the user and the file give them.
class XmlParameters {
public:
    explicit XmlParameters(const std::map<std::string, std::string>& values) : values_(values) {
        for (const auto& [name, value] : values) unused_.insert(name);
    }

    /// The user's parameters that no text has asked for.
    const std::set<std::string>& unused() const { return unused_; }

    /// Gives a parameter a value, unless it has one. Throws when it cannot have that name.
    void define(const std::string& name, const std::string& value) {
        if (name.empty() || name.find_first_not_of(name_characters) != std::string::npos || name.size() > longest_name)
            throw Error("the name must be 1 to " + std::to_string(longest_name) + " letters, digits and underscores");
        values_.emplace(name, value);
    }

    struct Replaced {
        std::string text;
        std::vector<std::string> unknown;  ///< names without a value, which stay as they are
    };
    /// As in Mitsuba, the longest known name that fits is meant, and `\$` is a dollar sign. Throws when values take
    /// more than 16 MiB in all.
    Replaced replaced(std::string_view text);

private:
    static constexpr std::size_t longest_name = 100, max_bytes = std::size_t(16) << 20;
    static constexpr std::string_view name_characters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

    std::map<std::string, std::string> values_;
    std::set<std::string> unused_;
    std::size_t bytes_ = 0;
};

inline XmlParameters::Replaced XmlParameters::replaced(std::string_view text) {
    Replaced result;
    while (!text.empty()) {
        const std::size_t dollar = text.find('$');
        const std::string_view before = text.substr(0, dollar);
        result.text += before;
        if (dollar == std::string_view::npos) break;
        text.remove_prefix(dollar + 1);
        if (before.ends_with('\\')) {
            result.text.back() = '$';
            continue;
        }
        const std::string_view word = text.substr(0, text.find_first_not_of(name_characters));
        std::size_t length = std::min(word.size(), longest_name);
        auto match = values_.end();
        for (; length > 0 && match == values_.end(); --length)
            match = values_.find(std::string(text.substr(0, length)));
        if (match == values_.end()) {
            result.unknown.emplace_back(word);
            result.text += '$';
            continue;
        }
        unused_.erase(match->first);
        text.remove_prefix(match->first.size());
        result.text += match->second;
        bytes_ += match->second.size();
        if (bytes_ > max_bytes) throw Error("replacing parameters makes the file longer than 16 MiB");
    }
    return result;
}

}  // namespace lightswitch::detail
