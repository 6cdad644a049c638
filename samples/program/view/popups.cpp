// What comes up over the window and goes away again.

#include "interface.hpp"

#include "../outputs.hpp"
#include "../scene_files.hpp"

#include <lightswitch/report/comparison_report.hpp>
#include <lightswitch/scene/stock.hpp>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

namespace lightswitch::program {

void Interface::popups() {
    help();
    save_popup();
    open_popup();
    loss_popup();
    message_popup();
}

void Interface::help() {
    if (!shows_help_) return;
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({io.DisplaySize.x / 2, io.DisplaySize.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {io.DisplaySize.x, io.DisplaySize.y});
    ImGui::Begin("Keys and mouse", &shows_help_, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
    constexpr std::array<std::array<const char*, 2>, 9> mouse{{{"left drag", "turn around what is in the middle"},
                                                               {"right drag", "move sideways"},
                                                               {"Ctrl + left drag, Ctrl + wheel", "nearer, farther"},
                                                               {"W A S D Q E, with Shift", "fly, faster"},
                                                               {"wheel", "zoom into the image, down to pixels"},
                                                               {"middle drag", "move the zoomed image"},
                                                               {"drag the line", "of the split view"},
                                                               {"click", "pick a pixel"},
                                                               {"drop a file", "open it"}}};
    if (ImGui::BeginTable("keys", 6)) {
        // In three columns, as the menus have them.
        std::vector<std::array<std::string, 2>> rows;
        for (const Command& command : commands_)
            rows.push_back({command.key_text, std::string(command.menu) + ": " + command.text});
        for (const auto& row : mouse) rows.push_back({row[0], row[1]});
        const std::size_t lines = (rows.size() + 2) / 3;
        for (std::size_t line = 0; line < lines; ++line) {
            ImGui::TableNextRow();
            for (std::size_t column = 0; column < 3; ++column) {
                const std::size_t i = column * lines + line;
                ImGui::TableNextColumn();
                if (i < rows.size()) ImGui::TextColored({1, 0.85f, 0.4f, 1}, "%s", rows[i][0].c_str());
                ImGui::TableNextColumn();
                if (i < rows.size()) ImGui::TextUnformatted(rows[i][1].c_str());
            }
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void Interface::begin_save(const std::string& ending) {
    const std::string stem = std::filesystem::path(options_.scene.scene).stem().string();
    const auto& snapshot = live_->shown_method().snapshot;
    const std::uint64_t samples = snapshot ? snapshot->iterations : 0;
    std::string base = fmt::format("{}-{}-{}", stem, live_->shown_method().name, samples);
    if (ending == ".html") base = stem + "-comparison";
    save_name_ = base + ending;
    std::error_code ignored;
    for (int i = 2; std::filesystem::exists(save_name_, ignored); ++i)
        save_name_ = fmt::format("{}-{}{}", base, i, ending);
    save_problem_.clear();
    saves_ = true;
}

void Interface::save_popup() {
    if (!saves_) return;
    if (!ImGui::IsPopupOpen("Save")) ImGui::OpenPopup("Save");
    if (!ImGui::BeginPopupModal("Save", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::TextUnformatted("File: .png at this exposure, .exr, .hdr or .pfm as it is, .html all methods side by side");
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(480 * window_.scale());
    ImGui::InputText("##name", &save_name_);
    if (!save_problem_.empty()) ImGui::TextColored({1, 0.5f, 0.4f, 1}, "%s", save_problem_.c_str());
    const bool wanted = ImGui::Button("Save") || entered_;
    ImGui::SameLine();
    bool done = ImGui::Button("Cancel") || escaped_;
    if (wanted) {
        try {
            save(save_name_);
            done = true;
        } catch (const std::exception& error) {
            save_problem_ = error.what();
        }
    }
    if (done) {
        saves_ = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void Interface::save(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) throw Error(file.string() + " exists already: choose another name");
    Outputs outputs;
    if (file.extension() == ".html") {
        outputs.add_file("Save", file);
        std::vector<ComparedImage> images;
        std::size_t reference = 0;
        for (std::size_t i = 0; i < live_->methods().size(); ++i) {
            const LiveMethod& method = live_->methods()[i];
            if (!method.snapshot || method.snapshot->iterations == 0) continue;
            if (live_->reference() == i) reference = images.size();
            images.push_back({method.name, live_->image_to_save(i)});
        }
        if (images.size() < 2) throw Error("a comparison needs images of two methods: show another one");
        write_report(file, comparison_report(images, reference));
        for (std::size_t i = 0; i < live_->methods().size(); ++i) live_->saved(i);
    } else {
        outputs.add_image("Save", file);
        write_image(file, live_->image_to_save(live_->shown()), {.exposure = display_.stops});
        live_->saved(live_->shown());
    }
    tell(fmt::format("Wrote {}.", file.string()));
}

void Interface::open_popup() {
    if (!opens_) return;
    if (!ImGui::IsPopupOpen("Open")) ImGui::OpenPopup("Open");
    if (!ImGui::BeginPopupModal("Open", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::Text("A file that ends in %s, or a stock scene:", scene_endings().c_str());
    bool done = false;
    for (const std::string_view stock_name : stock::names) {
        if (ImGui::Button(std::string(stock_name).c_str())) {
            open(std::string(stock_name));
            done = true;
        }
        ImGui::SameLine();
    }
    ImGui::NewLine();
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(480 * window_.scale());
    ImGui::InputText("##scene", &open_name_);
    const bool wanted = ImGui::Button("Open") || entered_;
    ImGui::SameLine();
    done = ImGui::Button("Cancel") || escaped_ || done;
    if (wanted && !open_name_.empty()) {
        open(open_name_);
        done = true;
    }
    if (done) {
        opens_ = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void Interface::open(const std::string& scene) {
    if (loading_.valid()) return tell(fmt::format("{} is still being opened.", loading_name_));
    unless_lost("Open another scene", [this, scene] { begin_to_open(scene); });
}

void Interface::begin_to_open(const std::string& scene) {
    SceneOptions wanted = options_.scene;
    wanted.scene = scene;
    // What was given for the first scene's file is not for this one.
    wanted.defines.clear();
    wanted.search_paths.clear();
    wanted.sensor.clear();
    loading_name_ = scene;
    loading_ = std::async(std::launch::async, [wanted, quiet = options_.quiet] {
        struct Waker {
            ~Waker() { Window::wake(); }
        } const waker;
        return load_scene(wanted, quiet);
    });
}

void Interface::tell(std::string message) {
    message_ = std::move(message);
    told_ = std::chrono::steady_clock::now();
}

void Interface::message_popup() {
    // Time to read it.
    const auto time = std::chrono::seconds(4) + std::chrono::milliseconds(60) * message_.size();
    if (std::chrono::steady_clock::now() - told_ > time) message_.clear();
    if (message_.empty()) return;
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({10 * window_.scale(), io.DisplaySize.y - 2 * ImGui::GetFrameHeight()}, ImGuiCond_Always,
                            {0, 1});
    ImGui::Begin("message", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushTextWrapPos(0.6f * io.DisplaySize.x);
    ImGui::TextUnformatted(message_.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) message_.clear();
    ImGui::End();
}

void Interface::unless_lost(const char* what, std::function<void()> act) {
    if (!live_ || live_->unsaved().empty()) return act();
    lost_by_ = what;
    would_lose_ = std::move(act);
}

void Interface::loss_popup() {
    if (!would_lose_) return;
    if (!ImGui::IsPopupOpen("Not saved")) ImGui::OpenPopup("Not saved");
    if (!ImGui::BeginPopupModal("Not saved", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::TextUnformatted("Images that took a while are not saved:");
    for (const std::string& method : live_->unsaved()) ImGui::BulletText("%s", method.c_str());
    const bool wanted = ImGui::Button(fmt::format("{} without saving", lost_by_).c_str());
    ImGui::SameLine();
    const bool done = ImGui::Button("Stay here") || escaped_;
    if (wanted || done) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!wanted && !done) return;
    const auto act = std::exchange(would_lose_, {});
    if (wanted) act();
}

}  // namespace lightswitch::program
