// The panel beside the image: methods, what is known of them, and the picked pixel.

#include "interface.hpp"

#include "../method_notes.hpp"
#include "../replay_row.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace lightswitch::program {
namespace {

/// Colours that are told apart on black, one for each method.
ImU32 color_of(std::size_t method) {
    constexpr ImU32 colors[] = {
        IM_COL32(160, 160, 160, 255), IM_COL32(200, 200, 120, 255), IM_COL32(90, 160, 255, 255),
        IM_COL32(80, 220, 120, 255),  IM_COL32(255, 170, 60, 255),  IM_COL32(240, 90, 90, 255),
        IM_COL32(190, 120, 255, 255), IM_COL32(70, 220, 220, 255),  IM_COL32(255, 130, 200, 255)};
    return colors[method % std::size(colors)];
}

std::string seconds_text(double seconds) {
    return seconds < 100 ? fmt::format("{:.1f} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string percent(double fraction) {
    return fraction < 0.1 ? fmt::format("{:.2g} %", 100 * fraction) : fmt::format("{:.0f} %", 100 * fraction);
}

/// The newest error that is known: measured by the reference, or else estimated.
double newest_error(const LiveMethod& method, bool measured) {
    double error = 0;
    for (const ErrorPoint& point : method.curve)
        if (const double value = measured ? point.measured : point.estimated; value > 0 && std::isfinite(value))
            error = value;
    return error;
}

const ImVec4 red{1, 0.45f, 0.4f, 1}, green{0.45f, 0.9f, 0.5f, 1}, yellow{1, 0.85f, 0.4f, 1};

}  // namespace

/// 0 where it is hidden.
float Interface::panel_width() const {
    return shows_panel_ ? std::min(340 * window_.scale(), 0.6f * ImGui::GetIO().DisplaySize.x) : 0;
}

void Interface::side_panel() {
    if (!live_) return;
    ImGui::TextWrapped("%s, %d x %d; %s scene type, %s", scene_name().c_str(), live_->film().width,
                       live_->film().height, live_->scene_type().c_str(), bytes_text(live_->scene_bytes()).c_str());
    problems_panel();
    method_table();
    compare_panel();
    verdict_panel();
    plot_panel(ImGui::GetContentRegionAvail().x);
    pixel_panel();
}

void Interface::method_table() {
    const auto best = live_->best();
    const bool measured = live_->reference().has_value();
    if (!ImGui::BeginTable("methods", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("");
    ImGui::TableSetupColumn("method", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("samples");
    ImGui::TableSetupColumn("time");
    ImGui::TableSetupColumn(measured ? "error" : "est. error");
    ImGui::TableHeadersRow();
    for (std::size_t i = 0; i < live_->methods().size(); ++i) {
        const LiveMethod& method = live_->methods()[i];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color_of(i)), "%d", static_cast<int>(i));
        ImGui::TableNextColumn();
        const bool is_reference = live_->reference() == i;
        const std::string label =
            fmt::format("{}{}{}", method.name, best == i ? " *" : "", is_reference ? " (reference)" : "");
        if (ImGui::Selectable(label.c_str(), live_->shown() == i, ImGuiSelectableFlags_SpanAllColumns)) {
            if (ImGui::GetIO().KeyShift) live_->compare_with(i);
            else live_->show(i);
        }
        if (ImGui::IsItemHovered()) {
            const MethodNotes& notes = notes_on(method.name);
            ImGui::BeginTooltip();
            ImGui::PushTextWrapPos(400 * window_.scale());
            ImGui::TextUnformatted(fmt::format("{} ({}): {}", method.name, name(method.kind), notes.can).c_str());
            if (!notes.cannot.empty()) ImGui::TextUnformatted(fmt::format("It cannot {}.", notes.cannot).c_str());
            if (best == i) ImGui::TextUnformatted("* the smallest error for its time so far, on this view");
            ImGui::PopTextWrapPos();
            ImGui::EndTooltip();
        }
        const auto& s = method.snapshot;
        const bool made = s && s->iterations > 0;
        ImGui::TableNextColumn();
        if (made) ImGui::Text("%llu", static_cast<unsigned long long>(s->iterations));
        ImGui::TableNextColumn();
        if (made) ImGui::TextUnformatted(seconds_text(s->statistics.seconds).c_str());
        ImGui::TableNextColumn();
        const double error = method.kind == Kind::heuristic ? 0 : newest_error(method, measured && !is_reference);
        if (error > 0) ImGui::TextUnformatted(percent(error).c_str());
    }
    ImGui::EndTable();
}

void Interface::compare_panel() {
    ImGui::Separator();
    const LiveMethod* reference = live_->reference_method();
    ImGui::SetNextItemWidth(-1);
    const std::string shown = reference ? "compared with " + reference->name : "compared with nothing";
    if (ImGui::BeginCombo("##reference", shown.c_str())) {
        if (ImGui::Selectable("nothing", !reference)) live_->compare_with({});
        for (std::size_t i = 0; i < live_->methods().size(); ++i)
            if (ImGui::Selectable(live_->methods()[i].name.c_str(), live_->reference() == i)) live_->compare_with(i);
        ImGui::EndCombo();
    }
}

void Interface::verdict_panel() {
    const LiveMethod* reference = live_->reference_method();
    if (!reference) return;
    const LiveMethod& shown = live_->shown_method();
    const auto so_far = live_->verdict();
    if (!so_far) {
        const bool same = live_->reference() == live_->shown();
        ImGui::TextWrapped("%s", same ? "verdict: this is the reference itself" : "verdict: V asks for one");
        return;
    }
    if (!so_far->problem.empty()) {
        ImGui::TextColored(yellow, "no verdict");
        ImGui::TextWrapped("%s", so_far->problem.c_str());
        return;
    }
    if (!so_far->verdict) {
        ImGui::TextColored(yellow, "undecided");
        ImGui::SameLine();
        ImGui::TextWrapped(
            "%s against %s: %s", shown.name.c_str(), reference->name.c_str(),
            so_far->progress.images > 0
                ? fmt::format("{} images, {}", so_far->progress.images, seconds_text(so_far->progress.seconds)).c_str()
                : "the first images ...");
        return;
    }
    const Verdict& v = *so_far->verdict;
    ImGui::TextColored(v.agrees() ? green : v.disagrees() ? red : yellow, "%s", std::string(name(v.answer)).c_str());
    ImGui::SameLine();
    ImGui::Text("%s against %s, %s", v.method.c_str(), v.reference.c_str(),
                so_far->done ? "done" : seconds_text(so_far->progress.seconds).c_str());
    if (!v.parts.empty()) {
        const auto& whole = v.parts.front();
        constexpr const char* channels[] = {"red", "green", "blue"};
        for (std::size_t c = 0; c < 3; ++c)
            ImGui::TextUnformatted(fmt::format("  bias {:<6} {:+.3f} % ({:+.3f} to {:+.3f})", channels[c],
                                               100 * whole.bias[c], 100 * whole.interval[c].low,
                                               100 * whole.interval[c].high)
                                       .c_str());
        if (v.first_wrong_length > 0) ImGui::TextColored(red, "  from path length %d on", v.first_wrong_length);
    }
    ImGui::TextWrapped("%s", v.reason.c_str());
}

/// Error over time, both logarithmic: thin as estimated, strong as measured by the reference.
void Interface::plot_panel(float width) {
    ImGui::Separator();
    double shortest = std::numeric_limits<double>::infinity(), longest = 0, least = shortest, most = 0;
    const auto good = [](double x) { return x > 0 && std::isfinite(x); };
    for (const LiveMethod& method : live_->methods()) {
        if (method.kind == Kind::heuristic) continue;
        for (const ErrorPoint& point : method.curve) {
            for (const double error : {point.estimated, point.measured}) {
                if (!good(error) || !good(point.seconds)) continue;
                shortest = std::min(shortest, point.seconds);
                longest = std::max(longest, point.seconds);
                least = std::min(least, error);
                most = std::max(most, error);
            }
        }
    }
    ImGui::TextUnformatted("error of the image over seconds of rendering");
    const float height = std::round(0.6f * width);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy({width, height});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + width, corner.y + height}, IM_COL32(16, 16, 18, 255));
    if (!(longest > 0)) {
        list.AddText({corner.x + 8, corner.y + 8}, IM_COL32(150, 150, 150, 255), "after two samples");
        return;
    }
    const auto low = [](double x) { return std::pow(10, std::floor(std::log10(x) + 1e-9)); };
    const auto high = [](double x) { return std::pow(10, std::ceil(std::log10(x) - 1e-9)); };
    const double x0 = low(shortest), x1 = std::max(high(longest), 10 * x0);
    const double y0 = low(least), y1 = std::max(high(most), 10 * y0);
    const float left = corner.x + 44 * window_.scale(), bottom = corner.y + height - 18 * window_.scale();
    const auto at = [&](double seconds, double error) {
        const auto u = static_cast<float>(std::log(seconds / x0) / std::log(x1 / x0));
        const auto v = static_cast<float>(std::log(error / y0) / std::log(y1 / y0));
        return ImVec2(left + u * (corner.x + width - left - 4), bottom - v * (bottom - corner.y - 4));
    };
    const ImU32 grid = IM_COL32(60, 60, 66, 255), ink = IM_COL32(170, 170, 170, 255);
    for (double x = x0; x <= x1 * 1.001; x *= 10) {
        list.AddLine(at(x, y0), at(x, y1), grid);
        const std::string text = fmt::format("{:g} s", x);
        const float wide = ImGui::CalcTextSize(text.c_str()).x;
        list.AddText({std::min(at(x, y0).x - wide / 2, corner.x + width - wide), bottom + 2}, ink, text.c_str());
    }
    for (double y = y0; y <= y1 * 1.001; y *= 10) {
        list.AddLine(at(x0, y), at(x1, y), grid);
        list.AddText({corner.x + 2, std::max(at(x0, y).y - 8 * window_.scale(), corner.y)}, ink,
                     fmt::format("{:g} %", 100 * y).c_str());
    }
    for (std::size_t i = 0; i < live_->methods().size(); ++i) {
        const LiveMethod& method = live_->methods()[i];
        if (method.kind == Kind::heuristic) continue;
        const auto draw = [&](auto value, float thickness) {
            std::optional<ImVec2> last;
            for (const ErrorPoint& point : method.curve) {
                if (!good(value(point)) || !good(point.seconds)) continue;
                const ImVec2 here = at(point.seconds, value(point));
                if (last) list.AddLine(*last, here, color_of(i), thickness * window_.scale());
                if (thickness > 1) list.AddCircleFilled(here, 2.5f * window_.scale(), color_of(i));
                last = here;
            }
        };
        draw([](const ErrorPoint& p) { return p.estimated; }, 1);
        draw([](const ErrorPoint& p) { return p.measured; }, 2.5f);
    }
    if (const auto best = live_->best()) {
        ImGui::TextUnformatted("best for its time so far:");
        ImGui::SameLine();
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color_of(*best)), "%s", live_->methods()[*best].name.c_str());
    }
}

void Interface::pixel_panel() {
    if (!picked_) return;
    ImGui::Separator();
    const auto [x, y] = *picked_;
    ImGui::Text("pixel (%d, %d)", x, y);
    const auto describe = [&](const LiveMethod& method) {
        const auto& s = method.snapshot;
        if (!s || s->iterations == 0) return;
        const Rgb& value = s->image(x, y);
        ImGui::TextUnformatted(
            fmt::format("{:<9} {:.5g} {:.5g} {:.5g}", method.name, value.x, value.y, value.z).c_str());
        if (s->iterations > 1) {
            const Rgb& variance = s->variance(x, y);
            ImGui::TextUnformatted(fmt::format("      +- {:.2g} {:.2g} {:.2g}", std::sqrt(variance.x),
                                               std::sqrt(variance.y), std::sqrt(variance.z))
                                       .c_str());
        }
    };
    describe(live_->shown_method());
    if (const LiveMethod* reference = live_->reference_method(); reference && live_->reference() != live_->shown())
        describe(*reference);
}

/// The path of the picked pixel's sample, a row for each event.
void Interface::path_window() {
    const auto path = picked_ ? live_->followed() : nullptr;
    if (!path || path->at.x != picked_->first || path->at.y != picked_->second) return;
    const ImGuiIO& io = ImGui::GetIO();
    const float height = std::min(260 * window_.scale(), io.DisplaySize.y / 2);
    const float width = io.DisplaySize.x - panel_width();
    ImGui::SetNextWindowPos({0, io.DisplaySize.y - ImGui::GetFrameHeight() - height}, ImGuiCond_Appearing);
    ImGui::SetNextWindowSize({width, height}, ImGuiCond_Appearing);
    bool stays = true;
    ImGui::Begin("Path", &stays, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::TextUnformatted(fmt::format("{}, pixel ({}, {}), iteration {}   Y later, Shift+Y earlier, U brightest",
                                       path->method, path->at.x, path->at.y, path->at.iteration)
                               .c_str());
    if (const auto& b = path->brightest)
        ImGui::TextUnformatted(
            fmt::format("the brightest of {} samples, whose mean is {}", b->tried, text_of(b->mean)).c_str());
    if (!path->problem.empty()) ImGui::TextWrapped("%s", path->problem.c_str());
    if (path->replay && ImGui::BeginTable("events", 5,
                                          ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg |
                                              ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY,
                                          {0, -ImGui::GetTextLineHeightWithSpacing()})) {
        Rgb sum(0);
        for (const PathEvent& event : path->replay->events) {
            using Kind = PathEvent::Kind;
            if (event.kind == Kind::contribution) sum += event.value;
            const ReplayRow row = replay_row(event, sum);
            ImGui::TableNextRow();
            const bool counts =
                event.kind == Kind::contribution || event.kind == Kind::sample || event.kind == Kind::splat;
            for (const std::string* cell : {&row.vertex, &row.what, &row.first, &row.second, &row.rest}) {
                ImGui::TableNextColumn();
                if (counts) ImGui::TextColored(yellow, "%s", cell->c_str());
                else ImGui::TextUnformatted(cell->c_str());
            }
            if (event.kind == Kind::sample) sum = Rgb(0);
        }
        ImGui::EndTable();
    }
    if (path->replay)
        ImGui::TextUnformatted(
            fmt::format("film {}{}", text_of(path->replay->value()),
                        path->replay->explained ? ": the contributions add up to it, bit for bit" : "")
                .c_str());
    ImGui::End();
    if (!stays) picked_.reset();
}

/// What should not be overlooked.
void Interface::problems_panel() {
    const auto& snapshot = live_->shown_method().snapshot;
    if (snapshot && !snapshot->failure.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, red);
        ImGui::TextWrapped("%s", snapshot->failure.c_str());
        ImGui::PopStyleColor();
    }
    if (snapshot && snapshot->statistics.counts.non_finite > 0) {
        ImGui::PushStyleColor(ImGuiCol_Button, {0.7f, 0.1f, 0.1f, 1});
        if (ImGui::Button(
                fmt::format("{} values not finite: show (N)", snapshot->statistics.counts.non_finite).c_str()))
            next_non_finite();
        ImGui::PopStyleColor();
    }
    if (!live_->summary().stand_ins.empty())
        ImGui::TextColored(yellow, "%d stand-ins for what is not supported",
                           static_cast<int>(live_->summary().stand_ins.size()));
}

}  // namespace lightswitch::program
