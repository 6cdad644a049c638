#pragma once

// The files that a command writes.

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/report/report.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightswitch::program {

/// Everything that can be known to be unwritable, found out before the work begins.
class Outputs {
public:
    // Each throws `Error`, which begins with the option, unless the file can be written and is no other output. An
    // empty name is no file.
    void add_image(std::string_view option, const std::filesystem::path& file);
    void add_file(std::string_view option, const std::filesystem::path& file);
    /// "-" is standard output.
    void add_text(std::string_view option, const std::filesystem::path& file);

    /// Throws `Error` when writing would replace one of the files that the command reads.
    void refuse_inputs(const std::vector<std::filesystem::path>& inputs) const;

private:
    using Check = void (*)(const std::filesystem::path&);
    void add(std::string_view option, const std::filesystem::path& file, Check check);

    std::vector<std::pair<std::string_view, std::filesystem::path>> files_;  // options are literals
};

// Each writes a file as a whole: a signal that comes meanwhile has its effect afterwards.
/// With the layers where the file can hold them.
void write_image(const std::filesystem::path& file, const Image& image, const SaveOptions& options = {},
                 const std::vector<Layer>& layers = {});
void write_report(const std::filesystem::path& file, const Report& report);
/// "-" is standard output.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace lightswitch::program
