#include "outputs.hpp"

#include "cancellation.hpp"

#include <fmt/format.h>

namespace lightswitch::program {

void Outputs::add(std::string_view option, const std::filesystem::path& file, Check check) {
    if (file.empty()) return;
    try {
        const Uninterrupted creating_a_file;
        check(file);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", option, error.what()));
    }
    for (const auto& [other_option, other] : files_)
        if (same_file(file, other))
            throw Error(option == other_option
                            ? fmt::format("{} names the same file twice, {}", option, file.string())
                            : fmt::format("{} and {} name the same file, {}", other_option, option, file.string()));
    files_.emplace_back(option, file);
}

void Outputs::add_image(std::string_view option, const std::filesystem::path& file) {
    add(option, file, check_writable);
}

void Outputs::add_file(std::string_view option, const std::filesystem::path& file) {
    add(option, file, check_file_writable);
}

void Outputs::add_text(std::string_view option, const std::filesystem::path& file) {
    if (file != "-") add_file(option, file);
}

void Outputs::refuse_inputs(const std::vector<std::filesystem::path>& inputs) const {
    for (const auto& [option, file] : files_)
        for (const auto& input : inputs)
            if (same_file(file, input))
                throw Error(fmt::format("{}: {} is read by this command{} and is not overwritten; name another file",
                                        option, file.string(),
                                        file == input ? "" : fmt::format(" (as {})", input.string())));
}

void write_image(const std::filesystem::path& file, const Image& image, const SaveOptions& options,
                 const std::vector<Layer>& layers) {
    const Uninterrupted writing;
    if (!layers.empty() && can_hold_layers(file)) save_layers(file, image, layers);
    else save(file, image, options);
}

void write_report(const std::filesystem::path& file, const Report& report) {
    const Uninterrupted writing;
    save_report(file, report);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    if (file == "-") return fmt::print("{}", text);
    const Uninterrupted writing;
    write_file_atomically(file, text);
}

}  // namespace lightswitch::program
